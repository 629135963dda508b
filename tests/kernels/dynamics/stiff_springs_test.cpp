// Stiff springs: the implicit midpoint rule, by its laws.
#include "kernels/dynamics/stiff_springs.hpp"

#include "kernels/math/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace throng {
namespace {

constexpr double kStep = 1.0 / 240;

// Bodies and springs that go by nothing else.
struct Sprung {
    Forces forces;
    Masses masses;
    Poses poses;
    Velocities velocities;
    std::vector<std::uint32_t> ids;
    std::size_t lost = 0;  // steps that could not be followed

    void add(double mass, const Vec3& position, const Vec3& velocity, const Vec3& spin)
    {
        ids.push_back(static_cast<std::uint32_t>(ids.size()));
        const double moment = mass / 600;
        masses.mass.push_back(mass);
        masses.inverse_mass.push_back(1 / mass);
        masses.inertia.push_back({moment, moment, moment, 0, 0, 0});
        masses.inverse_inertia.push_back({1 / moment, 1 / moment, 1 / moment, 0, 0, 0});
        poses.position.push_back(position);
        poses.orientation.push_back(Quat::Identity());
        velocities.linear.push_back(velocity);
        velocities.angular.push_back(spin);
    }
    void tie()
    {
        forces.first_spring.assign(1, 0);
        forces.spring_of.clear();
        for (const std::uint32_t body : ids) {
            for (std::uint32_t i = 0; i < forces.springs.size(); ++i)
                if (forces.springs[i].a == body || forces.springs[i].b == body)
                    forces.spring_of.push_back(i);
            forces.first_spring.push_back(static_cast<std::uint32_t>(forces.spring_of.size()));
        }
    }
    double energy() const
    {
        double sum = 0;
        for (const std::uint32_t i : ids)
            sum += 0.5
                * (masses.mass[i] * velocities.linear[i].squaredNorm()
                   + masses.inertia[i].xx * velocities.angular[i].squaredNorm());
        const auto end = [&](std::uint32_t body, const Vec3& at) {
            return body == kNoBody ? at : Vec3(poses.at(body) * at);
        };
        for (const SpringForce& spring : forces.springs) {
            const double drawn =
                (end(spring.b, spring.at_b) - end(spring.a, spring.at_a)).norm() - spring.length;
            sum += 0.5 * spring.stiffness * drawn * drawn;
        }
        return sum;
    }
    Vec3 momentum() const
    {
        Vec3 sum = Vec3::Zero();
        for (const std::uint32_t i : ids) sum += masses.mass[i] * velocities.linear[i];
        return sum;
    }
    void give(std::span<const StiffSprings::Six> change)
    {
        for (const std::uint32_t i : ids) {
            velocities.linear[i] += change[i].linear;
            velocities.angular[i] += change[i].angular;
        }
    }
    void step()
    {
        StiffSprings springs(forces, masses, poses, velocities, ids);
        for (const std::uint32_t i : ids) {
            SpringBody& body = springs.bodies()[i];
            body.position = poses.position[i];
            body.turn = poses.orientation[i].toRotationMatrix();
            body.velocity = velocities.linear[i];
            body.spin = velocities.angular[i];
            body.inverse_inertia = masses.inverse_inertia[i].matrix();
        }
        give(springs.begin(0, kStep));
        lost += springs.found() ? 0 : 1;
        for (const std::uint32_t i : ids) {
            poses.position[i] += kStep * velocities.linear[i];
            poses.orientation[i] =
                exponential(kStep * velocities.angular[i]) * poses.orientation[i];
        }
        for (const std::uint32_t i : ids) {
            springs.bodies()[i].velocity = velocities.linear[i];
            springs.bodies()[i].spin = velocities.angular[i];
        }
        give(springs.end());
    }
};

// A chain that hangs on the world or on nothing, by springs off its bodies' centers.
Sprung chain(int count, double stiffness, double arm, double heavy, bool has_pivot)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> side(-1, 1);
    const auto any = [&] {
        const double x = side(random), y = side(random);
        return Vec3(x, y, side(random));
    };
    Sprung all;
    for (int i = 0; i < count; ++i) {
        const Vec3 off = 0.1 * any(), velocity = any();
        all.add(i % 2 == 0 ? 1 : heavy, Vec3(0.3 * i, off.y(), off.z()), velocity, any());
        const auto id = static_cast<std::uint32_t>(i);
        SpringForce spring{id, i > 0 ? id - 1 : kNoBody, arm * any(), arm * any(), stiffness, 0,
                           0.3};
        if (i == 0) spring.at_b = Vec3(-0.3, 0, 0);
        if (i > 0 || has_pivot) all.forces.springs.push_back(spring);
    }
    all.tie();
    return all;
}

TEST(StiffSprings, AlongALineKeepEnergyAtAnyStiffness)
{
    for (const double stiffness : {1e2, 1e4, 1e6, 1e8, 1e10}) {
        Sprung one;
        one.add(1, Vec3(0.1, 0, 0), Vec3::Zero(), Vec3::Zero());
        one.forces.springs.push_back({0, kNoBody, Vec3::Zero(), Vec3(-1, 0, 0), stiffness, 0, 1});
        one.tie();
        const double first = one.energy();
        double widest = 0;
        for (int i = 0; i < 2000; ++i) {
            one.step();
            widest = std::max(widest, std::abs(one.poses.position[0].x()));
            ASSERT_NEAR(one.energy() / first, 1, 1e-6) << stiffness << " N/m, step " << i;
        }
        EXPECT_LT(widest, 0.1 * (1 + 1e-6));
        EXPECT_EQ(one.lost, 0u);
    }
}

TEST(StiffSprings, ThatTurnTheirBodiesKeepEnergyToo)
{
    for (const double stiffness : {1e3, 1e4, 3e4}) {
        Sprung all = chain(5, stiffness, 0.03, 3, true);
        const double first = all.energy();
        for (int i = 0; i < 1000; ++i) {
            all.step();
            ASSERT_NEAR(all.energy() / first, 1, 1e-5) << stiffness << " N/m, step " << i;
        }
        EXPECT_EQ(all.lost, 0u);
    }
}

TEST(StiffSprings, KeepMomentumAndNeverGain)
{
    for (const double stiffness : {1e4, 1e6, 1e8})
        for (const double heavy : {1.0, 1000.0}) {
            Sprung all = chain(5, stiffness, 0.05, heavy, false);
            const Vec3 momentum = all.momentum();
            const double first = all.energy();
            for (int i = 0; i < 150; ++i) {
                all.step();
                ASSERT_LT(all.energy(), first * (1 + 1e-5)) << stiffness << " N/m, step " << i;
            }
            EXPECT_LT((all.momentum() - momentum).norm(), 1e-9 * (1 + momentum.norm()));
        }
}

// However much they are damped, in any step.
TEST(StiffSprings, DampedOnesNeverGain)
{
    for (const double stiffness : {1e2, 1e4, 1e6, 1e8})
        for (const double ratio : {0.05, 1.0, 20.0}) {
            Sprung one;
            one.add(1, Vec3(0.1, 0, 0), Vec3::Zero(), Vec3::Zero());
            one.forces.springs.push_back({0, kNoBody, Vec3(0, 0.03, 0), Vec3(-1, 0, 0), stiffness,
                                          2 * ratio * std::sqrt(stiffness), 1});
            one.tie();
            const double first = one.energy();
            for (int i = 0; i < 200; ++i) {
                const double before = one.energy();
                one.step();
                ASSERT_LE(one.energy(), before + 1e-9 * first)
                    << stiffness << " N/m, " << ratio << ", step " << i;
            }
            EXPECT_LT(one.energy(), 0.95 * first) << stiffness << " N/m, " << ratio;
        }
}

// What a damper takes before bodies move turns a velocity that the spring was to work along.
TEST(StiffSprings, DampedOnesOnWhatIsThrownNeverGain)
{
    for (const double stiffness : {1e4, 1e5, 1e6})
        for (const double ratio : {0.05, 0.3, 1.0})
            for (const double speed : {30.0, 100.0, 200.0}) {
                Sprung one;
                one.add(1, Vec3(0.7, 0, 0), speed * Vec3(0.8, 0.5, 0.2), Vec3(0, 3, 1));
                one.forces.springs.push_back({0, kNoBody, Vec3(0, 0.03, 0), Vec3::Zero(), stiffness,
                                              2 * ratio * std::sqrt(stiffness), 0.5});
                one.tie();
                const double first = one.energy();
                for (int i = 0; i < 100; ++i) {
                    const double before = one.energy();
                    one.step();
                    ASSERT_LE(one.energy(), before + 1e-6 * first)
                        << stiffness << " N/m, " << ratio << ", " << speed << ", step " << i;
                }
            }
}

TEST(StiffSprings, DampersSlowAndTurnNothingRound)
{
    for (const double damping : {1.0, 1e3, 1e6, 1e9}) {
        Sprung one;
        one.add(1, Vec3(0.1, 0, 0), Vec3(2, 0, 0), Vec3::Zero());
        one.forces.springs.push_back({0, kNoBody, Vec3::Zero(), Vec3(-1, 0, 0), 0, damping, 1});
        one.tie();
        for (int i = 0; i < 100; ++i) {
            const double before = one.velocities.linear[0].x();
            one.step();
            EXPECT_GE(one.velocities.linear[0].x(), -1e-9) << damping;
            EXPECT_LE(one.velocities.linear[0].x(), before + 1e-9) << damping;
        }
    }
}

}  // namespace
}  // namespace throng
