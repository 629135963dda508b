// This machine: what times were measured on.
#pragma once

#include "cost/report/cost_report.hpp"

namespace throng {

/// threads: that run the steps.
Machine this_machine(int threads);

}  // namespace throng
