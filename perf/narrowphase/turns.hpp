// Turns: things that take turns over the same pairs in the same poses, so that ratios hold on a
// busy machine; of each the best turn counts.
#pragma once

#include "perf/narrowphase/rolling_pairs.hpp"

#include <functional>
#include <limits>

namespace throng::perf {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Effort {
    std::size_t pairs = 48;
    int turns = 7;
    double turn = 3e-3;  // s, beyond which a turn asks less
    std::size_t judged = 12;
};

/// One that takes turns with others: asks about some pairs in the pose of a step, and gives a
/// number that hangs on all answers.
struct Turn {
    std::function<double(std::size_t pairs, std::size_t step)> ask;
    std::size_t pairs = 0;  // of those there are: fewer where a turn would take too long
    double best = kNone;    // ns of one question, thread processor time
    int turns = 0;

    void run(const Effort& effort);
};

void take_turns(std::vector<Turn>& turns, const Effort& effort);

}  // namespace throng::perf
