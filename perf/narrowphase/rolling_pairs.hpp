// Rolling pairs: boxes and hulls that roll round one another at a gap that stays, step by step.
#pragma once

#include "narrowphase/alternatives/convex_methods.hpp"
#include "scene/catalog/random.hpp"

#include <memory>
#include <string>
#include <vector>

namespace throng::perf {

/// What pairs are made of, about 1 m across: boxes, or hulls of so many points on a ball; hulls of
/// one pair have as many.
struct Build {
    std::string name;
    std::size_t vertices_a = 0, vertices_b = 0;  // 0: a box
};

struct PairCase {
    const char* name;
    double clearance;           // m, below 0 minus the depth
    double speculative_margin;  // m
    bool either = false;        // every second pair is as deep as the others are apart
};

/// rad a step, of b round a and of b about itself.
struct Motion {
    const char* name;
    double angle;
};

constexpr std::size_t kSteps = 8;

/// Pairs in the poses of all steps, made once: placing them is not counted.
struct RollingPairs {
    RollingPairs(const Shapes& shapes,
                 const Build& build,
                 const PairCase& pair_case,
                 const Motion& motion,
                 std::size_t count);

    struct One {
        ShapeRef a, b;
        std::vector<Pose> b_in_a;                        // [kSteps]
        std::vector<std::unique_ptr<ConvexPair>> asked;  // [kSteps]
    };
    std::vector<One> pairs;
};

/// As many shapes of a build as are enough to choose from; more for a few vertices than for many.
Shapes make_shapes(const Build& build);

}  // namespace throng::perf
