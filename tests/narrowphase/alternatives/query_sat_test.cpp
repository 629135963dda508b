#include "narrowphase/alternatives/query_sat.hpp"

#include "tests/support/polytope_pairs.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace throng {
namespace {

constexpr double kFar = 1e300;

MethodAnswer ask(const ConvexPair& pair, MethodStart start)
{
    MethodMemory memory;
    return query_sat(pair, kFar, start, memory);
}

// As deep, and along an axis that shows it; apart, along one that parts them.
void expect_as_plain(const ConvexPair& pair, const MethodAnswer& plain, const MethodAnswer& other)
{
    const double small = 1e-12 * (pair.size() + pair.cores().b_position.norm());
    const double shown = separation_along(pair.cores(), other.normal);
    ASSERT_NEAR(other.normal.norm(), 1, 1e-12);
    ASSERT_NEAR(shown, other.separation, small);
    if (std::abs(plain.separation) > small) {
        ASSERT_EQ(other.overlap, plain.overlap);
    }
    if (plain.overlap == OverlapState::apart) {
        ASSERT_LE(other.separation, plain.separation + small);
    } else {
        ASSERT_NEAR(other.separation, plain.separation, small);
    }
}

TEST(QuerySat, FastAndPlainAgreeHoweverTheyMeet)
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        MeetingPairs cases(91, scale);
        const int pairs = scale == 1 ? 10000 : 5000;
        for (int i = 0; i < pairs; ++i) {
            SCOPED_TRACE("seed 91, scale " + std::to_string(scale) + ", pair " + std::to_string(i));
            cases.next();
            const ConvexPair pair(cases.shapes(), cases.a, cases.b, cases.b_in_a);
            expect_as_plain(pair, ask(pair, MethodStart::plain), ask(pair, MethodStart::cold));
            if (HasFatalFailure()) return;
        }
    }
}

TEST(QuerySat, SwappedTheySayTheSame)
{
    MeetingPairs cases(92, 1);
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE("seed 92, pair " + std::to_string(i));
        cases.next();
        const ConvexPair pair(cases.shapes(), cases.a, cases.b, cases.b_in_a);
        const ConvexPair turned(cases.shapes(), cases.b, cases.a, inverse(cases.b_in_a));
        const double small = 1e-12 * (pair.size() + cases.b_in_a.position.norm());
        const MethodAnswer one = ask(pair, MethodStart::cold);
        const MethodAnswer other = ask(turned, MethodStart::cold);
        if (std::abs(one.separation) > small) {
            ASSERT_EQ(one.overlap, other.overlap);
        }
        if (one.overlap == OverlapState::touching && other.overlap == OverlapState::touching) {
            ASSERT_NEAR(one.separation, other.separation, small);
        }
    }
}

// A wrong memory, as of another pair, is a bad start and no more.
TEST(QuerySat, WhatIsRememberedChangesNothing)
{
    MeetingPairs cases(93, 1);
    MethodMemory wrong;
    for (int i = 0; i < 1000; ++i) {
        SCOPED_TRACE("seed 93, pair " + std::to_string(i));
        cases.next();
        MethodMemory own;
        ConvexPair pair(cases.shapes(), cases.a, cases.b, cases.b_in_a);
        for (int step = 0; step < 4; ++step) {
            Pose pose = cases.b_in_a;
            pose.position *= 1 - 0.02 * step;
            pose.orientation = pose.orientation * Quat(1, 0.01 * step, 0, 0).normalized();
            pair.place(pose);
            const MethodAnswer plain = ask(pair, MethodStart::plain);
            expect_as_plain(pair, plain, query_sat(pair, kFar, MethodStart::cached, own));
            expect_as_plain(pair, plain, query_sat(pair, kFar, MethodStart::cached, wrong));
            if (HasFatalFailure()) return;
        }
    }
}

// One look each, while the axis that parted them still does.
TEST(QuerySat, TheAxisRememberedPartsThemAtOnce)
{
    MeetingPairs cases(94, 1);
    int parted = 0, at_once = 0;
    for (int i = 0; i < 2000; ++i) {
        cases.next();
        ConvexPair pair(cases.shapes(), cases.a, cases.b, cases.b_in_a);
        MethodMemory memory;
        if (query_sat(pair, kFar, MethodStart::cold, memory).overlap != OverlapState::apart)
            continue;
        Pose pose = cases.b_in_a;
        pose.orientation = pose.orientation * Quat(1, 0.002, 0.001, 0).normalized();
        pair.place(pose);
        const MethodAnswer warm = query_sat(pair, kFar, MethodStart::cached, memory);
        if (warm.overlap != OverlapState::apart) continue;
        ++parted;
        at_once += warm.rounds == 1 ? 1 : 0;
    }
    EXPECT_GT(parted, 500);
    EXPECT_GT(at_once, parted * 98 / 100) << "seed 94";
}

// Corners a little off their faces' planes stick out beyond edges, and are not overlooked.
TEST(QuerySat, UnevenFacesAreNoTrouble)
{
    RandomShapes random(95);
    Shapes shapes;
    for (int i = 0; i < 8; ++i) {
        std::vector<Vec3> cloud = corners_of(Vec3(0.5, 0.4, 0.3));
        for (int k = 0; k < 60; ++k) {
            Vec3 point = random.vector(-1, 1);
            point[k % 3] = (k % 2 == 0 ? 1 : -1) * (1 + random.number(0, 2e-5));
            cloud.emplace_back(point.cwiseProduct(Vec3(0.5, 0.4, 0.3)));
        }
        shapes.hulls.push_back(build_hull(cloud).hull);
    }
    for (int i = 0; i < 1000; ++i) {
        SCOPED_TRACE("seed 95, pair " + std::to_string(i));
        const auto a = static_cast<std::uint32_t>(i % 8), b = static_cast<std::uint32_t>(i % 7);
        const ConvexPair pair(shapes, {ShapeKind::hull, a}, {ShapeKind::hull, b},
                              meeting_pose(random, i, 0.8));
        expect_as_plain(pair, ask(pair, MethodStart::plain), ask(pair, MethodStart::cold));
        if (HasFatalFailure()) return;
    }
}

}  // namespace
}  // namespace throng
