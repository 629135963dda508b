// Gyroscopic: the torque as the solver's bodies feel it, against the same in body axes in double.
#include "kernels/math/rotation.hpp"
#include "kernels/solver/solve_kernels.hpp"
#include "kernels/solver/solver_bodies.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace throng {
namespace {

Vec3 random_vector(std::mt19937& random, double size)
{
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vec3(x, y, z) * size;
}

// A body that has turned since the step began, and the same in double.
template <class Real>
struct Top {
    SolverBody<Real> body = {};
    GyroscopicInertia<Real> inertia = {};
    Sym3 local;
    Quat orientation;  // by now
    Vec3 spin;

    Top(const Sym3& moments, const Quat& start, const Quat& turn, const Vec3& w) : local(moments)
    {
        body.inertia[0] = 1;
        for (int k = 0; k < 4; ++k) body.delta_pose[4 + k] = static_cast<Real>(turn.coeffs()[k]);
        const Vec3 along = turn.conjugate() * w;
        for (int k = 0; k < 3; ++k) body.motion[4 + k] = static_cast<Real>(along[k]);
        const Sym3 six = in_world_axes(local, start);
        const double trace = six.xx + six.yy + six.zz;
        const double numbers[6] = {six.xx, six.yy, six.zz, six.xy, six.xz, six.yz};
        for (int k = 0; k < 6; ++k) inertia.share[k] = static_cast<Real>(numbers[k] / trace);
        inertia.share[6] = 1;
        orientation = turn_of(body) * start;
        orientation.normalize();
        spin = after();
    }
    Vec3 after() const
    {
        return spin_frame(body, &inertia)
            * Vec3(double{body.motion[4]}, double{body.motion[5]}, double{body.motion[6]});
    }
    double energy(const Vec3& w) const
    {
        const Vec3 in_body = orientation.conjugate() * w;
        return in_body.dot(local.matrix() * in_body);
    }
    void turn(bool implicit, double time)
    {
        Substep<Real> substep;
        substep.time = static_cast<Real>(time);
        substep.first = true;
        substep.gyroscopic =
            implicit ? Substep<Real>::Gyroscopic::implicit : Substep<Real>::Gyroscopic::direct;
        solve_kernels<Real>().begin_substep(&body, &inertia, nullptr, 1, substep);
    }
    Vec3 wanted(bool implicit, double time) const
    {
        return implicit ? after_gyroscopic_torque(spin, local, orientation, time)
                        : after_explicit_gyroscopic_torque(spin, local, orientation, time);
    }
};

// The moments of a solid: none is greater than the other two together.
Sym3 moments_of(const Vec3& half)
{
    const Vec3 s = half.cwiseAbs2();
    return {s.y() + s.z(), s.x() + s.z(), s.x() + s.y(), 0, 0, 0};
}

Top<double> random_top(std::mt19937& random, const Vec3& half, double speed)
{
    const Quat start = exponential(random_vector(random, 2));
    return {moments_of(half), start, exponential(random_vector(random, 0.3)),
            random_vector(random, speed)};
}

constexpr double kTime = 1.0 / 240;

TEST(Gyroscopic, IsThatOfTheBodysOwnAxes)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> size(0.2, 1);
    for (const bool implicit : {true, false})
        for (int i = 0; i < 20000; ++i) {
            // From a slow turn to a hundred turns a substep.
            const double speed = std::pow(10.0, -3 + 8 * i / 20000.0);
            const Vec3 half(size(random), size(random), size(random));
            Top<double> top = random_top(random, half, speed);
            const Vec3 wanted = top.wanted(implicit, kTime);
            top.turn(implicit, kTime);
            ASSERT_LE((top.after() - wanted).norm(), 1e-11 * (wanted.norm() + top.spin.norm()))
                << implicit << ' ' << speed << " rad/s, half sizes " << half.transpose();
        }
}

// Needles and plates, a millionth as thick as wide.
TEST(Gyroscopic, HoldsForNeedlesAndPlates)
{
    std::mt19937 random(2);
    for (int i = 0; i < 6000; ++i) {
        const double thin = std::pow(10.0, -1 - 5 * (i / 2) / 3000.0);
        const Vec3 half = i % 2 == 0 ? Vec3(thin, thin * 0.7, 1) : Vec3(thin, 0.8, 1);
        const double speed = std::pow(10.0, -1 + 3 * (i % 100) / 100.0);
        Top<double> top = random_top(random, half, speed);
        const Vec3 wanted = top.wanted(true, kTime);
        top.turn(true, kTime);
        // What is left of the digits of the least moment.
        const double least = half.x() * half.x();
        ASSERT_LE((top.after() - wanted).norm(), 1e-13 / least * speed)
            << speed << " rad/s, half sizes " << half.transpose();
    }
}

template <class Real>
void check_energy(double most)
{
    std::mt19937 random(3);
    for (int i = 0; i < 40000; ++i) {
        const double thin = std::pow(10.0, -6 * (i / 2) / 20000.0);
        const Vec3 half = i % 2 == 0 ? Vec3(thin, thin * 0.7, 1) : Vec3(thin, 0.8, 1);
        const Quat start = exponential(random_vector(random, 2));
        const Quat turn = exponential(random_vector(random, 0.3));
        const double speed = std::pow(10.0, -2 + 7 * (i % 100) / 100.0);
        // About the long axis, across it, or any way.
        Vec3 w = random_vector(random, speed);
        if (i % 3 == 1) w = turn * (start * Vec3(0, 0, speed));
        if (i % 3 == 2) w = turn * (start * Vec3(speed, 0.01 * speed, 0));
        Top<Real> top(moments_of(half), start, turn, w);
        const double before = top.spin.norm();
        top.turn(true, kTime);
        ASSERT_TRUE(top.after().allFinite())
            << speed << " rad/s, half sizes " << half.transpose() << ", case " << i;
        ASSERT_LE(top.after().norm(), most * before / thin)
            << speed << " rad/s, half sizes " << half.transpose() << ", case " << i;
        ASSERT_LE(top.energy(top.after()),
                  top.energy(top.spin) * (1 + 1e-3) + 1e-5 * before * before)
            << speed << " rad/s, half sizes " << half.transpose() << ", case " << i;
    }
}

TEST(Gyroscopic, GainsNoEnergyWhateverTheShapeAndSpin)
{
    check_energy<float>(3);
    check_energy<double>(3);
}

TEST(Gyroscopic, StaysFiniteUpToWhatAStepCanHold)
{
    std::mt19937 random(4);
    for (int i = 0; i < 4000; ++i) {
        const double speed = std::pow(10.0, 3 + 12 * i / 4000.0);
        const Vec3 w = random_vector(random, 1).normalized() * speed;
        Top<float> top(moments_of(Vec3(0.3, 0.5, 1)), Quat::Identity(), Quat::Identity(), w);
        top.turn(true, kTime);
        ASSERT_TRUE(top.after().allFinite()) << speed << " rad/s";
        ASSERT_LE(top.after().norm(), 4 * speed);
    }
}

TEST(Gyroscopic, AgreesInFloatToItsDigits)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> size(0.2, 1);
    for (int i = 0; i < 20000; ++i) {
        const double speed = std::pow(10.0, -3 + 5 * i / 20000.0);
        const Vec3 half(size(random), size(random), size(random));
        const Quat start = exponential(random_vector(random, 2));
        const Quat turn = exponential(random_vector(random, 0.3));
        for (const bool implicit : {true, false}) {
            Top<float> top(moments_of(half), start, turn, random_vector(random, speed));
            const Vec3 wanted = top.wanted(implicit, kTime);
            top.turn(implicit, kTime);
            ASSERT_LE((top.after() - wanted).norm(), 2e-5 * (wanted.norm() + top.spin.norm()))
                << implicit << ' ' << speed << " rad/s, half sizes " << half.transpose();
        }
    }
}

TEST(Gyroscopic, LeavesAloneWhereItDoesNotAct)
{
    Top<float> top(moments_of(Vec3(0.3, 0.5, 1)), Quat::Identity(), Quat::Identity(),
                   Vec3(10, 20, 30));
    top.inertia = {};
    top.turn(true, kTime);
    EXPECT_EQ(top.after(), Vec3(10, 20, 30));
    top.turn(false, kTime);
    EXPECT_EQ(top.after(), Vec3(10, 20, 30));
}

}  // namespace
}  // namespace throng
