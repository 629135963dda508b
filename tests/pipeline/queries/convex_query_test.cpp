// Convex query: methods asked by name through the public door, and what is refused there.
#include "throng/throng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace throng {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

ShapeDescription box(double x, double y, double z) { return {"", BoxShape{{x, y, z}}}; }
ShapeDescription ball(double radius) { return {"", SphereShape{radius}}; }
Pose at(double x, double y, double z) { return {{x, y, z}, Quat::Identity()}; }

constexpr MethodStart kStarts[] = {MethodStart::cached, MethodStart::cold, MethodStart::plain};

TEST(KnownMethods, HaveNamesOfTheirOwnAndTellSomething)
{
    const std::vector<MethodDescription> methods = known_methods();
    ASSERT_FALSE(methods.empty());
    for (std::size_t i = 0; i < methods.size(); ++i) {
        EXPECT_FALSE(methods[i].name.empty());
        EXPECT_FALSE(methods[i].about.empty()) << methods[i].name;
        EXPECT_TRUE(methods[i].touch || methods[i].distance || methods[i].depth
                    || methods[i].volume)
            << methods[i].name;
        for (std::size_t k = 0; k < i; ++k) EXPECT_NE(methods[i].name, methods[k].name);
    }
}

TEST(ConvexQuery, TellsWhatAStepSees)
{
    const ConvexQuery query(box(0.5, 0.5, 0.5), ball(0.25));
    for (const auto& [precision, error] :
         {std::pair(Precision::float_, 1e-6), std::pair(Precision::double_, 1e-12)}) {
        const ConvexAnswer touching = query.touch(at(0.7, 0.1, 0.2), precision);
        EXPECT_EQ(touching.verdict, QueryVerdict::touching);
        EXPECT_NEAR(touching.separation, -0.05, error);
        EXPECT_NEAR((touching.normal - Vec3::UnitX()).norm(), 0, error);
        EXPECT_EQ(touching.surface, 0);  // of one point
        const ConvexQuery faces(box(0.5, 0.5, 0.5), box(0.3, 0.4, 0.2));
        EXPECT_NEAR(faces.touch(at(0.35, 0.2, 0.69), precision).surface, 0.45 * 0.7, error);
        EXPECT_EQ(query.touch(at(0.7501, 0.1, 0.2), precision).verdict, QueryVerdict::apart);
        EXPECT_EQ(query.touch(at(kNaN, 0, 0), precision).verdict, QueryVerdict::refused);
    }
    const ConvexQuery broken(box(-1, 1, 1), ball(0.25));
    EXPECT_EQ(broken.touch(Pose{}, Precision::float_).trouble, broken.trouble());
}

TEST(ConvexQuery, TreesPartWhatIsFarAndNeverWhatTouches)
{
    ConvexQuery query(box(0.5, 0.5, 0.5), box(0.5, 1, 1));
    for (const int k : {6, 14, 18, 26, 6}) {
        EXPECT_EQ(query.ask_trees(at(0.75, 0.1, 0.2), k).verdict, QueryVerdict::undecided);
        EXPECT_EQ(query.ask_trees(at(1.25, 0.1, 0.2), k).verdict, QueryVerdict::apart);
    }
    EXPECT_EQ(query.ask_trees(Pose{}, 7).verdict, QueryVerdict::refused);
    EXPECT_EQ(query.ask_trees(at(kNaN, 0, 0), 14).verdict, QueryVerdict::refused);
    ConvexQuery round(box(0.5, 0.5, 0.5), ball(0.25));
    EXPECT_EQ(round.ask_trees(Pose{}, 14).verdict, QueryVerdict::refused);
}

TEST(ConvexQuery, TellsOfBoxesWhatEachMethodClaims)
{
    const double shift = 0.75, clearance = 0.25;
    ConvexQuery query(box(0.5, 0.5, 0.5), box(0.5, 1, 1));
    EXPECT_EQ(query.trouble(), "");
    for (const MethodDescription& method : known_methods()) {
        for (const MethodStart start : kStarts) {
            const ConvexAnswer touching = query.ask(method.name, at(shift, 0.1, 0.2), start);
            const ConvexAnswer apart = query.ask(method.name, at(1 + clearance, 0.1, 0.2), start);
            ASSERT_EQ(touching.trouble, "");
            EXPECT_NE(touching.verdict, QueryVerdict::apart) << method.name;
            EXPECT_NE(apart.verdict, QueryVerdict::touching) << method.name;
            if (method.depth) {
                EXPECT_EQ(touching.verdict, QueryVerdict::touching) << method.name;
                EXPECT_NEAR(touching.separation, shift - 1, 1e-12) << method.name;
                EXPECT_NEAR((touching.normal - Vec3::UnitX()).norm(), 0, 1e-12) << method.name;
            }
            if (method.distance) {
                EXPECT_EQ(apart.verdict, QueryVerdict::apart) << method.name;
                EXPECT_NEAR(apart.separation, clearance, 1e-12) << method.name;
                EXPECT_NEAR((apart.on_b - apart.on_a - clearance * Vec3::UnitX()).norm(), 0, 1e-12);
            }
            if (method.volume) {
                EXPECT_NEAR(touching.volume, 0.25, 1e-12) << method.name;
                EXPECT_NEAR((touching.center - Vec3(0.375, 0, 0)).norm(), 0, 1e-12) << method.name;
            }
        }
    }
}

TEST(ConvexQuery, ServesRoundShapesWhereTheMethodDoes)
{
    ConvexQuery query(ball(0.5), {"", CapsuleShape{0.25, 1}});
    ASSERT_EQ(query.trouble(), "");
    for (const MethodDescription& method : known_methods()) {
        const ConvexAnswer answer = query.ask(method.name, at(1, 0, 0.5));
        if (method.polytopes_only) {
            EXPECT_EQ(answer.verdict, QueryVerdict::refused) << method.name;
            EXPECT_NE(answer.trouble.find(method.name), std::string::npos) << answer.trouble;
        } else if (method.distance) {
            EXPECT_EQ(answer.verdict, QueryVerdict::apart) << method.name;
            EXPECT_NEAR(answer.separation, 0.25, 1e-12) << method.name;
        }
    }
}

TEST(ConvexQuery, WhatItRemembersDependsOnTheMethodAlone)
{
    // Asked about one placing after another, all methods in turn: each start says the same.
    ConvexQuery query(box(0.5, 0.4, 0.3), box(0.2, 0.6, 0.3));
    for (int i = 0; i < 40; ++i) {
        const Quat turn = Quat(1, 0.02 * i, 0.3, -0.01 * i).normalized();
        const Pose pose{{0.9 - 0.02 * i, 0.1, 0.05}, turn};
        for (const MethodDescription& method : known_methods()) {
            const ConvexAnswer cached = query.ask(method.name, pose, MethodStart::cached);
            const ConvexAnswer plain = query.ask(method.name, pose, MethodStart::plain);
            EXPECT_EQ(cached.verdict, plain.verdict) << method.name << ", step " << i;
            if (method.depth && plain.verdict == QueryVerdict::touching) {
                EXPECT_NEAR(cached.separation, plain.separation, 1e-12) << method.name;
            }
        }
    }
}

TEST(ConvexQuery, RefusesQuestionsThatMakeNoSense)
{
    ConvexQuery query(box(1, 1, 1), box(1, 1, 1));
    const std::string_view good = known_methods().front().name;
    const auto trouble = [&](std::string_view method, const Pose& pose, double max_separation = 1) {
        const ConvexAnswer answer = query.ask(method, pose, MethodStart::cold, max_separation);
        EXPECT_EQ(answer.verdict, QueryVerdict::refused);
        return answer.trouble;
    };
    EXPECT_NE(trouble("gkj", Pose{}).find("there is no method \"gkj\""), std::string::npos);
    EXPECT_NE(trouble("", Pose{}).find(good), std::string::npos);
    EXPECT_NE(trouble(good, at(kNaN, 0, 0)).find("position"), std::string::npos);
    EXPECT_NE(trouble(good, at(1e300, 0, 0)).find("position"), std::string::npos);
    EXPECT_NE(trouble(good, {Vec3::Zero(), Quat(0, 0, 0, 0)}).find("unit"), std::string::npos);
    EXPECT_NE(trouble(good, {Vec3::Zero(), Quat(kNaN, 0, 0, 0)}).find("unit"), std::string::npos);
    EXPECT_NE(trouble(good, Pose{}, -1).find("reach"), std::string::npos);
    EXPECT_NE(trouble(good, Pose{}, kNaN).find("reach"), std::string::npos);
    EXPECT_EQ(query.ask(good, Pose{}).verdict, QueryVerdict::touching);
}

TEST(ConvexQuery, RefusesShapesThatASceneWouldRefuse)
{
    struct Bad {
        ShapeDescription shape;
        const char* says;
    };
    const Bad bad[] = {
        {ball(0), "sphere.radius: wanted a length above 0 m"},
        {ball(kNaN), "sphere.radius"},
        {box(1, -1, 1), "box.half_extents[1]: wanted a length above 0 m"},
        {box(1, 1, std::numeric_limits<double>::infinity()), "box.half_extents[2]"},
        {{"", CylinderShape{1, 0}}, "cylinder.half_length"},
        {{"", HullShape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}}, "lie in one plane"},
        {{"", HullShape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, kNaN}}}}, "points[3]"},
        {{"", HullShape{}}, "give at least 4"},
        {{"", PlaneShape{}}, "wanted a sphere, capsule, cylinder, box or hull"},
        {{"", MeshShape{}}, "wanted a sphere, capsule, cylinder, box or hull"},
        {{"", CompoundShape{}}, "wanted a sphere, capsule, cylinder, box or hull"},
    };
    for (const Bad& one : bad) {
        ConvexQuery first(one.shape, ball(1)), second(ball(1), one.shape);
        EXPECT_EQ(first.trouble().find("shape a: "), 0u) << first.trouble();
        EXPECT_EQ(second.trouble().find("shape b: "), 0u) << second.trouble();
        EXPECT_NE(first.trouble().find(one.says), std::string::npos) << first.trouble();
        for (const MethodDescription& method : known_methods()) {
            const ConvexAnswer answer = first.ask(method.name, Pose{});
            EXPECT_EQ(answer.verdict, QueryVerdict::refused);
            EXPECT_EQ(answer.trouble, first.trouble());
        }
    }
}

TEST(SeenFrom, LosesNothingFarFromTheOrigin)
{
    const Vec3 far(1e7, 0, -8e6);
    const Quat turn = Quat(1, 2, 3, 4).normalized();
    const Pose near = seen_from({Vec3::Zero(), turn}, {Vec3(0.5, 0.25, -1), Quat::Identity()});
    const Pose away = seen_from({far, turn}, {far + Vec3(0.5, 0.25, -1), Quat::Identity()});
    EXPECT_EQ(near.position, away.position);
    EXPECT_NEAR((turn * near.position - Vec3(0.5, 0.25, -1)).norm(), 0, 1e-15);
    EXPECT_NEAR((turn * near.orientation).angularDistance(Quat::Identity()), 0, 1e-15);
}

}  // namespace
}  // namespace throng
