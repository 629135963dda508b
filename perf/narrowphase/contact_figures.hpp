// Contact figures: what points of contact take by a method of the user's choice, and by what `auto`
// takes.
#pragma once

#include "perf/narrowphase/turns.hpp"

namespace throng::perf {

/// What a pair with its points of contact takes, warm: by a method of the user's choice, and by
/// what `auto` takes in either number type.
struct ContactRow {
    std::string build;
    std::string_view pair_case, motion;
    double gjk = kNone, sat = kNone, auto_float = kNone, auto_double = kNone;  // ns
};

/// Touching and deep, along a small motion and a large one.
std::vector<ContactRow>
measure_contacts(const Shapes& shapes, const Build& build, const Effort& effort);

}  // namespace throng::perf
