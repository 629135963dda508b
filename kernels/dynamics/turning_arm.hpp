// Turning arm: where a point of a body comes to while the body turns through a step, and how a
// force that follows it turns the body meanwhile.
//
// A body turns about two axes: it is carried by one rate, that stays as it is in the world, and
// turns by another about an axis of its own, that is carried along. All ways to move a body here
// are of that kind: see BodyTurn::carries.
//
// Half of what a force at the end of an arm gives comes before that turn and half after it. Taken
// both times about the arm as it is halfway, in the axes that are carried, it does just the work of
// the force along the way of the end, whatever the inertia and however far it turns:
//
//   after - arm = span * lever_arm^T spin,   so   impulse . (after - arm) / span = spin . lever_arm
//   impulse.
//
// Source: Simo & Wong, Unconditionally stable algorithms for rigid body dynamics that exactly
//         preserve energy and momentum (1991), for a midpoint in axes halfway.
#pragma once

#include "throng/math.hpp"

namespace throng {

/// What an impulse at the end of an arm turns a body by that stays as it is: the matrix of
/// arm.cross().
Mat3 still_lever_arm(const Vec3& arm);

/// A body's turn in a step.
class BodyTurn {
public:
    /// spin     rad/s, world axes; s
    /// axis     world axes, of unit length, as the step begins
    /// carries  how much of the spin about the axis carries the axis itself: 1: all of it, as of a
    ///          body that turns by its spin as it is; 0: none, as of one whose axis goes straight
    ///          on; of a free one that is symmetric about the axis its moment about it over that
    ///          across
    BodyTurn(const Vec3& spin, const Vec3& axis, double carries, double span);

    /// From the axes that are carried as they were to where they come.
    const Mat3& carried() const { return carried_; }

    /// Where an arm comes to, world axes.
    Vec3 after(const Vec3& arm) const { return carried_ * Vec3(rolled_ * arm); }
    /// What an impulse at the arm's end turns the body by, N m s in world axes as the step begins:
    /// a matrix times the impulse.
    Mat3 lever_arm(const Vec3& arm) const;
    /// rad, how far the arm itself goes round.
    double angle_of(const Vec3& arm) const;

private:
    Vec3 carry_, axis_;        // rad
    double roll_, share_ = 1;  // rad
    double chord_, roll_chord_;
    Mat3 carried_, halfway_, rolled_, half_rolled_;
};

}  // namespace throng
