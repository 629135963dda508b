// Edge over a face: a plate on a ridge, a little out of true, as every way to collide them sees it.
#include "narrowphase/manifold/edge_over_face.hpp"

#include "cooking/hulls/hull.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "narrowphase/convex/pair_functions.hpp"
#include "narrowphase/convex/wide/box_pairs.hpp"
#include "narrowphase/dispatch.hpp"
#include "tests/support/polyhedra.hpp"
#include "throng/rotation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace throng {
namespace {

constexpr double kMargin = 0.05, kDeep = 1e-3;
const Vec3 kPlate(0.3, 0.2, 0.02), kBar(0.1, 2, 0.1);  // half extents
constexpr ShapeRef kHullA{ShapeKind::hull, 0}, kHullB{ShapeKind::hull, 1};

// A bar along y that stands on an edge, another on top.
const Pose kOnEdge{Vec3::Zero(), exponential(Vec3(0, std::numbers::pi / 4, 0))};
const double kTop = std::numbers::sqrt2 * kBar.x();

// A plate across the top edge, which leans along that and is so deep at the one end.
Pose across_ridge(double lean, double askew)
{
    const Quat turn = exponential(Vec3(lean, 0, 0)) * exponential(Vec3(0, 0, askew));
    const Vec3 along = turn.conjugate() * Vec3(0, std::cos(lean), std::sin(lean));
    const double half = std::min(kPlate.y() / std::abs(along.y()),
                                 kPlate.x() / std::max(std::abs(along.x()), 1e-9));
    const Vec3 middle(0, 0, kTop - kDeep + half * std::sin(std::abs(lean)));
    return {middle + turn * Vec3(0, 0, kPlate.z()), turn};
}

// In the world.
struct Seen {
    const char* by;
    std::vector<Vec3> at;
    double deepest = 1;
};

template <class Real>
Seen seen(const char* by, const LocalManifold<Real>& found, const Pose& frame)
{
    Seen seen{by, {}};
    for (int i = 0; i < found.count; ++i) {
        const auto& point = found.points[static_cast<std::size_t>(i)];
        seen.at.push_back(frame * Vec3(point.position.template cast<double>()));
        seen.deepest = std::min(seen.deepest, double{point.separation});
    }
    return seen;
}

// Two slopes of a sheet that runs on beyond the plate.
Mesh ridge_mesh()
{
    const std::vector<Vec3> vertices = {{-1, -2, kTop - 1}, {-1, 2, kTop - 1}, {0, -2, kTop},
                                        {0, 2, kTop},       {1, -2, kTop - 1}, {1, 2, kTop - 1}};
    return build_mesh(vertices, {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}}).mesh;
}

Seen seen_on_mesh(const Pose& plate)
{
    Shapes shapes;
    shapes.meshes = {ridge_mesh()};
    shapes.boxes = {{kPlate}};
    std::vector<PartManifold> found;
    collide_mesh({shapes, {ShapeKind::mesh, 0}, {ShapeKind::box, 0}, plate, kMargin}, found);
    Seen all{"mesh", {}};
    for (const auto& one : found) {
        const Seen here = seen("mesh", one.manifold, Pose{});
        all.at.insert(all.at.end(), here.at.begin(), here.at.end());
        all.deepest = std::min(all.deepest, here.deepest);
    }
    return all;
}

std::vector<Seen> all_ways(const Pose& plate)
{
    const Pose local = inverse(kOnEdge) * plate, turned = inverse(plate) * kOnEdge;
    const Shapes boxes = two_boxes(kBar, kPlate), swapped = two_boxes(kPlate, kBar);
    Shapes hulls;
    hulls.hulls = {build_hull(corners_of(kBar)).hull, build_hull(corners_of(kPlate)).hull};
    const BoxPair pair =
        box_pair({local.position.cast<float>(), local.orientation.cast<float>()},
                 kBar.cast<float>(), kPlate.cast<float>(), static_cast<float>(kMargin));
    LocalManifold<float> many;
    collide_boxes({&pair, 1}, {&many, 1});
    return {
        seen("boxes", run<double>(box_box<double>, boxes, kBoxA, kBoxB, local, kMargin), kOnEdge),
        seen("boxes, turned about",
             run<double>(box_box<double>, swapped, kBoxA, kBoxB, turned, kMargin), plate),
        seen("boxes, float", run<float>(box_box<float>, boxes, kBoxA, kBoxB, local, kMargin),
             kOnEdge),
        seen("many boxes", many, kOnEdge),
        seen("hulls", run<double>(hull_hull<double>, hulls, kHullA, kHullB, local, kMargin),
             kOnEdge),
        seen("hulls, float", run<float>(hull_hull<float>, hulls, kHullA, kHullB, local, kMargin),
             kOnEdge),
        seen_on_mesh(plate)};
}

double length_along(const Seen& seen)
{
    const auto [low, high] = std::minmax_element(
        seen.at.begin(), seen.at.end(), [](const Vec3& p, const Vec3& q) { return p.y() < q.y(); });
    return seen.at.empty() ? 0 : high->y() - low->y();
}

}  // namespace

TEST(EdgeOverFace, HoldsAPlateAtBothEndsOfTheRidge)
{
    for (const double lean : {1e-4, 1e-3, 0.01, 0.03, 0.08, -0.03})
        for (const double askew : {0.0, 0.2, 0.6})
            for (const Seen& found : all_ways(across_ridge(lean, askew))) {
                SCOPED_TRACE(testing::Message()
                             << found.by << ", lean " << lean << ", askew " << askew);
                EXPECT_GE(length_along(found), 1.9 * kPlate.y());
                EXPECT_NEAR(found.deepest, -kDeep, 1e-5);
            }
}

TEST(EdgeOverFace, HoldsOneThatLeansFurtherAtItsDeepEnd)
{
    for (const Seen& found : all_ways(across_ridge(0.2, 0.2))) {
        SCOPED_TRACE(found.by);
        EXPECT_LE(length_along(found), 0.1 * kPlate.y());
        EXPECT_NEAR(found.deepest, -kDeep * std::cos(0.2), 5e-5);
    }
}

}  // namespace throng
