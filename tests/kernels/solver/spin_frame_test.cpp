// Spin frame: bodies that contacts push while they turn, with the inertia of the step's beginning.
#include "kernels/math/principal_inertia.hpp"
#include "kernels/math/rotation.hpp"
#include "kernels/solver/solve_kernels.hpp"
#include "kernels/solver/solver_bodies.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace throng {
namespace {

constexpr double kTime = 1.0 / 240;

Vec3 random_vector(std::mt19937& random, double size)
{
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vec3(x, y, z) * size;
}

// The moments of a solid ellipsoid of mass 5.
Vec3 moments_of(const Vec3& half)
{
    const Vec3 s = half.cwiseAbs2();
    return {s.y() + s.z(), s.x() + s.z(), s.x() + s.y()};
}

// A free body as the stages have it: taken up at the beginning of a step, given back at its end.
template <class Real>
struct Top {
    Vec3 moments;
    Quat orientation = Quat::Identity();
    Vec3 spin = Vec3::Zero();  // world axes
    SolverBody<Real> body = {};
    GyroscopicInertia<Real> inertia = {};

    Mat3 in_world(const Vec3& diagonal) const
    {
        const Mat3 r = orientation.toRotationMatrix();
        return r * diagonal.asDiagonal() * r.transpose();
    }
    double energy() const { return 0.5 * spin.dot(Vec3(in_world(moments) * spin)); }
    Vec3 momentum() const { return in_world(moments) * spin; }

    void take_up()
    {
        body = {};
        inertia = {};
        body.delta_pose[7] = 1;
        body.inertia[0] = 1;
        for (int k = 0; k < 3; ++k) body.motion[4 + k] = static_cast<Real>(spin[k]);
        const Sym3 six =
            in_world_axes({moments.x(), moments.y(), moments.z(), 0, 0, 0}, orientation);
        const double numbers[6] = {six.xx, six.yy, six.zz, six.xy, six.xz, six.yz};
        for (int k = 0; k < 6; ++k)
            inertia.share[k] = static_cast<Real>(numbers[k] / moments.sum());
        inertia.share[6] = 1;
        const PrincipalInertia principal{Mat3::Identity(), moments};
        const int own = principal.axis_of_symmetry();
        if (principal.asymmetry(own) > 1e-3) return;
        const Vec3 axis = orientation * Vec3::Unit(own);
        for (int k = 0; k < 3; ++k) inertia.axis[k] = static_cast<Real>(axis[k]);
        inertia.axis[3] = static_cast<Real>(2 * moments[own] / (moments.sum() - moments[own]));
    }
    void begin(bool first)
    {
        Substep<Real> substep;
        substep.time = static_cast<Real>(kTime);
        substep.first = first;
        substep.gyroscopic = Substep<Real>::Gyroscopic::implicit;
        solve_kernels<Real>().begin_substep(&body, &inertia, nullptr, 1, substep);
        // Each substep's contacts are others here.
        for (int k = 0; k < 8; ++k) body.motion[k] = body.free[k];
    }
    // An impulse that stops a point of the body in one direction, by the inertia that the step
    // began with; or as much less as is asked.
    void stop(const Vec3& arm, const Vec3& along, double share)
    {
        const Vec3 lever_arm = arm.cross(along);
        const Vec3 turned = in_world(moments.cwiseInverse()) * lever_arm;
        const double inverse_mass = lever_arm.dot(turned) + 1;  // and some mass
        const Vec3 w(double{body.motion[4]}, double{body.motion[5]}, double{body.motion[6]});
        const double impulse = -share * lever_arm.dot(w) / inverse_mass;
        for (int k = 0; k < 3; ++k)
            body.motion[4 + k] = static_cast<Real>(w[k] + impulse * turned[k]);
    }
    void advance()
    {
        const auto time = static_cast<Real>(kTime);
        if (solve_kernels<Real>().advance(&body, &inertia, nullptr, 1, time, true) > 0)
            turn_fast<Real>({&body, 1}, &inertia, time);
    }
    void give_back()
    {
        spin = spin_frame(body, &inertia)
            * Vec3(double{body.motion[4]}, double{body.motion[5]}, double{body.motion[6]});
        orientation = turn_of(body) * orientation;
        orientation.normalize();
    }
};

// Needles, discs and what is the same about no axis, to 1:1000, turning at any speed.
Vec3 random_shape(std::mt19937& random, int i)
{
    const double thin = std::pow(10.0, -std::uniform_real_distribution<double>(0, 3)(random));
    switch (i % 3) {
    case 0:
        return {thin, thin, 1};
    case 1:
        return {1, thin, 1};
    default:
        return {thin, 0.7, 1};
    }
}

template <class Real>
void check_energy(double rounding)
{
    std::mt19937 random(1);
    for (int i = 0; i < 600; ++i) {
        Top<Real> top{moments_of(random_shape(random, i))};
        top.orientation = exponential(random_vector(random, 2));
        top.spin = random_vector(random, std::pow(10.0, -1 + 3 * (i % 50) / 50.0));
        for (int step = 0; step < 30; ++step) {
            const double before = top.energy();
            top.take_up();
            for (int k = 0; k < 4; ++k) {
                top.begin(k == 0);
                // Some points are stopped before it turns, and some after.
                const Vec3 arm = top.orientation * Vec3(0.01, 0.02, 1);
                top.stop(arm, random_vector(random, 1), 0.5);
                top.advance();
                top.stop(-arm, random_vector(random, 1), 0.5);
            }
            top.give_back();
            ASSERT_LE(top.energy(), before * (1 + rounding))
                << "moments " << top.moments.transpose() << ", step " << step;
        }
    }
}

TEST(SpinFrame, WhatContactsStopGainsNoEnergyAsItTurns)
{
    check_energy<float>(2e-3);
    check_energy<double>(1e-9);
}

// L stays where it is, and the axis goes round it.
template <class Real>
void check_precession(double tolerance)
{
    std::mt19937 random(2);
    for (int i = 0; i < 60; ++i) {
        const double thin = std::pow(10.0, -3 * (i % 20) / 20.0 - 0.05);
        Top<Real> top{moments_of(i % 2 == 0 ? Vec3(thin, thin, 1) : Vec3(1, 1, thin))};
        top.orientation = exponential(random_vector(random, 2));
        const Vec3 across = top.orientation * Vec3(3, 2, 0);
        // Up to a turn a substep about its own axis.
        top.spin = across + top.orientation * Vec3(0, 0, 15.0 * (i % 7));
        const Vec3 momentum = top.momentum(), start = top.orientation * Vec3::UnitZ();
        const int steps = 60;
        for (int step = 0; step < steps; ++step) {
            top.take_up();
            for (int k = 0; k < 4; ++k) {
                top.begin(k == 0);
                top.advance();
            }
            top.give_back();
        }
        const double angle = momentum.norm() / top.moments.x() * 4 * steps * kTime;
        const Vec3 wanted = exponential(momentum.normalized() * angle) * start;
        // By first order, of a substep's turns of both kinds.
        const double turns = angle * (across.norm() + momentum.norm() / top.moments.x()) * kTime;
        EXPECT_LE((top.orientation * Vec3::UnitZ() - wanted).norm(), tolerance + turns)
            << "moments " << top.moments.transpose() << ", " << top.spin.transpose() << " rad/s";
        EXPECT_LE((top.momentum() - momentum).norm(), (tolerance + turns) * momentum.norm());
    }
}

TEST(SpinFrame, ATopGoesRoundItsMomentumHoweverFastItSpins)
{
    check_precession<float>(1e-3);
    check_precession<double>(1e-9);
}

// What is the same about all axes has its spin in those of the world.
TEST(SpinFrame, IsThatOfTheWorldWhereNothingIsToldOfTheInertia)
{
    SolverBody<float> body = {};
    body.delta_pose[4] = 0.6f;
    body.delta_pose[7] = 0.8f;
    EXPECT_EQ(spin_frame<float>(body, nullptr).coeffs(), Quat::Identity().coeffs());
    const GyroscopicInertia<float> none = {};
    EXPECT_EQ(spin_frame<float>(body, &none).coeffs(), Quat::Identity().coeffs());
}

// Axes that follow a body in two ways rather than one lose nothing: of what is the same about no
// axis they are the same, and of what is, closer to how it turns.
TEST(SpinFrame, ATopKeepsMoreOfItsMomentumByAxesTakenAnew)
{
    std::mt19937 random(7);
    double worst[2] = {};
    for (int i = 0; i < 60; ++i) {
        const Vec3 moments = moments_of(random_shape(random, i));
        Top<double> tops[2] = {Top<double>{moments}, Top<double>{moments}};
        const Quat orientation = exponential(random_vector(random, 2));
        const Vec3 spin = random_vector(random, 40);
        for (const bool anew : {false, true}) {
            Top<double>& top = tops[anew];
            top.orientation = orientation;
            top.spin = spin;
            const double energy = top.energy();
            const Vec3 momentum = top.momentum();
            top.take_up();
            for (int k = 0; k < 4; ++k) {
                if (anew && k > 0) {
                    take_axes_anew(top.body, &top.inertia);
                    EXPECT_LT(spin_frame(top.body, &top.inertia).vec().norm(), 1e-14);
                }
                top.begin(k == 0);
                top.advance();
            }
            top.give_back();
            EXPECT_LE(top.energy(), energy * (1 + 1e-9)) << i;
            worst[anew] =
                std::max(worst[anew], (top.momentum() - momentum).norm() / momentum.norm());
        }
        if (tops[0].inertia.axis[3] > 0) continue;
        EXPECT_LT((tops[0].spin - tops[1].spin).norm(), 1e-9 * spin.norm()) << i;
    }
    EXPECT_LT(worst[1], worst[0]);
}

}  // namespace
}  // namespace throng
