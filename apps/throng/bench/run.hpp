// Run: engines step the same scene in turns, and what each step took is kept.
#pragma once

#include "apps/throng/bench/engine.hpp"
#include "apps/throng/bench/plan.hpp"
#include "apps/throng/progress.hpp"

#include <limits>

namespace throng::bench {

struct StageRun {
    std::string name;
    std::vector<double> ms;  // by step
};

/// One engine, once through the scene.
struct Run {
    std::string engine, setting, settings, state_hash;  // setting: see EngineKind
    std::string alike;                                  // likewise
    int threads = 1, threads_met = 1, repeat = 0, beside = 0;
    std::vector<double> ms, cpu_ms;  // by step; the second of all threads together
    std::vector<std::size_t> contacts;
    std::vector<StageRun> stages;
    Quality quality;  // of the first repeat; the others end alike, and judging takes long
    /// From the scene's answer, in its unit; NaN where it was not asked for. Of the first repeat.
    double error = std::numeric_limits<double>::quiet_NaN();
    double make_ms = 0;
    double state_bytes = 0, heap_bytes = 0, resident_bytes = 0;

    std::size_t steps() const { return ms.size(); }
};

/// All engines on one scene of one size. Runs are in the order of kinds, repeat by repeat.
struct Case {
    const CatalogEntry* scene = nullptr;
    int size = 0;
    double dt = 0;  // s
    std::size_t bodies = 0, bodies_dynamic = 0;
    std::vector<Run> runs;
    bool complete = true;  // nobody interrupted it
};

/// Runs them: in each repeat every engine gets a fresh world, and they take turns of some steps, so
/// that whatever else the machine does meets all alike. Errors are taken after that, in passes of
/// their own over as many steps, so that no step waits for who looks on. Stops early where
/// interrupted.
Case run_case(const Plan& plan,
              const PlannedScene& planned,
              const Scene& scene,
              std::span<const EngineKind> kinds,
              Progress& progress,
              std::int64_t& steps_done);

}  // namespace throng::bench
