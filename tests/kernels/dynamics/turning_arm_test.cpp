// Turning arms: forces at their ends do the work that the way of the ends says.
#include "kernels/dynamics/turning_arm.hpp"

#include "kernels/math/rotation.hpp"

#include <gtest/gtest.h>

#include <random>

namespace throng {
namespace {

class AnyTurn {
public:
    Vec3 vector()
    {
        const double x = side_(random_), y = side_(random_);
        return Vec3(x, y, side_(random_));
    }

private:
    std::mt19937 random_{11};
    std::uniform_real_distribution<double> side_{-1, 1};
};

// However far: a tenth of a radian, some turns, many.
constexpr double kFast[] = {0.1, 3, 20, 300};

TEST(TurningArm, LeverArmDoesTheWorkOfTheWay)
{
    AnyTurn any;
    for (const double carries : {0.0, 0.3, 1.0, 1.9})
        for (const double fast : kFast)
            for (int i = 0; i < 50; ++i) {
                const Vec3 spin = fast * any.vector(), arm = any.vector(), impulse = any.vector();
                const double span = 0.7;
                const BodyTurn turn(spin, any.vector().normalized(), carries, span);
                const double work = impulse.dot(turn.after(arm) - arm);
                EXPECT_NEAR(span * spin.dot(Vec3(turn.lever_arm(arm) * impulse)), work, 1e-11)
                    << carries << ' ' << fast;
            }
}

TEST(TurningArm, IsCarriedByTheWholeSpinOrByWhatIsAcrossTheAxis)
{
    AnyTurn any;
    for (int i = 0; i < 50; ++i) {
        const Vec3 spin = 4 * any.vector(), arm = any.vector(), axis = any.vector().normalized();
        const Vec3 about = axis * axis.dot(spin);
        const Vec3 whole = exponential(spin) * arm;
        const Vec3 split = exponential(Vec3(spin - about)) * Vec3(exponential(about) * arm);
        EXPECT_LT((BodyTurn(spin, axis, 1, 1).after(arm) - whole).norm(), 1e-14);
        EXPECT_LT((BodyTurn(spin, axis, 0, 1).after(arm) - split).norm(), 1e-14);
    }
}

TEST(TurningArm, OfABodyAtRestIsItsCrossProduct)
{
    AnyTurn any;
    const Vec3 arm = any.vector(), impulse = any.vector();
    const BodyTurn still(Vec3::Zero(), Vec3::UnitX(), 1, 1);
    EXPECT_EQ(Vec3(still.lever_arm(arm) * impulse), Vec3(still_lever_arm(arm) * impulse));
    EXPECT_LT((still_lever_arm(arm) * impulse - arm.cross(impulse)).norm(), 1e-16);
    EXPECT_EQ(still.angle_of(arm), 0);
}

// A needle whose end a force pulls at is not spun about its length by that, whatever it turns by.
TEST(TurningArm, AlongAnAxisGetsNothingAboutIt)
{
    AnyTurn any;
    for (const double fast : kFast) {
        const Vec3 axis = any.vector().normalized(), impulse = any.vector();
        const Vec3 spin = fast * any.vector();
        const BodyTurn turn(spin, axis, 0, 1);
        EXPECT_NEAR(axis.dot(Vec3(turn.lever_arm(0.5 * axis) * impulse)), 0, 1e-14);
    }
}

}  // namespace
}  // namespace throng
