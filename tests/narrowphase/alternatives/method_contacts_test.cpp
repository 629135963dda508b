// Method contacts: points of touch by each method that tells where.
#include "narrowphase/alternatives/method_contacts.hpp"

#include "cooking/hulls/hull.hpp"

#include <gtest/gtest.h>

#include <string>

namespace throng {
namespace {

constexpr ShapeRef kBox{ShapeKind::box, 0}, kSmall{ShapeKind::box, 1}, kBall{ShapeKind::sphere, 0};
constexpr ShapeRef kPrism{ShapeKind::hull, 0};

Shapes shapes()
{
    Shapes made;
    made.boxes = {{Vec3(0.5, 0.5, 0.5)}, {Vec3(0.25, 0.25, 0.25)}};
    made.spheres = {{0.5}};
    std::vector<Vec3> corners;
    for (int i = 0; i < 6; ++i)
        for (const double z : {-0.5, 0.5})
            corners.emplace_back(0.5 * std::cos(i * 1.0471975511965976),
                                 0.5 * std::sin(i * 1.0471975511965976), z);
    made.hulls = {build_hull(corners).hull};
    return made;
}

Pose at(const Vec3& position, const Quat& turn = Quat::Identity()) { return {position, turn}; }

class MethodContacts : public ::testing::TestWithParam<const char*> {
protected:
    bool collide(ShapeRef a, ShapeRef b, const Pose& b_in_a, double speculative_margin = 0.01)
    {
        MethodMemory memory;
        return collide_by(*find_convex_method(GetParam()), MethodStart::cached,
                          {all_, a, b, b_in_a, speculative_margin}, memory, out_);
    }

    Shapes all_ = shapes();
    LocalManifold<double> out_;
};

TEST_P(MethodContacts, ABoxOnABoxStandsOnFourCorners)
{
    ASSERT_TRUE(collide(kBox, kSmall, at({0.1, -0.05, 0.749})));
    ASSERT_EQ(out_.count, 4);
    EXPECT_NEAR((out_.normal - Vec3::UnitZ()).norm(), 0, 1e-9);
    for (int i = 0; i < 4; ++i) {
        const auto& point = out_.points[static_cast<std::size_t>(i)];
        EXPECT_NEAR(point.separation, -1e-3, 1e-9);
        EXPECT_NEAR(point.position.z(), 0.4995, 1e-9);
        EXPECT_NEAR(std::abs(point.position.x() - 0.1), 0.25, 1e-9);
        EXPECT_NEAR(std::abs(point.position.y() + 0.05), 0.25, 1e-9);
    }
}

TEST_P(MethodContacts, AHullOnABoxStandsOnSomeOfItsCorners)
{
    ASSERT_TRUE(collide(kBox, kPrism, at({0, 0, 0.998})));
    ASSERT_EQ(out_.count, 4);
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(out_.points[static_cast<std::size_t>(i)].separation, -2e-3, 1e-9);
}

TEST_P(MethodContacts, EdgesThatCrossTouchInOnePoint)
{
    // Each on an edge, at right angles: edges at heights 0.5 sqrt 2 of their centers.
    const double rise = 0.5 * std::sqrt(2.0);
    const Quat a_turn(Eigen::AngleAxisd(0.25 * 3.14159265358979323846, Vec3::UnitX()));
    const Quat b_turn(Eigen::AngleAxisd(0.25 * 3.14159265358979323846, Vec3::UnitY()));
    const Vec3 up(0.1, 0.05, 2 * rise - 0.002);
    ASSERT_TRUE(collide(kBox, kBox, {a_turn.conjugate() * up, a_turn.conjugate() * b_turn}));
    ASSERT_GE(out_.count, 1);
    const Vec3 normal = a_turn * out_.normal;
    EXPECT_NEAR(normal.z(), 1, 1e-6);
    const Vec3 point = a_turn * out_.points[0].position;
    EXPECT_NEAR(out_.points[0].separation, -0.002, 1e-8);
    EXPECT_NEAR((point - Vec3(0.1, 0, rise - 0.001)).norm(), 0, 0.0501) << point.transpose();
}

TEST_P(MethodContacts, WhatIsOutOfReachHasNoPoint)
{
    EXPECT_TRUE(collide(kBox, kSmall, at({0, 0, 0.77})));
    EXPECT_EQ(out_.count, 0);
    EXPECT_TRUE(collide(kBox, kPrism, at({5, 0, 0})));
    EXPECT_EQ(out_.count, 0);
}

INSTANTIATE_TEST_SUITE_P(Methods,
                         MethodContacts,
                         ::testing::Values("gjk", "sat", "clip_volume"),
                         [](const auto& one) { return std::string(one.param); });

TEST(CollideBy, GjkAndSatTellOfWhatIsWithinTheMargin)
{
    const Shapes all = shapes();
    for (const char* name : {"gjk", "sat"})
        for (const MethodStart start : {MethodStart::cached, MethodStart::cold}) {
            MethodMemory memory;
            LocalManifold<double> out;
            ASSERT_TRUE(collide_by(*find_convex_method(name), start,
                                   {all, kBox, kSmall, at({0, 0, 0.755}), 0.01}, memory, out));
            ASSERT_EQ(out.count, 4) << name;
            EXPECT_NEAR(out.points[0].separation, 5e-3, 1e-9) << name;
        }
}

TEST(CollideBy, RoundShapesAreGjksAlone)
{
    const Shapes all = shapes();
    MethodMemory memory;
    LocalManifold<double> out;
    ASSERT_TRUE(collide_by(*find_convex_method("gjk"), MethodStart::cached,
                           {all, kBall, kBox, at({0, 0, 0.999}), 0.01}, memory, out));
    ASSERT_EQ(out.count, 1);
    EXPECT_NEAR(out.points[0].separation, -1e-3, 1e-9);
    EXPECT_NEAR((out.points[0].position - Vec3(0, 0, 0.4995)).norm(), 0, 1e-6);
    for (const char* name : {"sat", "clip_volume", "containment"})
        EXPECT_FALSE(collide_by(*find_convex_method(name), MethodStart::cached,
                                {all, kBall, kBox, at({0, 0, 0.999}), 0.01}, memory, out))
            << name;
}

TEST(CollideBy, WhoTellsOfTouchAloneLeavesTheRestToOthers)
{
    const Shapes all = shapes();
    for (const char* name : {"chung_wang", "containment", "k_dop:14", "sphere"}) {
        MethodMemory memory;
        LocalManifold<double> out;
        EXPECT_FALSE(collide_by(*find_convex_method(name), MethodStart::cached,
                                {all, kBox, kSmall, at({0, 0, 0.749}), 0.01}, memory, out))
            << name;
        EXPECT_TRUE(collide_by(*find_convex_method(name), MethodStart::cached,
                               {all, kBox, kSmall, at({0, 0, 3}), 0.01}, memory, out))
            << name;
        EXPECT_EQ(out.count, 0);
    }
}

TEST(CollideBy, WhoTellsOfTouchAloneLeavesWhatIsWithinTheMarginToOthers)
{
    const Shapes all = shapes();
    for (const char* name : {"chung_wang", "containment"})
        for (const int axis : {0, 1, 2})
            for (const bool swapped : {false, true}) {
                const Vec3 way = Vec3::Unit(axis);
                // A small box, turned about the way to it, out from a face of another.
                const auto told = [&](double clearance, LocalManifold<double>& out) {
                    const Pose b_in_a{way * (0.75 + clearance), Quat(Eigen::AngleAxisd(0.3, way))};
                    const Pose a_in_b{b_in_a.orientation.conjugate() * -b_in_a.position,
                                      b_in_a.orientation.conjugate()};
                    MethodMemory memory;
                    return collide_by(*find_convex_method(name), MethodStart::cached,
                                      {all, swapped ? kSmall : kBox, swapped ? kBox : kSmall,
                                       swapped ? a_in_b : b_in_a, 0.01},
                                      memory, out);
                };
                LocalManifold<double> out;
                EXPECT_FALSE(told(0.005, out)) << name << ' ' << way.transpose();
                EXPECT_FALSE(told(0.0099, out)) << name << ' ' << way.transpose();
                EXPECT_TRUE(told(0.5, out)) << name << ' ' << way.transpose();
                EXPECT_EQ(out.count, 0);
            }
}

}  // namespace
}  // namespace throng
