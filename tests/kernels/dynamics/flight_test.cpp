// Flight: the wide kernel against the substeps as they are defined, one body at a time.
#include "kernels/dynamics/flight.hpp"

#include "kernels/dynamics/free_rotation.hpp"
#include "kernels/math/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace throng {
namespace {

struct Flyers {
    std::vector<Vec3> position, linear, angular;
    std::vector<Quat> orientation;
    std::vector<Sym3> inertia;
    std::vector<double> inverse_mass;
    std::vector<std::uint8_t> spins;

    FlightArrays arrays()
    {
        return {position[0].data(), orientation[0].coeffs().data(),
                linear[0].data(),   angular[0].data(),
                &inertia[0].xx,     inverse_mass.data(),
                spins.data()};
    }
    std::size_t size() const { return position.size(); }
    bool operator==(const Flyers& other) const
    {
        for (std::size_t i = 0; i < size(); ++i)
            if (orientation[i].coeffs() != other.orientation[i].coeffs()) return false;
        return position == other.position && linear == other.linear && angular == other.angular;
    }
};

Flyers random_flyers(std::size_t count, std::uint64_t seed, double fastest = 10)
{
    std::mt19937_64 random(seed);
    const auto number = [&](double most) {
        return most * (2 * static_cast<double>(random() >> 11) * 0x1p-53 - 1);
    };
    const auto vector = [&](double most) { return Vec3(number(most), number(most), number(most)); };
    Flyers made;
    for (std::size_t i = 0; i < count; ++i) {
        made.position.push_back(vector(100));
        made.linear.push_back(vector(10));
        made.angular.push_back(vector(fastest));
        made.orientation.push_back(
            Quat(number(1), number(1), number(1), number(1) + 1.5).normalized());
        const Vec3 half = Vec3(2, 2, 2) + vector(1);
        const Vec3 squares = half.cwiseAbs2();
        made.spins.push_back(static_cast<std::uint8_t>(random() % 4 == 0 ? 0 : 1));
        if (made.spins.back() == 0)
            made.inertia.push_back({1, 1, 1, 0, 0, 0});
        else
            made.inertia.push_back({squares.y() + squares.z(), squares.x() + squares.z(),
                                    squares.x() + squares.y(), 0, 0, 0});
        made.inverse_mass.push_back(random() % 8 == 0 ? 0 : 1);
    }
    return made;
}

using Precession = FlightRule::Precession;

FlightRule usual_rule(Precession precession = Precession::implicit)
{
    FlightRule rule;
    rule.substep = 1.0 / 240;
    rule.substeps = 4;
    rule.gravity[2] = -9.81;
    rule.turns = true;
    rule.precession = precession;
    return rule;
}

std::vector<std::uint32_t> all_of(const Flyers& flyers)
{
    std::vector<std::uint32_t> ids;
    for (std::uint32_t i = 0; i < flyers.size(); ++i) ids.push_back(i);
    return ids;
}

std::vector<std::uint32_t> fly(const char* width,
                               const FlightRule& rule,
                               const std::vector<std::uint32_t>& ids,
                               Flyers& flyers)
{
    std::vector<std::uint32_t> left(ids.size());
    const FlyKernel& kernel = *fly_kernel_of(width);
    left.resize(kernel(rule, flyers.arrays(), ids.data(), ids.size(), left.data()));
    return left;
}

// The substeps as they are told, in world axes.
void fly_plainly(const FlightRule& rule, Flyers& flyers, std::size_t i)
{
    const Vec3 gravity(rule.gravity[0], rule.gravity[1], rule.gravity[2]);
    for (int step = 0; step < rule.substeps; ++step) {
        if (flyers.inverse_mass[i] > 0) flyers.linear[i] += gravity * rule.substep;
        if (flyers.spins[i] != 0)
            flyers.angular[i] = after_gyroscopic_torque(flyers.angular[i], flyers.inertia[i],
                                                        flyers.orientation[i], rule.substep);
        flyers.position[i] += flyers.linear[i] * rule.substep;
        flyers.orientation[i] = turned(flyers.orientation[i], flyers.angular[i], rule.substep);
    }
}

// The parts as they are told, for a whole step.
void turn_plainly(const FlightRule& rule, Flyers& flyers, std::size_t i)
{
    const Sym3& inertia = flyers.inertia[i];
    const Vec3 moments(inertia.xx, inertia.yy, inertia.zz);
    Quat& pose = flyers.orientation[i];
    Vec3 momentum = moments.cwiseProduct(pose.conjugate() * flyers.angular[i]);
    turn_freely(free_rotation(moments), rule.substep * rule.substeps, rule.substeps, momentum,
                [&](const Vec3& turn) { pose = pose * exponential(turn); });
    pose.normalize();
    if (flyers.spins[i] != 0) flyers.angular[i] = pose * momentum.cwiseQuotient(moments);
}

TEST(Flight, TurnsInThePartsThatItTells)
{
    Flyers wide = random_flyers(1000, 1), plain = wide;
    const FlightRule rule = usual_rule(Precession::split);
    for (int step = 0; step < 20; ++step) {
        ASSERT_TRUE(fly("scalar", rule, all_of(wide), wide).empty());
        for (std::size_t i = 0; i < plain.size(); ++i) turn_plainly(rule, plain, i);
    }
    for (std::size_t i = 0; i < wide.size(); ++i) {
        EXPECT_LE((wide.angular[i] - plain.angular[i]).norm(), 1e-11) << i;
        EXPECT_LE((wide.orientation[i].coeffs() - plain.orientation[i].coeffs()).norm(), 1e-11);
        EXPECT_NEAR(wide.orientation[i].norm(), 1, 4e-16) << i;
    }
}

TEST(Flight, InPartsKeepsMomentumAndSwaysInEnergy)
{
    for (const double fastest : {0.1, 3.0, 10.0}) {
        Flyers flyers = random_flyers(300, 6, fastest);
        const auto momentum = [&](std::size_t i) {
            const Quat& pose = flyers.orientation[i];
            return Vec3(
                pose * Vec3(flyers.inertia[i].matrix() * (pose.conjugate() * flyers.angular[i])));
        };
        const auto energy = [&](std::size_t i) { return momentum(i).dot(flyers.angular[i]); };
        std::vector<double> had;
        std::vector<Vec3> went;
        for (std::size_t i = 0; i < flyers.size(); ++i) {
            had.push_back(energy(i));
            went.push_back(momentum(i));
        }
        for (int step = 0; step < 500; ++step) {
            fly("scalar", usual_rule(Precession::split), all_of(flyers), flyers);
            if (step % 50 != 49) continue;
            for (std::size_t i = 0; i < flyers.size(); ++i) {
                EXPECT_LE((momentum(i) - went[i]).norm(), 1e-12 * went[i].norm()) << i;
                EXPECT_NEAR(energy(i) / had[i], 1, 1e-3) << i;
            }
        }
    }
}

TEST(Flight, AgreesWithTheSubstepsOneByOne)
{
    Flyers wide = random_flyers(1000, 1), plain = wide;
    const FlightRule rule = usual_rule();
    for (int step = 0; step < 20; ++step) {
        ASSERT_TRUE(fly("scalar", rule, all_of(wide), wide).empty());
        for (std::size_t i = 0; i < plain.size(); ++i) fly_plainly(rule, plain, i);
    }
    for (std::size_t i = 0; i < wide.size(); ++i) {
        EXPECT_LE((wide.position[i] - plain.position[i]).norm(), 1e-12) << i;
        EXPECT_LE((wide.linear[i] - plain.linear[i]).norm(), 1e-12) << i;
        EXPECT_LE((wide.angular[i] - plain.angular[i]).norm(), 1e-11) << i;
        EXPECT_LE((wide.orientation[i].coeffs() - plain.orientation[i].coeffs()).norm(), 1e-11);
        EXPECT_NEAR(wide.orientation[i].norm(), 1, 4e-16) << i;
    }
}

TEST(Flight, IsTheSameBitsAtEveryWidthWhoeverFliesAlongside)
{
    for (const Precession precession : {Precession::implicit, Precession::split}) {
        const Flyers before = random_flyers(203, 2);
        const FlightRule rule = usual_rule(precession);
        Flyers alone = before;
        for (std::uint32_t i = 0; i < alone.size(); i += i % 7 == 3 ? 2 : 1)
            ASSERT_TRUE(fly("scalar", rule, {i}, alone).empty());
        std::vector<std::uint32_t> separations;
        for (std::uint32_t i = 0; i < before.size(); i += i % 7 == 3 ? 2 : 1)
            separations.push_back(i);
        for (const char* width : {"scalar", "avx2", "avx512"}) {
            if (fly_kernel_of(width) == nullptr) continue;
            for (std::size_t count = 0; count < 20; ++count) {
                Flyers some = before, one_by_one = before;
                const std::vector<std::uint32_t> ids(
                    separations.begin(), separations.begin() + static_cast<std::ptrdiff_t>(count));
                fly(width, rule, ids, some);
                for (const std::uint32_t id : ids) fly("scalar", rule, {id}, one_by_one);
                ASSERT_EQ(some, one_by_one) << width << ", " << count;
            }
            Flyers together = before;
            fly(width, rule, separations, together);
            EXPECT_EQ(together, alone) << width;
        }
    }
}

TEST(Flight, LeavesToOthersWhatItCannotDoAndDoesTheRest)
{
    const Flyers before = random_flyers(64, 3);
    for (const char* width : {"scalar", "avx2", "avx512"}) {
        if (fly_kernel_of(width) == nullptr) continue;
        Flyers flyers = before;
        flyers.angular[3] = Vec3(0, 400, 0);    // beyond the series
        flyers.linear[17] = Vec3(1e300, 0, 0);  // beyond a step
        flyers.angular[20] = Vec3(NAN, 0, 0);   // not a number
        flyers.spins[41] = 2;                   // axes that are not principal ones
        const Flyers stated = flyers;
        const auto left = fly(width, usual_rule(), all_of(flyers), flyers);
        for (const std::uint32_t id : {3u, 17u, 20u, 41u})
            EXPECT_NE(std::find(left.begin(), left.end(), id), left.end()) << id;
        for (const std::uint32_t id : left) {
            EXPECT_EQ(flyers.position[id], stated.position[id]) << id;
            EXPECT_EQ(flyers.linear[id], stated.linear[id]) << id;
            EXPECT_EQ(flyers.orientation[id].coeffs(), stated.orientation[id].coeffs()) << id;
        }
        EXPECT_EQ(left.size(), 4u);
        EXPECT_NE(flyers.position[4], stated.position[4]);
    }
}

TEST(Flight, AnEvenSpinKeepsItsVelocityToTheLastBit)
{
    const Flyers before = random_flyers(100, 4);
    Flyers by_steps = before, in_parts = before;
    for (int step = 0; step < 100; ++step) {
        fly("scalar", usual_rule(), all_of(by_steps), by_steps);
        fly("scalar", usual_rule(Precession::split), all_of(in_parts), in_parts);
    }
    for (std::size_t i = 0; i < before.size(); ++i)
        if (before.spins[i] == 0) {
            EXPECT_EQ(by_steps.angular[i], before.angular[i]);
            EXPECT_EQ(in_parts.angular[i], before.angular[i]);
            EXPECT_EQ(in_parts.orientation[i].coeffs(), by_steps.orientation[i].coeffs());
        }
}

TEST(Flight, NeverGainsEnergy)
{
    for (const double fastest : {0.1, 3.0, 30.0}) {
        Flyers flyers = random_flyers(500, 5, fastest);
        const auto energy = [&](std::size_t i) {
            const Vec3 w = flyers.orientation[i].conjugate() * flyers.angular[i];
            return w.dot(flyers.inertia[i].matrix() * w);
        };
        std::vector<double> before;
        for (std::size_t i = 0; i < flyers.size(); ++i) before.push_back(energy(i));
        for (int step = 0; step < 200; ++step) fly("scalar", usual_rule(), all_of(flyers), flyers);
        for (std::size_t i = 0; i < flyers.size(); ++i)
            EXPECT_LE(energy(i), before[i] * (1 + 1e-11)) << i;
    }
}

}  // namespace
}  // namespace throng
