// Stiff flight: slender bodies on springs by their ends keep their energy, however fast they turn.
#include "kernels/dynamics/stiff_flight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// 0.3 kg, 1 m: a needle, a slat or a cube as its moments have it, on a spring by its end to the
// origin.
struct Hung {
    Forces forces;
    Masses masses;
    Poses poses;
    Velocities velocities;
    Flights flights;
    double stiffness = 0;

    Hung(const Vec3& moments, double stiffness, const Vec3& velocity) : stiffness(stiffness)
    {
        masses.mass = {0.3};
        masses.inverse_mass = {1 / 0.3};
        masses.inertia = {{moments.x(), moments.y(), moments.z(), 0, 0, 0}};
        masses.inverse_inertia = {{1 / moments.x(), 1 / moments.y(), 1 / moments.z(), 0, 0, 0}};
        masses.gyroscopic_kind = {1};
        poses.position = {Vec3(0.8, 0.1, 0)};
        poses.orientation = {Quat(0.9, 0.3, 0.3, 0.1).normalized()};
        velocities.linear = {velocity};
        velocities.angular = {Vec3(0, 3, 1)};
        flights.memory.resize(1);
        forces.springs = {{0, kNoBody, Vec3(0, 0.01, 0.5), Vec3::Zero(), stiffness, 0, kLength}};
        forces.first_spring = {0, 1};
        forces.spring_of = {0};
    }
    double energy() const
    {
        const Vec3 spin = poses.orientation[0].conjugate() * velocities.angular[0];
        const double drawn = (poses.at(0) * Vec3(0, 0.01, 0.5)).norm() - kLength;
        return 0.5
            * (0.3 * velocities.linear[0].squaredNorm()
               + spin.dot(Vec3(masses.inertia[0].matrix() * spin)) + stiffness * drawn * drawn);
    }
    void step(double span)
    {
        RigidRule rule;
        const std::uint32_t body[] = {0};
        StiffFlight flight(rule, {forces, masses, poses, velocities}, body, flights);
        flight.carry(0, span);
        const RigidMotion::Outcome now = flight.law().outcome(0);
        poses.position[0] = now.position;
        poses.orientation[0] = now.orientation;
        velocities.linear[0] = now.linear;
        velocities.angular[0] = now.angular;
        flights.memory[0] = now.memory;
    }

    static constexpr double kLength = 0.5;
};

TEST(StiffFlight, KeepsTheEnergyOfWhatIsSymmetricHoweverFastItTurns)
{
    for (const Vec3& moments : {Vec3(0.026, 0.026, 1.5e-5), Vec3(0.026, 0.026, 0.05)})
        for (const double stiffness : {1e2, 1e4, 1e6})
            for (const double speed : {1.0, 230.0}) {
                Hung hung(moments, stiffness, Vec3(speed, 0.1 * speed, 0));
                const double first = hung.energy();
                for (int i = 0; i < 300; ++i) {
                    hung.step(1.0 / 240);
                    ASSERT_NEAR(hung.energy() / first, 1, 1e-6)
                        << moments.z() << ' ' << stiffness << ' ' << speed << " step " << i;
                }
            }
}

TEST(StiffFlight, GainsNothingToSpeakOfWhereNothingIsSymmetric)
{
    for (const double stiffness : {1e2, 1e4, 1e6}) {
        Hung hung(Vec3(0.026, 0.024, 0.002), stiffness, Vec3(40, 4, 0));
        const double first = hung.energy();
        double most = first, least = first;
        for (int i = 0; i < 500; ++i) {
            hung.step(1.0 / 240);
            most = std::max(most, hung.energy());
            least = std::min(least, hung.energy());
        }
        EXPECT_LT(most / first, 1.01) << stiffness;
        EXPECT_GT(least / first, 0.97) << stiffness;
    }
}

}  // namespace
}  // namespace throng
