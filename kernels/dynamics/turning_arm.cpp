#include "kernels/dynamics/turning_arm.hpp"

#include "kernels/math/rotation.hpp"

#include <cmath>

namespace throng {

namespace {

Mat3 turn_by(const Vec3& turn) { return exponential(turn).toRotationMatrix(); }

// A chord over its arc.
double chord_of(double angle)
{
    const double half = 0.5 * angle;
    return half == 0 ? 1 : sin_cos(half).sin / half;
}

// What is across an axis as long as the chord says, the rest as it is: it does not move.
Vec3 shortened(const Vec3& arm, const Vec3& turn, double chord)
{
    const double square = turn.squaredNorm();
    if (!(square > 0)) return arm;
    return chord * arm + (1 - chord) * arm.dot(turn) / square * turn;
}

}  // namespace

Mat3 still_lever_arm(const Vec3& arm)
{
    Mat3 lever_arm;
    lever_arm << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
    return lever_arm;
}

BodyTurn::BodyTurn(const Vec3& spin, const Vec3& axis, double carries, double span)
    : axis_(axis), share_(carries)
{
    const double about = span * axis.dot(spin);
    carry_ = span * spin + (carries - 1) * about * axis;
    roll_ = (1 - carries) * about;
    chord_ = chord_of(std::sqrt(carry_.squaredNorm()));
    roll_chord_ = chord_of(roll_);
    carried_ = turn_by(carry_);
    halfway_ = turn_by(0.5 * carry_);
    rolled_ = roll_ == 0 ? Mat3(Mat3::Identity()) : turn_by(roll_ * axis_);
    half_rolled_ = roll_ == 0 ? Mat3(Mat3::Identity()) : turn_by(0.5 * roll_ * axis_);
}

Mat3 BodyTurn::lever_arm(const Vec3& arm) const
{
    const Vec3 along = shortened(halfway_ * Vec3(rolled_ * arm), carry_, chord_);
    Mat3 lever_arm = halfway_.transpose() * still_lever_arm(along);
    if (share_ == 1) return lever_arm;
    // About the own axis a share is done by each of both turns.
    const Vec3 beside = roll_chord_ * Vec3(half_rolled_ * arm);
    const Vec3 by_roll = -beside.cross(axis_), by_carry = lever_arm.transpose() * axis_;
    return lever_arm + (1 - share_) * Mat3(axis_ * Vec3(by_roll - by_carry).transpose());
}

double BodyTurn::angle_of(const Vec3& arm) const
{
    const double length = arm.squaredNorm();
    if (!(length > 0)) return 0;
    const Vec3 by_carry = carry_.cross(arm), by_roll = roll_ * axis_.cross(arm);
    return std::sqrt((by_carry.squaredNorm() + by_roll.squaredNorm()) / length);
}

}  // namespace throng
