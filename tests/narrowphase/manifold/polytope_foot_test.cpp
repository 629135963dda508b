#include "narrowphase/manifold/polytope_foot.hpp"

#include "cooking/hulls/hull.hpp"
#include "narrowphase/manifold/contact_points.hpp"
#include "narrowphase/manifold/foot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace throng {
namespace {

// Its top is at z = 0.
struct Slab {
    BoxPolytope box{Vec3(1, 1, 0.5)};

    Slab()
    {
        for (Vec3& vertex : box.vertices) vertex.z() -= 0.5;
        for (std::size_t i = 0; i < 6; ++i) box.offsets[i] -= 0.5 * box.view().normals[i].z();
    }
    PolytopeView view() const
    {
        PolytopeView view = box.view();
        view.center = Vec3(0, 0, -0.5);
        return view;
    }
};

// A pebble of many small faces.
class FootOnSlab : public testing::Test {
protected:
    static constexpr double kSize = 0.012;  // m

    FootOnSlab()
    {
        std::uniform_real_distribution<double> number(-1, 1);
        std::vector<Vec3> points;
        for (int i = 0; i < 24; ++i)
            points.push_back(kSize * Vec3(number(engine_), number(engine_), 0.6 * number(engine_)));
        pebble_ = build_hull(points).hull;
    }

    PolytopePair pair_at(const Pose& pose) const { return {slab_.view(), view_of(pebble_), pose}; }

    std::uint16_t top_of(const PolytopePair& pair) const
    {
        std::uint16_t top = 0;
        while (pair.a.normals[top].z() < 0.5) ++top;
        return top;
    }

    // As the narrow phase has it before the foot is spread.
    LocalManifold<double> clipped(const PolytopePair& pair, double margin) const
    {
        PolytopePoints found;
        clip_faces(pair, face_axis(pair, top_of(pair)), margin, 0, found);
        LocalManifold<double> out;
        out.normal = Vec3::UnitZ();
        reduce_to_four<double>({found.points.data(), found.count}, out);
        return out;
    }

    // Turned at random, its lowest corner this high.
    Pose random_pose(double height)
    {
        std::normal_distribution<double> number;
        Pose pose;
        pose.orientation =
            Quat(number(engine_), number(engine_), number(engine_), number(engine_)).normalized();
        double lowest = 0;
        for (const Vec3& vertex : pebble_.vertices)
            lowest = std::min(lowest, (pose.orientation * vertex).z());
        pose.position = Vec3(0.1, -0.2, height - lowest);
        return pose;
    }

    std::mt19937_64 engine_{7};
    Slab slab_;
    Hull pebble_;
};

bool same(const LocalManifold<double>& one, const LocalManifold<double>& two)
{
    if (one.count != two.count) return false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(one.count); ++i)
        if (one.points[i].position != two.points[i].position
            || one.points[i].separation != two.points[i].separation)
            return false;
    return true;
}

// Whether some direction along the floor has all of the points behind the middle: every direction
// is asked, in small steps.
bool tips(const LocalManifold<double>& manifold, const Vec3& middle)
{
    for (int i = 0; i < 720; ++i) {
        const double angle = std::numbers::pi * i / 360;
        const Vec3 ahead(std::cos(angle), std::sin(angle), 0);
        bool held = false;
        for (int k = 0; k < manifold.count; ++k)
            held = held
                || ahead.dot(manifold.points[static_cast<std::size_t>(k)].position - middle) > 0;
        if (!held) return true;
    }
    return false;
}

struct Places {
    std::vector<Vec3> places;

    std::size_t size() const { return places.size(); }
    const Vec3& at(std::size_t i) const { return places[i]; }
    double height(std::size_t i) const { return places[i].z(); }
};

}  // namespace

TEST_F(FootOnSlab, ByLongStepsWhatDoesNotStandIsSpread)
{
    const double margin = 2 * kSize;
    int stood = 0, stand = 0;
    for (int i = 0; i < 500; ++i) {
        const PolytopePair pair = pair_at(random_pose(0));
        const Vec3 middle = pair.turn * pair.b.center + pair.shift;
        LocalManifold<double> manifold = clipped(pair, margin);
        const LocalManifold<double> before = manifold;
        spread_foot(pair, top_of(pair), margin, manifold);
        if (!tips(before, middle)) {
            EXPECT_TRUE(same(before, manifold)) << i;
        }
        stood += tips(before, middle) ? 0 : 1;
        stand += tips(manifold, middle) ? 0 : 1;
    }
    // Four points of many do not always do.
    EXPECT_LT(stood, 150);
    EXPECT_GT(stand, 400);
}

TEST_F(FootOnSlab, PointsAreCornersOverTheFaceAtTheirOwnHeights)
{
    const double margin = 2 * kSize;
    for (int i = 0; i < 200; ++i) {
        Pose pose = random_pose(-0.1 * kSize);
        // Half of them hang over the side.
        if (i % 2 == 0) pose.position.x() = 1;
        const PolytopePair pair = pair_at(pose);
        LocalManifold<double> manifold = clipped(pair, margin);
        spread_foot(pair, top_of(pair), margin, manifold);
        EXPECT_EQ(manifold.normal, Vec3::UnitZ());
        double lowest = 1;
        for (int k = 0; k < manifold.count; ++k) {
            const auto& point = manifold.points[static_cast<std::size_t>(k)];
            EXPECT_LE(point.position.x(), 1 + 1e-9);
            EXPECT_LE(point.separation, margin);
            EXPECT_NEAR(point.position.z(), point.separation / 2, 1e-12);
            lowest = std::min(lowest, point.separation);
        }
        if (i % 2 != 0) {
            EXPECT_NEAR(lowest, -0.1 * kSize, 1e-4 * kSize);
        }
    }
}

TEST_F(FootOnSlab, ByShortStepsNothingChangesUnlessItSinks)
{
    const double margin = 0.1 * pebble_.inner_radius;
    for (int i = 0; i < 200; ++i) {
        const PolytopePair pair = pair_at(random_pose(0));
        LocalManifold<double> manifold = clipped(pair, margin);
        const LocalManifold<double> before = manifold;
        spread_foot(pair, top_of(pair), margin, manifold);
        EXPECT_TRUE(same(before, manifold)) << i;
    }
    int spread = 0;
    for (int i = 0; i < 200; ++i) {
        const PolytopePair pair = pair_at(random_pose(-0.5 * pebble_.inner_radius));
        LocalManifold<double> manifold = clipped(pair, margin);
        const LocalManifold<double> before = manifold;
        spread_foot(pair, top_of(pair), margin, manifold);
        spread += same(before, manifold) ? 0 : 1;
    }
    EXPECT_GT(spread, 50);
}

// A wheel of many corners: those right below bear it and not those that a wide tilt would reach.
TEST(Foot, StandsByTheLeastTiltThatWillDo)
{
    Places wheel;
    constexpr int kSides = 200;
    for (int i = 0; i < kSides; ++i)
        for (const double y : {-0.05, 0.05}) {
            const double angle = 2 * std::numbers::pi * (i + 0.5) / kSides;
            wheel.places.emplace_back(0.3 * std::sin(angle), y, 0.3 - 0.3 * std::cos(angle));
        }
    Foot<double, Places> foot(wheel, -Vec3::UnitZ(), 0.2);
    foot.spread_to_stand(0.3, 0.5, Vec3(0, 0, 0.3));
    EXPECT_TRUE(foot.stands(Vec3(0, 0, 0.3)));
    for (const std::size_t i : foot.chosen()) {
        if (i == foot.kNone) continue;
        EXPECT_LT(std::abs(wheel.places[i].x()), 0.03);
    }
    foot.spread(0.3, 0.5, 0);
    double widest = 0;
    for (const std::size_t i : foot.chosen())
        if (i != foot.kNone) widest = std::max(widest, std::abs(wheel.places[i].x()));
    EXPECT_GT(widest, 0.1);
}

}  // namespace throng
