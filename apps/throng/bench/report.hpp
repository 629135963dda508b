// Report: a benchmark's figures for people and for programs.
#pragma once

#include "apps/throng/bench/figures.hpp"

#include <ostream>

namespace throng::bench {

/// What the figures depend on, said above them.
void print_heading(const Plan& plan, std::ostream& out);
/// The engines of a case in a table, and the stages of its step beside the budget.
void print_case(const Plan& plan, const Case& made, std::ostream& out);
/// How cost grows with size.
void print_growth(const std::vector<Growth>& all, std::ostream& out);

/// Everything, the time of every step included.
void write_json(const Plan& plan, const std::vector<Case>& cases, bool complete, std::ostream& out);

}  // namespace throng::bench
