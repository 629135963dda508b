// Beside: a run beside another of the same bodies, and what the other saves and gets wrong.
#pragma once

#include "cost/windows/body_states.hpp"
#include "scene/files/json_writer.hpp"

#include <functional>
#include <utility>

namespace throng {

/// What came of it.
///
///   windows, length  stretches of the run, each begun by both from where the full run was; s
///   ms, ms_other     a step, without those after a beginning anew, which find their contacts
///   drift, turn, velocity  at a window's end, of the bodies of the other from where the full run
///                          has them, root of the mean square; m, rad, m/s
struct BesideReport {
    std::size_t windows = 0;
    double length = 0;
    double ms = 0, ms_other = 0;
    double drift = 0, turn = 0, velocity = 0;

    /// Of a step's time that the other saves.
    double saved() const { return ms > 0 ? 1 - ms_other / ms : 0; }
};

/// Runs both, step by step in turn. Ends early where it is interrupted.
///
///   begin  what the other is begun with, of what the full run has; may be empty
BesideReport run_beside(World& full,
                        World& other,
                        std::int64_t steps,
                        const std::function<BodyStates(const BodyStates&)>& begin);

/// ms a step of both, as they run on side by side without beginning anew.
std::pair<double, double> time_beside(World& full, World& other, std::int64_t steps);

/// The windows and their errors, as members of an object.
void add_windows(const BesideReport& report, JsonMembers& to);

}  // namespace throng
