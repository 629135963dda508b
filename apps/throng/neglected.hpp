// Neglected: what the dial effects=auto leaves out of a run, what that saves, and whether it errs
// by less than it promises.
#pragma once

#include "apps/throng/beside.hpp"
#include "apps/throng/scene_argument.hpp"
#include "throng/effect_ledger.hpp"

#include <vector>

namespace throng {

/// Runs by effects=auto beside those by called.
///
///   promised_rad, promised_m  effects_error, and that share of the radius, root of the mean square
///                             over bodies
///   ms_called, ms             a step of both, as they run on side by side
///   beside                    auto beside called
///   shaken                    called beside itself, its bodies off by a ten-millionth of their
///                             radius: what becomes of the last digits, whatever is left out; of
///                             few bodies the worst of several ways of being off
struct NeglectReport {
    double promised_rad = 0, promised_m = 0;
    double ms_called = 0, ms = 0;
    BesideReport beside, shaken;

    /// Of a step's time that auto saves.
    double saved() const { return ms_called > 0 ? 1 - ms / ms_called : 0; }
    /// Whether the error is within what was promised, beyond that of the last digits.
    bool kept() const;
};

/// Runs them. Ends early where it is interrupted.
NeglectReport run_neglected(const SceneArgument& argument, std::int64_t steps, int threads);

/// entries  of a run by auto
void print_neglected(const NeglectReport& report, const std::vector<EffectEntry>& entries);
std::string neglected_json(const NeglectReport& report);

}  // namespace throng
