// Plan: what a benchmark is to run, as its options say.
#pragma once

#include "apps/throng/bench/peer_at.hpp"
#include "apps/throng/options.hpp"
#include "throng/catalog.hpp"

#include <string>
#include <vector>

namespace throng::bench {

/// A dial whose values are run side by side; without values, none is.
struct Variation {
    std::string dial;
    std::vector<std::string> values;
};

/// A scene as all engines step it.
struct PlannedScene {
    const CatalogEntry* entry = nullptr;
    int size = 0;
    double dt = 0;           // s
    std::int64_t steps = 0;  // at most
};

struct Plan {
    std::vector<const CatalogEntry*> scenes;
    std::vector<int> sizes;    // ascending, each once; none: each scene's own
    std::vector<int> threads;  // likewise
    std::vector<double> dts;   // s, in the order given; none: the scenes' own
    std::vector<std::string> peers;
    std::vector<PeerAt> peers_at;  // built by the user, beside those
    Variation varied;
    std::vector<std::string> lanes;  // widths, each a run of its own; none: that of the process
    bool peers_asked_for = false;    // by name; else those that are there
    bool errors = false;             // told beside the times
    bool efficiency = false;         // of more threads than one, likewise
    std::int64_t steps = 0;          // 0: for as long as each scene's answer is followed
    int repeats = 0;
    double max_seconds = 0;  // an engine may take in all for one scene of one size
    std::uint64_t seed = 0;
    std::string mesh;  // the file of one in place of those of the scenes; empty without
};

/// The options that read_plan() reads.
std::span<const Option> plan_options();

/// Throws BadInput, which says what was wanted.
Plan read_plan(const Options& options);

/// All that is to be run, scene by scene. Where no step was asked for it is `standard_dt`.
std::vector<PlannedScene> planned_scenes(const Plan& plan, double standard_dt);

}  // namespace throng::bench
