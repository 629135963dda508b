// Direct points: what impulses there do, and that friction of an impact takes energy and never
// gives any.
#include "kernels/solver/direct/direct_points.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace throng {
namespace {

class DirectPoints : public testing::Test {
protected:
    Vec3 vector(double size)
    {
        std::normal_distribution<double> normal(0, size);
        const double x = normal(random_), y = normal(random_), z = normal(random_);
        return {x, y, z};
    }
    DirectBody body()
    {
        std::uniform_real_distribution<double> share(0.1, 10);
        DirectBody made;
        made.inverse_mass = share(random_);
        made.inverse_inertia = {share(random_), share(random_), share(random_), 0, 0, 0};
        made.velocity = vector(3);
        made.spin = vector(5);
        return made;
    }
    DirectPoint point()
    {
        DirectPoint made;
        made.a = 0, made.b = 1;
        made.normal = vector(1).normalized();
        made.arm_a = vector(1);
        made.arm_b = vector(1);
        made.friction = 0.7;
        made.rolling = 0.1;
        return made;
    }
    static double energy(const std::vector<DirectBody>& bodies)
    {
        double sum = 0;
        for (const DirectBody& body : bodies) {
            const Mat3 inertia = body.inverse_inertia.matrix().inverse();
            sum += 0.5 * body.velocity.squaredNorm() / body.inverse_mass
                + 0.5 * body.spin.dot(Vec3(inertia * body.spin));
        }
        return sum;
    }

    std::mt19937 random_{11};
};

TEST_F(DirectPoints, WorkOfImpulsesIsWhatTheyChangeTheEnergyBy)
{
    for (int i = 0; i < 100; ++i) {
        std::vector<DirectBody> bodies = {body(), body()};
        const std::vector<DirectBody> before = bodies;
        std::vector<DirectPoint> points = {point(), point()};
        for (DirectPoint& at : points) {
            at.impulse = vector(1);
            at.torque = vector(0.1);
            apply_impulse(at, at.impulse, bodies);
            apply_torque(at, at.torque, bodies);
        }
        EXPECT_NEAR(work_of(points, before, bodies), energy(bodies) - energy(before),
                    1e-9 * energy(before));
    }
}

TEST_F(DirectPoints, FrictionOfAnImpactTakesEnergyWithinItsCone)
{
    for (int i = 0; i < 1000; ++i) {
        std::vector<DirectBody> bodies = {body(), body()};
        DirectPoint at = point();
        const double load = i % 10 == 0 ? 1e6 : 0.3, before = energy(bodies);
        apply_impact_friction(load, at, bodies);
        EXPECT_LT(energy(bodies), before);
        EXPECT_LE(at.impulse.norm(), at.friction * load * (1 + 1e-12));
        EXPECT_LE(at.torque.norm(), at.rolling * load * (1 + 1e-12));
        EXPECT_NEAR(at.normal.dot(at.impulse), 0, 1e-9 * at.impulse.norm());
    }
}

}  // namespace
}  // namespace throng
