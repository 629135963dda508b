#include "kernels/geometry/closest_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace throng {
namespace {

template <class Real>
class ClosestPointsOf : public testing::Test { };
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(ClosestPointsOf, NumberTypes);

// How far results may be off, against the size of what was given.
template <class Real>
constexpr double kRounding = 300 * static_cast<double>(std::numeric_limits<Real>::epsilon());

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) { }
    double uniform() { return unit_(engine_); }
    int below(int count) { return static_cast<int>((unit_(engine_) + 1) / 2 * count); }
    Vec3 in_box() { return {uniform(), uniform(), uniform()}; }
    // On a coarse lattice, so that parallel, crossing and touching happen often.
    Vec3 on_lattice() { return {double(below(3)), double(below(3)), double(below(3))}; }

private:
    std::mt19937_64 engine_;
    std::uniform_real_distribution<double> unit_{-1, 1};
};

// The plain twins: a convex function over [0, 1], by cutting the range in three, again and again.
template <class Measure>
double least(Measure measure)
{
    double low = 0, high = 1;
    for (int i = 0; i < 90; ++i) {
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        const bool nearer = measure(a) < measure(b);
        (nearer ? high : low) = nearer ? b : a;
    }
    return std::min({measure(low), measure(0.0), measure(1.0)});
}

double point_to_segment(const Vec3& p, const Vec3& from, const Vec3& to)
{
    return least([&](double t) { return (from + t * (to - from) - p).norm(); });
}

double segment_to_segment(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    return least([&](double t) { return point_to_segment(a + t * (b - a), c, d); });
}

double point_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
    return least([&](double t) { return point_to_segment(p, a + t * (b - a), a + t * (c - a)); });
}

// Four points of a kind that the seed chooses: anywhere, on a lattice, tiny, huge, long and thin.
std::array<Vec3, 4> some_points(unsigned seed)
{
    Random random(seed);
    std::array<Vec3, 4> points;
    for (Vec3& p : points) p = seed % 2 == 0 ? random.in_box() : random.on_lattice();
    const double sizes[] = {1, 1e-6, 1e6};
    const double size = sizes[seed % 3];
    const double thin = seed % 5 == 0 ? 1e-4 : 1;
    for (Vec3& p : points) p = size * p.cwiseProduct(Vec3(1, thin, thin));
    return points;
}

double size_of(const std::array<Vec3, 4>& points)
{
    double size = 0;
    for (const Vec3& p : points) size = std::max(size, p.norm());
    return size;
}

TYPED_TEST(ClosestPointsOf, PointAndSegmentMatchesSearch)
{
    using Real = TypeParam;
    for (unsigned seed = 0; seed < 2000; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto [p, a, b, unused] = some_points(seed);
        const auto found =
            closest_on_segment<Real>(p.cast<Real>(), {a.cast<Real>(), b.cast<Real>()});
        const double distance = (found.point.template cast<double>() - p).norm();
        EXPECT_NEAR(distance, point_to_segment(p, a, b),
                    kRounding<Real> * size_of({p, a, b, unused}));
        EXPECT_GE(found.at, 0);
        EXPECT_LE(found.at, 1);
    }
}

TYPED_TEST(ClosestPointsOf, SegmentsMatchSearch)
{
    using Real = TypeParam;
    using V = Vec3T<Real>;
    for (unsigned seed = 0; seed < 600; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto points = some_points(seed);
        const auto& [a, b, c, d] = points;
        const Segment<Real> first{a.cast<Real>(), b.cast<Real>()};
        const Segment<Real> second{c.cast<Real>(), d.cast<Real>()};
        const ClosestPoints<Real> found = closest_points(first, second);
        const double tolerance = kRounding<Real> * size_of(points);
        const V between = found.on_b - found.on_a;
        EXPECT_NEAR(static_cast<double>(between.norm()), segment_to_segment(a, b, c, d), tolerance);

        // The points lie where they are said to, and a swapped with b is as far apart.
        const V at_a = first.from + found.at_a * (first.to - first.from);
        const V at_b = second.from + found.at_b * (second.to - second.from);
        EXPECT_LE(static_cast<double>((at_a - found.on_a).norm()), tolerance);
        EXPECT_LE(static_cast<double>((at_b - found.on_b).norm()), tolerance);
        const ClosestPoints<Real> swapped = closest_points(second, first);
        EXPECT_NEAR(static_cast<double>((swapped.on_b - swapped.on_a).norm()),
                    static_cast<double>(between.norm()), tolerance);
    }
}

TYPED_TEST(ClosestPointsOf, NearlyParallelSegmentsMatchSearch)
{
    using Real = TypeParam;
    for (unsigned seed = 0; seed < 600; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const double slant = std::pow(10.0, -random.below(18));
        const Vec3 from = random.in_box(), along = random.in_box();
        const Vec3 start = random.in_box();
        const auto real = [](const Vec3& v) { return Vec3T<Real>(v.cast<Real>()); };
        const Segment<Real> a{real(from), real(from + along)};
        const Segment<Real> b{real(start),
                              real(start + random.uniform() * along + slant * random.in_box())};
        const ClosestPoints<Real> found = closest_points(a, b);
        const auto back = [](const Vec3T<Real>& v) { return Vec3(v.template cast<double>()); };
        EXPECT_NEAR((back(found.on_b) - back(found.on_a)).norm(),
                    segment_to_segment(back(a.from), back(a.to), back(b.from), back(b.to)),
                    kRounding<Real>);
    }
}

TYPED_TEST(ClosestPointsOf, ParallelSegmentsStayNearTheStartOfA)
{
    using Real = TypeParam;
    using V = Vec3T<Real>;
    const Segment<Real> a{V(0, 0, 0), V(4, 0, 0)};
    const auto at = [&](Real from, Real to) {
        return closest_points(a, {V(from, 1, 0), V(to, 1, 0)});
    };
    for (const auto& found : {at(-1, 5), at(5, -1), at(0, 4), at(-1, 2), at(2, -1)}) {
        EXPECT_EQ(found.on_a, V(0, 0, 0));
        EXPECT_EQ(found.on_b, V(0, 1, 0));
    }
    EXPECT_EQ(at(1, 3).on_a, V(1, 0, 0));
    EXPECT_EQ(at(3, 1).on_a, V(1, 0, 0));
    EXPECT_EQ(at(-3, -1).on_a, V(0, 0, 0));
    EXPECT_EQ(at(-3, -1).on_b, V(-1, 1, 0));
    EXPECT_EQ(at(5, 7).on_a, V(4, 0, 0));
    EXPECT_EQ(at(5, 7).on_b, V(5, 1, 0));
}

TYPED_TEST(ClosestPointsOf, SegmentsOfNoLengthArePoints)
{
    using Real = TypeParam;
    using V = Vec3T<Real>;
    const Segment<Real> point{V(1, 2, 3), V(1, 2, 3)}, other{V(4, 6, 3), V(4, 6, 3)};
    const Segment<Real> segment{V(0, 0, 3), V(2, 0, 3)};
    EXPECT_EQ(closest_points(point, other).on_a, point.from);
    EXPECT_EQ(closest_points(point, other).on_b, other.from);
    EXPECT_EQ(closest_points(point, segment).on_b, V(1, 0, 3));
    EXPECT_EQ(closest_points(segment, point).on_a, V(1, 0, 3));
    EXPECT_EQ(closest_on_segment<Real>(V(9, 9, 9), point).point, point.from);
}

TYPED_TEST(ClosestPointsOf, PointAndTriangleMatchesSearch)
{
    using Real = TypeParam;
    for (unsigned seed = 0; seed < 600; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto points = some_points(seed);
        const auto& [p, a, b, c] = points;
        const auto found = closest_on_triangle<Real>(p.cast<Real>(), a.cast<Real>(), b.cast<Real>(),
                                                     c.cast<Real>());
        const double distance = (found.point.template cast<double>() - p).norm();
        const double tolerance = kRounding<Real> * size_of(points);
        EXPECT_NEAR(distance, point_to_triangle(p, a, b, c), tolerance);

        EXPECT_GE(found.weights.minCoeff(), 0);
        EXPECT_NEAR(static_cast<double>(found.weights.sum()), 1, kRounding<Real>);
        const Vec3 weights = found.weights.template cast<double>();
        const Vec3 said = weights[0] * a + weights[1] * b + weights[2] * c;
        EXPECT_LE((said - found.point.template cast<double>()).norm(), tolerance);
    }
}

TYPED_TEST(ClosestPointsOf, RegionsOfATriangleAreToldApart)
{
    using Real = TypeParam;
    using V = Vec3T<Real>;
    const auto region = [](Real x, Real y) {
        return closest_on_triangle<Real>(V(x, y, 1), V(0, 0, 0), V(2, 0, 0), V(0, 2, 0)).region;
    };
    EXPECT_EQ(region(Real(0.5), Real(0.5)), TriangleRegion::face);
    EXPECT_EQ(region(1, -1), TriangleRegion::edge0);
    EXPECT_EQ(region(2, 2), TriangleRegion::edge1);
    EXPECT_EQ(region(-1, 1), TriangleRegion::edge2);
    EXPECT_EQ(region(-1, -1), TriangleRegion::vertex0);
    EXPECT_EQ(region(3, -1), TriangleRegion::vertex1);
    EXPECT_EQ(region(-1, 3), TriangleRegion::vertex2);
}

TYPED_TEST(ClosestPointsOf, TrianglesOfNoAreaAreSegmentsOrPoints)
{
    using Real = TypeParam;
    using V = Vec3T<Real>;
    const V p(1, 1, 1), o(0, 0, 0), far(4, 0, 0), mid(3, 0, 0);
    for (const auto& found :
         {closest_on_triangle<Real>(p, o, far, mid), closest_on_triangle<Real>(p, mid, o, far),
          closest_on_triangle<Real>(p, far, far, o), closest_on_triangle<Real>(p, o, o, far)}) {
        EXPECT_LE(static_cast<double>((found.point - V(1, 0, 0)).norm()), kRounding<Real>);
        EXPECT_NE(found.region, TriangleRegion::face);
    }
    EXPECT_EQ(closest_on_triangle<Real>(p, far, far, far).point, far);
}

TYPED_TEST(ClosestPointsOf, FiniteGivesFiniteAtEverySize)
{
    using Real = TypeParam;
    const double top = std::is_same_v<Real, float> ? 1e15 : 1e120;
    for (double size = 1 / (top * top); size < top; size *= 1000)
        for (unsigned seed = 0; seed < 50; ++seed) {
            Random random(seed);
            std::array<Vec3T<Real>, 4> p;
            for (auto& point : p) {
                const double own = random.below(2) == 0 ? size : 1;
                point = (own * (seed % 2 == 0 ? random.in_box() : random.on_lattice()))
                            .template cast<Real>();
            }
            const auto segments = closest_points<Real>({p[0], p[1]}, {p[2], p[3]});
            EXPECT_TRUE(segments.on_a.allFinite() && segments.on_b.allFinite()) << size;
            EXPECT_TRUE(closest_on_triangle(p[0], p[1], p[2], p[3]).point.allFinite()) << size;
        }
}

}  // namespace
}  // namespace throng
