// Hull peers: other libraries asked about the same two hulls.
#pragma once

#include "kernels/data/shapes.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace throng::perf {

/// Two hulls, and b in a's frame from step to step.
struct HullsMoving {
    const Hull* a = nullptr;
    const Hull* b = nullptr;
    std::vector<Pose> b_in_a;
};

enum class Question { whether, distance, depth };

/// Another library, made ready for some pairs; what it answers, it answers for one at a time.
class HullPeer {
public:
    virtual ~HullPeer() = default;
    HullPeer() = default;
    HullPeer(const HullPeer&) = delete;
    HullPeer& operator=(const HullPeer&) = delete;

    /// m, the distance, or minus the depth; some number above the speculative margin where it is
    /// that far.
    ///
    ///   warm   with what it remembers of the pair, if it remembers anything
    virtual double
    ask(std::size_t pair, std::size_t step, double speculative_margin, bool warm) = 0;

    std::string name;
};

/// Those whose packages were found when this was built, and that know how to answer.
std::vector<std::unique_ptr<HullPeer>> make_hull_peers(std::span<const HullsMoving> pairs,
                                                       Question question);

}  // namespace throng::perf
