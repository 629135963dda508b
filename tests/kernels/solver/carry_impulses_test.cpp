// Carry impulses: what a contact takes over from the one that its pair had before.
#include "kernels/solver/contact_packing.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace throng {
namespace {

// A contact of features 1, 2, ... each with its feature as impulse.
Contact<double> numbered(std::initializer_list<std::uint32_t> features)
{
    Contact<double> contact;
    for (const std::uint32_t feature : features) {
        auto& point = contact.points[static_cast<std::size_t>(contact.count++)];
        point.feature = feature;
        point.impulse = feature;
    }
    contact.friction = Vec3(0.5, 0, 0);
    contact.torsional_impulse = 0.25;
    contact.rolling = Vec3(0, 0.125, 0);
    return contact;
}

Contact<double> fresh(std::initializer_list<std::uint32_t> features)
{
    Contact<double> contact = numbered(features);
    for (auto& point : contact.points) point.impulse = 0;
    contact.friction.setZero();
    contact.rolling.setZero();
    contact.torsional_impulse = 0;
    return contact;
}

TEST(CarryImpulses, GoesByFeatureWhateverTheOrder)
{
    Contact<double> contact = fresh({3, 2, 1});
    carry_impulses<double>(numbered({1, 2, 3}), 1.0, contact);
    EXPECT_EQ(contact.points[0].impulse, 3);
    EXPECT_EQ(contact.points[1].impulse, 2);
    EXPECT_EQ(contact.points[2].impulse, 1);
    EXPECT_EQ(contact.friction, Vec3(0.5, 0, 0));
    EXPECT_EQ(contact.torsional_impulse, 0.25);
    EXPECT_EQ(contact.rolling, Vec3(0, 0.125, 0));
}

TEST(CarryImpulses, GivesEachImpulseOnce)
{
    Contact<double> contact = fresh({5, 5});
    carry_impulses<double>(numbered({5}), 1.0, contact);
    EXPECT_EQ(contact.points[0].impulse, 5);
    EXPECT_EQ(contact.points[1].impulse, 0);
}

TEST(CarryImpulses, ScalesWithTheSubstep)
{
    Contact<double> contact = fresh({2, 4});
    carry_impulses<double>(numbered({2, 4}), 0.5, contact);
    EXPECT_EQ(contact.points[0].impulse, 1);
    EXPECT_EQ(contact.points[1].impulse, 2);
    EXPECT_EQ(contact.friction, Vec3(0.25, 0, 0));
    EXPECT_EQ(contact.torsional_impulse, 0.125);
}

TEST(CarryImpulses, TurnsFrictionIntoTheNewPlane)
{
    Contact<double> contact = fresh({1, 2});
    contact.normal = Vec3(1, 0, 1).normalized();
    Contact<double> before = numbered({1, 2});
    before.friction = Vec3(1, 1, 0);
    carry_impulses<double>(before, 1.0, contact);
    EXPECT_LE((contact.friction - Vec3(0.5, 1, -0.5)).norm(), 1e-15);
}

// A clipped corner may change its name as bodies move by a hair: what it bore is borne on.
TEST(CarryImpulses, WhatIsGoneIsBorneByTheNearestThatIsNew)
{
    Contact<double> before = numbered({1, 2, 3});
    for (std::size_t k = 0; k < 3; ++k) before.points[k].anchor_a = Vec3(double(k), 0, 0);
    Contact<double> contact = fresh({2, 8, 9});
    contact.points[0].anchor_a = Vec3(1, 0, 0);
    contact.points[1].anchor_a = Vec3(2.1, 0, 0);
    contact.points[2].anchor_a = Vec3(-0.2, 0, 0);
    carry_impulses<double>(before, 1.0, contact);
    EXPECT_EQ(contact.points[0].impulse, 2);
    EXPECT_EQ(contact.points[1].impulse, 3);
    EXPECT_EQ(contact.points[2].impulse, 1);
    EXPECT_EQ(contact.friction, Vec3(0.5, 0, 0));
}

TEST(CarryImpulses, NothingIsBorneOnByAnotherFace)
{
    Contact<double> contact = fresh({7, 8});
    contact.normal = Vec3::UnitX();
    carry_impulses<double>(numbered({1, 2}), 1.0, contact);
    EXPECT_EQ(contact.points[0].impulse, 0);
    EXPECT_EQ(contact.points[1].impulse, 0);
}

TEST(CarryImpulses, WithoutNormalImpulsesThereIsNoFriction)
{
    Contact<double> contact = fresh({7, 8});
    Contact<double> before = numbered({1, 2});
    for (auto& point : before.points) point.impulse = 0;
    carry_impulses<double>(before, 1.0, contact);
    EXPECT_EQ(contact.friction, Vec3(Vec3::Zero()));
    EXPECT_EQ(contact.torsional_impulse, 0);
    EXPECT_EQ(contact.rolling, Vec3(Vec3::Zero()));
}

TEST(CarryImpulses, ASinglePointTakesNoTorsion)
{
    // Nothing would ever let go of it again: blocks of single points hold no twist.
    Contact<double> contact = fresh({1});
    carry_impulses<double>(numbered({1, 2, 3}), 1.0, contact);
    EXPECT_EQ(contact.points[0].impulse, 1);
    EXPECT_EQ(contact.torsional_impulse, 0);
}

}  // namespace
}  // namespace throng
