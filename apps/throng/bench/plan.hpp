// Plan: what a benchmark is to run, as its options say.
#pragma once

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

struct Plan {
    std::vector<const CatalogEntry*> scenes;
    std::vector<int> sizes, threads;  // ascending, each once
    std::vector<std::string> peers;
    Variation varied;
    bool peers_asked_for = false;  // by name; else those that are there
    std::int64_t steps = 0;
    int repeats = 0;
    double max_seconds = 0;  // an engine may take in all for one scene of one size
    std::uint64_t seed = 0;
    std::string mesh;  // the file of one in place of those of the scenes; empty without
};

/// The options that read_plan() reads.
std::span<const Option> plan_options();

/// Throws BadInput, which says what was wanted.
Plan read_plan(const Options& options);

}  // namespace throng::bench
