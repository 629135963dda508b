// Round pairs: what the tests of capsules and spheres share: placements of every kind and size, and
// the general search in double as the slow twin.
#pragma once

#include "narrowphase/convex/contact_axis.hpp"
#include "narrowphase/convex/pair_functions.hpp"
#include "tests/support/direction_search.hpp"
#include "tests/support/finite_manifold.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng::given {

/// Two shapes, one of each kind, and where b is.
struct Placement {
    Shapes shapes;
    ShapeRef a, b;
    Pose b_in_a;

    /// What rounding is relative to.
    double size() const
    {
        const OutlinePair clearance = {outline_of(shapes, a), outline_of(shapes, b), b_in_a};
        double most = b_in_a.position.norm() + clearance.a.rounding + clearance.b.rounding;
        for (const Vec3& point : clearance.a.points) most = std::max(most, point.norm());
        for (const Vec3& point : clearance.b.points) most = std::max(most, point.norm());
        return most;
    }
    double along(const Vec3& normal) const
    {
        return OutlinePair{outline_of(shapes, a), outline_of(shapes, b), b_in_a}.along(normal);
    }
};

template <class Real>
LocalManifold<Real>
collide(PairFunction<Real> function, const Placement& pair, double speculative_margin)
{
    PairCache cache;
    LocalManifold<Real> manifold;
    const PoseT<Real> pose = {pair.b_in_a.position.cast<Real>(),
                              QuatT<Real>(pair.b_in_a.orientation.cast<Real>())};
    function({pair.shapes, pair.a, pair.b, pose, static_cast<Real>(speculative_margin)}, cache,
             manifold);
    return manifold;
}

template <class Real>
double deepest_of(const LocalManifold<Real>& manifold)
{
    double deepest = 1e300;
    for (int i = 0; i < manifold.count; ++i) {
        const auto& point = manifold.points[static_cast<std::size_t>(i)];
        deepest = std::min(deepest, static_cast<double>(point.separation));
    }
    return deepest;
}

/// The answer against the search of the general path, in double and in float. `exact` and `coarse`
/// are of the pair's size.
inline void expect_as_searched(PairFunction<double> in_double,
                               PairFunction<float> in_float,
                               const Placement& pair,
                               double exact,
                               double coarse)
{
    const double size = pair.size(), speculative_margin = 10 * size;
    const ConvexCorePair cores(pair.shapes, pair.a, pair.b, pair.b_in_a);
    ContactAxis searched;
    ASSERT_TRUE(search_axis(cores, 2 * speculative_margin, searched));
    const double separation = searched.separation - cores.a.convex_radius - cores.b.convex_radius;
    const auto found = collide<double>(in_double, pair, speculative_margin);
    const auto rounded = collide<float>(in_float, pair, speculative_margin);
    ASSERT_GT(found.count, 0);
    ASSERT_GT(rounded.count, 0);
    EXPECT_NEAR(deepest_of(found) / size, separation / size, exact);
    EXPECT_NEAR(deepest_of(rounded) / size, deepest_of(found) / size, coarse);
    // The normal keeps them apart by just that much.
    EXPECT_NEAR(found.normal.norm(), 1, 1e-12);
    EXPECT_NEAR(pair.along(found.normal) / size, deepest_of(found) / size, 1e-12);
    const Vec3 normal = rounded.normal.cast<double>();
    EXPECT_NEAR(normal.norm(), 1, 1e-6);
    EXPECT_NEAR(pair.along(normal.normalized()) / size, deepest_of(rounded) / size, coarse);
}

}  // namespace throng::given
