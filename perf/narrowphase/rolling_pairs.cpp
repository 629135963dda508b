#include "perf/narrowphase/rolling_pairs.hpp"

#include "cooking/hulls/hull.hpp"
#include "scene/catalog/parts.hpp"

#include <algorithm>

namespace throng::perf {
namespace {

// As many vertices as points: all points of a ball are corners.
Hull round_hull(Random& random, std::size_t vertices)
{
    std::vector<Vec3> points(vertices);
    for (Vec3& point : points) point = random_direction(random) / 2;
    return build_hull(points).hull;
}

ShapeRef any_of(const Shapes& shapes, std::size_t vertices, Random& random)
{
    const bool is_box = vertices == 0;
    const std::size_t count = is_box ? shapes.boxes.size() : shapes.hulls.size();
    return {is_box ? ShapeKind::box : ShapeKind::hull,
            random.below(static_cast<std::uint32_t>(count))};
}

double separation(const Shapes& shapes, const RollingPairs::One& one, const Pose& pose)
{
    const ConvexPair pair(shapes, one.a, one.b, pose);
    MethodMemory memory;
    return find_convex_method("gjk")->ask(pair, 1e9, MethodStart::cold, memory).separation;
}

}  // namespace

Shapes make_shapes(const Build& build)
{
    Random random(1);
    Shapes shapes;
    for (int i = 0; i < 16; ++i) shapes.boxes.push_back({random_vector(random, 0.2, 0.5)});
    const std::size_t vertices = std::max(build.vertices_a, build.vertices_b);
    const int hulls = vertices == 0 ? 0 : vertices > 1000 ? 3 : vertices > 128 ? 8 : 16;
    for (int i = 0; i < hulls; ++i) shapes.hulls.push_back(round_hull(random, vertices));
    return shapes;
}

RollingPairs::RollingPairs(const Shapes& shapes,
                           const Build& build,
                           const PairCase& pair_case,
                           const Motion& motion,
                           std::size_t count)
{
    Random random(2);
    for (std::size_t i = 0; i < count; ++i) {
        One one;
        one.a = any_of(shapes, build.vertices_a, random);
        one.b = any_of(shapes, build.vertices_b, random);
        Vec3 from = random_direction(random);
        Quat orientation = random_turn(random, 3);
        const Quat round = turn(random_direction(random), motion.angle);
        const Quat about = turn(random_direction(random), motion.angle);
        const double wanted =
            pair_case.either && i % 2 == 1 ? -pair_case.clearance : pair_case.clearance;
        double found = 1;
        for (std::size_t step = 0; step < kSteps; ++step) {
            // Along the way that b lies, nearer or further until the gap is the one wanted.
            double near = 0, far = 4;
            for (int halving = 0; halving < 46; ++halving) {
                found = (near + far) / 2;
                const double clearance = separation(shapes, one, {found * from, orientation});
                (clearance < wanted ? near : far) = found;
            }
            one.b_in_a.push_back({found * from, orientation});
            one.asked.push_back(
                std::make_unique<ConvexPair>(shapes, one.a, one.b, one.b_in_a.back()));
            from = (round * from).normalized();
            orientation = (about * orientation).normalized();
        }
        pairs.push_back(std::move(one));
    }
}

}  // namespace throng::perf
