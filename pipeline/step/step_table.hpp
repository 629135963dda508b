// Step table: the stages as rows, in order, each with the effects that call for it.
#pragma once

#include "pipeline/step/stage.hpp"

#include <span>
#include <vector>

namespace throng {

/// All rows, in the order in which one thread runs them.
template <class Real>
std::span<const Stage<Real>> step_table();

/// The rows that a set of effects calls for, by the solver and response that are chosen, in the
/// same order.
template <class Real>
std::vector<Stage<Real>> stages_for(Set<Effect> effects, const Settings& settings);

}  // namespace throng
