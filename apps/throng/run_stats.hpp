// Run stats: what a run has to tell, as JSON for programs and as lines for people.
#pragma once

#include "apps/throng/step_times.hpp"
#include "throng/effect_ledger.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/error_estimate.hpp"

#include <ostream>
#include <string>

namespace throng {

/// A run that has ended, in numbers.
struct RunStats {
    std::string scene;
    std::uint64_t seed = 0;
    Settings settings;
    int threads = 0, threads_met = 0, threads_used = 0;
    std::size_t bodies = 0, bodies_dynamic = 0, bodies_quarantined = 0, memory_bytes = 0;
    std::vector<EffectEntry> effects;  // their ms a step, on the average
    StepTimes times;
    StepReport last;
    Measures measures;
    EnergyLedger energy;
    struct OfSteps {
        double rms = 0;  // m, over all
        StepError last, worst;
    } error;
    std::vector<std::string> warnings;  // of what bodies lost as they were made, and of energy
    std::string state_hash;
    double peak_rss_mb = 0;

    /// Time simulated by time taken; 0 before the first step.
    double realtime_factor() const;
};

/// Takes the numbers of a world after its last step.
RunStats collect_stats(World& world, StepTimes times);

/// One object, with the fields that docs and programs know.
void write_stats_json(const RunStats& stats, std::ostream& out);

/// The most telling of them, a `key: value` a line.
void write_summary(const RunStats& stats, std::ostream& out);

}  // namespace throng
