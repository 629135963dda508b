// Stages: each called with a few arrays, no world needed.
#include "pipeline/step/stages.hpp"

#include "pipeline/contacts/wake_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

// Some dynamic bodies of unit mass and one ball each, awake, in a row along x.
struct Bodies {
    StepContext context;
    ImpactParameters impact;
    SleepParameters sleep;
    Poses poses;
    Velocities velocities;
    Masses masses;
    BodyStates states;
    Shapes shapes;
    Colliders colliders;
    PairFilter filter;
    Bounds bounds;

    explicit Bodies(std::uint32_t count, double apart = 1.0)
    {
        impact.set({});
        sleep.set({});
        context.effects = {Effect::motion, Effect::gravity, Effect::contact};
        shapes.spheres.push_back({0.5});
        for (std::uint32_t i = 0; i < count; ++i) {
            poses.position.emplace_back(apart * i, 0, 0);
            poses.orientation.push_back(Quat::Identity());
            velocities.linear.emplace_back(Vec3::Zero());
            velocities.angular.emplace_back(Vec3::Zero());
            masses.mass.push_back(1);
            masses.inverse_mass.push_back(1);
            masses.inertia.push_back({1, 1, 1, 0, 0, 0});
            masses.inverse_inertia.push_back({1, 1, 1, 0, 0, 0});
            masses.gyroscopic_kind.push_back(0);
            states.kind.push_back(BodyKind::dynamic);
            states.awake.push_back(1);
            states.quarantined.push_back(0);
            states.sleep_time.push_back(0);
            states.sleeping_island.push_back(kNoBody);
            states.radius.push_back(0.5);
            states.active_bodies.dynamic.push_back(i);
            colliders.body.push_back(i);
            colliders.shape.push_back({ShapeKind::sphere, 0});
            colliders.local.emplace_back();
            colliders.material.push_back(0);
            colliders.inner_extent.push_back(0.5);
            colliders.outer_radius.push_back(0.5);
            colliders.begin.push_back(i);
            colliders.count.push_back(1);
            filter.add(i);
            bounds.touched.push_back(i);
        }
    }
    void update()
    {
        update_bounds(context, impact, shapes, colliders, poses, velocities, states, bounds);
    }
};

TEST(UpdateBounds, AsksAboutWhatLeftItsMarginAlone)
{
    Bodies b(4, 10);
    b.update();
    EXPECT_EQ(b.bounds.asked, (std::vector<std::uint32_t>{0, 1, 2, 3}));
    b.update();
    EXPECT_TRUE(b.bounds.asked.empty());
    b.poses.position[2].x() += 100;
    b.poses.position[1].x() += 1e-4;
    b.update();
    EXPECT_EQ(b.bounds.asked, (std::vector<std::uint32_t>{2}));
}

TEST(UpdateBounds, WhoComesToRestGetsATighterBoxOnce)
{
    Bodies b(2, 10);
    for (Vec3& velocity : b.velocities.linear) velocity = Vec3(0, 0, -10);
    b.colliders.local[1].position = Vec3(0.1, 0, 0);  // goes the long way
    b.update();
    const double deep = b.bounds.boxes[0].lower.z();
    for (Vec3& velocity : b.velocities.linear) velocity.setZero();
    b.update();
    EXPECT_EQ(b.bounds.asked, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_GT(b.bounds.boxes[0].lower.z(), deep + 0.4);
    b.update();
    EXPECT_TRUE(b.bounds.asked.empty());
}

TEST(UpdateBounds, ABoxHoldsAllThatTheBodyMayReachInTheStep)
{
    Bodies b(1);
    b.velocities.linear[0] = Vec3(30, -60, 0);
    b.update();
    const double dt = b.context.dt;
    const Box3 there{Vec3(30 * dt - 0.5, -60 * dt - 0.5, -0.5),
                     Vec3(30 * dt + 0.5, -60 * dt + 0.5, 0.5)};
    EXPECT_TRUE(b.bounds.boxes[0].contains(there));
    EXPECT_GE(b.bounds.speculative_margin[0], b.velocities.linear[0].norm() * dt);
}

TEST(UpdateBounds, SleepersCostNothingAndRemovedOnesHaveNoBox)
{
    Bodies b(2, 10);
    b.update();
    b.states.awake[0] = 0;
    b.poses.position[0].x() += 50;  // it would be seen if it were looked at
    b.colliders.body[1] = kNoBody;
    b.bounds.touched = {1};
    b.update();
    EXPECT_EQ(b.bounds.asked, (std::vector<std::uint32_t>{1}));
    EXPECT_TRUE(b.bounds.boxes[1].empty());
}

TEST(UpdateBounds, NearHoldsTheTightBoxAndTheReachHoweverFarOut)
{
    Bodies b(4, 10);
    b.poses.position[1] = Vec3(1e7, -1e7, 0.1);
    b.poses.position[2] = Vec3(-1e-7, 1e12, 3);
    b.velocities.linear[3] = Vec3(40, 0, 0);
    b.update();
    for (std::size_t i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) {
            const double speculative_margin = 0.5 + b.bounds.speculative_margin[i],
                         at = b.poses.position[i][k];
            EXPECT_LE(double{b.bounds.near[i].lower[k]}, at - speculative_margin);
            EXPECT_GE(double{b.bounds.near[i].upper[k]}, at + speculative_margin);
            const double rounding = 1e-6 * (std::abs(at) + 1);
            EXPECT_NEAR(double{b.bounds.near[i].lower[k]}, at - speculative_margin, rounding);
            EXPECT_NEAR(double{b.bounds.near[i].upper[k]}, at + speculative_margin, rounding);
        }
    EXPECT_TRUE(b.bounds.near[0].overlaps(b.bounds.near[0]));
    EXPECT_FALSE(b.bounds.near[0].overlaps(b.bounds.near[1]));
    b.colliders.body[0] = kNoBody;
    b.bounds.touched = {0};
    b.update();
    EXPECT_FALSE(b.bounds.near[0].overlaps(b.bounds.near[0]));
}

TEST(FindPairs, PairsLiveOnUntilTheirBoxesPart)
{
    Bodies b(3, 0.9);
    Finder finder;
    finder.finder = make_finder(FinderKind::all_pairs);
    Pairs pairs;
    b.update();
    find_pairs(b.bounds, b.shapes, b.colliders, b.filter, finder, pairs);
    EXPECT_EQ(pairs.keys, (std::vector<PairKey>{pair_key(0, 1), pair_key(1, 2)}));
    EXPECT_TRUE(pairs.changed);
    EXPECT_EQ(pairs.from, (std::vector<std::uint32_t>{Pairs::kNewPair, Pairs::kNewPair}));
    b.update();
    find_pairs(b.bounds, b.shapes, b.colliders, b.filter, finder, pairs);
    EXPECT_FALSE(pairs.changed);
    b.poses.position[0].x() -= 5;
    b.update();
    find_pairs(b.bounds, b.shapes, b.colliders, b.filter, finder, pairs);
    EXPECT_EQ(pairs.keys, (std::vector<PairKey>{pair_key(1, 2)}));
    EXPECT_EQ(pairs.from, (std::vector<std::uint32_t>{1}));
}

TEST(FindPairs, APlaneMeetsOnlyWhatComesDownToIt)
{
    Bodies b(3, 5);
    b.shapes.planes.push_back({Vec3::UnitX(), 6});
    b.colliders.shape[0] = {ShapeKind::plane, 0};
    b.states.kind[0] = BodyKind::static_;
    b.states.awake[0] = 0;
    Finder finder;
    finder.finder = make_finder(FinderKind::all_pairs);
    Pairs pairs;
    b.update();
    find_pairs(b.bounds, b.shapes, b.colliders, b.filter, finder, pairs);
    EXPECT_EQ(pairs.keys, (std::vector<PairKey>{pair_key(0, 1)}));
}

TEST(IntegratePoses, MovesTheLoneAndLeavesTheOthersToTheSolver)
{
    Bodies b(3);
    b.velocities.linear.assign(3, Vec3(1, 0, 0));
    b.states.awake[2] = 0;
    Islands islands;
    islands.lone = {1, 2};
    StepDiagnostics diagnostics;
    Flights flights;
    integrate_poses(b.context, islands, b.masses, b.states, {}, flights, b.poses, b.velocities,
                    diagnostics);
    EXPECT_EQ(b.poses.position[0], Vec3(0, 0, 0));
    EXPECT_NEAR(b.poses.position[1].x(), 1 + 1.0 / 60, 1e-15);
    EXPECT_LT(b.poses.position[1].z(), 0);
    EXPECT_EQ(b.poses.position[2], Vec3(2, 0, 0));
    EXPECT_TRUE(diagnostics.quarantined.empty());
}

TEST(IntegratePoses, LeavesWhatAStepCannotHoldWhereItWasAndReportsIt)
{
    Bodies b(2);
    b.velocities.linear[1] = Vec3(1e300, 0, 0);
    Islands islands;
    islands.lone = {0, 1};
    StepDiagnostics diagnostics;
    Flights flights;
    integrate_poses(b.context, islands, b.masses, b.states, {}, flights, b.poses, b.velocities,
                    diagnostics);
    EXPECT_EQ(diagnostics.quarantined, (std::vector<std::uint32_t>{1}));
    EXPECT_EQ(b.poses.position[1], Vec3(1, 0, 0));
    quarantine_bodies(diagnostics, b.states, b.masses, b.velocities);
    EXPECT_EQ(b.states.kind[1], BodyKind::static_);
    EXPECT_EQ(b.velocities.linear[1], Vec3(Vec3::Zero()));
    EXPECT_EQ(b.states.quarantined[1], 1);
    EXPECT_EQ(b.states.quarantined[0], 0);
}

TEST(SleepIslands, PutsAnIslandToBedOnceAllOfItIsQuiet)
{
    Bodies b(4);
    Islands islands;
    islands.body_begin = {0, 2, 4};
    islands.bodies = {0, 1, 2, 3};
    islands.contact_begin = {0, 0, 0};
    SleepingIslands sleeping_islands;
    SleepEvents sleep_events;
    b.velocities.linear[3] = Vec3(0.1, 0, 0);  // keeps its whole island up
    b.velocities.linear[0] = Vec3(0.01, 0, 0);
    int steps = 0;
    while (b.states.awake[0] != 0 && ++steps < 100)
        sleep_islands(b.context, b.sleep, {}, {}, islands, {}, b.states, sleeping_islands,
                      b.velocities, sleep_events);
    EXPECT_NEAR(steps, 30, 1);
    EXPECT_EQ(sleep_events.fell_asleep, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(b.states.sleeping_island[0], b.states.sleeping_island[1]);
    EXPECT_NE(b.states.sleeping_island[0], kNoBody);
    EXPECT_EQ(b.velocities.linear[0], Vec3(Vec3::Zero()));
    EXPECT_EQ(b.states.awake[2], 1);
}

TEST(WakeIslands, WakesTheWholeBedOfWhoeverIsTouched)
{
    Bodies b(4, 0.9);
    SleepingIslands sleeping_islands;
    sleeping_islands.bodies = {{1, 3}};
    for (const std::uint32_t body : {1u, 3u}) {
        b.states.awake[body] = 0;
        b.states.sleeping_island[body] = 0;
    }
    StepData<float> step;
    auto& pairs = std::get<Pairs>(step);
    pairs.keys = {pair_key(0, 1), pair_key(2, 3)};
    auto& contacts = std::get<ConvexContacts<float>>(step);
    contacts.of_pair.resize(2);
    SleepEvents sleep_events;
    wake_islands(b.colliders, b.velocities, pair_data(step), sleeping_islands, b.states,
                 sleep_events);
    EXPECT_TRUE(sleep_events.woke.empty());
    contacts.contacts.resize(1);
    contacts.of_pair[0].contact = 0;
    wake_islands(b.colliders, b.velocities, pair_data(step), sleeping_islands, b.states,
                 sleep_events);
    EXPECT_EQ(sleep_events.woke, (std::vector<std::uint32_t>{1, 3}));
    EXPECT_EQ(b.states.awake[3], 1);
    EXPECT_EQ(sleeping_islands.free, (std::vector<std::uint32_t>{0}));
}

TEST(WakeIslands, SolidsWakeWhomTheyTouchAndNobodyNear)
{
    Bodies b(2, 0.9);
    b.states.awake[1] = 0;
    b.states.sleeping_island[1] = 0;
    SleepingIslands sleeping_islands;
    sleeping_islands.bodies = {{1}};
    StepData<float> step;
    auto& pairs = std::get<Pairs>(step);
    pairs.keys = {pair_key(0, 1)};
    pairs.on_solid = {0};
    auto& contacts = std::get<ConvexContacts<float>>(step);
    contacts.of_pair.resize(1);
    auto& solids = std::get<SolidContacts<float>>(step);
    solids.entries.resize(1);
    SleepEvents sleep_events;
    wake_islands(b.colliders, b.velocities, pair_data(step), sleeping_islands, b.states,
                 sleep_events);
    EXPECT_TRUE(sleep_events.woke.empty()) << "a contact without points";
    solids.entries[0].contact.count = 1;
    wake_islands(b.colliders, b.velocities, pair_data(step), sleeping_islands, b.states,
                 sleep_events);
    EXPECT_EQ(sleep_events.woke, (std::vector<std::uint32_t>{1}));
}

TEST(WakeIslands, WhatMovesByItselfWakesOnlyWhileItMoves)
{
    Bodies b(2, 0.9);
    b.states.kind[0] = BodyKind::kinematic;
    b.states.awake[1] = 0;
    b.states.sleeping_island[1] = 0;
    SleepingIslands sleeping_islands;
    sleeping_islands.bodies = {{1}};
    StepData<double> step;
    auto& pairs = std::get<Pairs>(step);
    pairs.keys = {pair_key(0, 1)};
    auto& contacts = std::get<ConvexContacts<double>>(step);
    contacts.contacts.resize(1);
    contacts.of_pair.push_back({{}, 0});
    SleepEvents sleep_events;
    wake_islands(b.colliders, b.velocities, pair_data(step), sleeping_islands, b.states,
                 sleep_events);
    EXPECT_TRUE(sleep_events.woke.empty());
    b.velocities.angular[0] = Vec3(0, 0, 1);
    wake_islands(b.colliders, b.velocities, pair_data(step), sleeping_islands, b.states,
                 sleep_events);
    EXPECT_EQ(sleep_events.woke, (std::vector<std::uint32_t>{1}));
}

}  // namespace
}  // namespace throng
