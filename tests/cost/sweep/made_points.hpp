// Made points: settings as a sweep might have measured them.
#pragma once

#include "cost/sweep/sweep.hpp"

#include <utility>

namespace throng {

inline constexpr std::size_t kDrift = place_of(Measure::drift);

/// The same time and drift in each of four windows.
inline Point made_point(double time_ms, double drift, Changes changes = {{"substeps", "8"}})
{
    Point made;
    made.changes = std::move(changes);
    Errors errors;
    of(errors, kDrift) = drift * drift;
    made.errors.assign(4, errors);
    made.times_ms.assign(4, time_ms);
    made.time_ms = {time_ms, time_ms, time_ms, 7};
    return made;
}

}  // namespace throng
