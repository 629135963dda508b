// Moving balls: whether balls about parts of two shapes may meet while the shapes are on their
// ways.
#pragma once

#include "kernels/data/bounds.hpp"
#include "narrowphase/ccd/time_of_impact.hpp"

#include <algorithm>

namespace throng {

/// Two shapes on their ways, as they were when these began. Centers are in the shapes' own axes.
class MovingBalls {
public:
    MovingBalls(const MovingShape& a, const MovingShape& b, double begin)
        : a_(a, begin), b_(b, begin), shift_(b.trajectory.shift - a.trajectory.shift),
          b_turn_(a_.turn.transpose() * b_.turn), b_at_(a_.shape.to_local(b_.shape.position))
    { }

    /// Whether balls about a place of each, so wide together, may meet within a time: along a
    /// straight way, but for what turning adds.
    bool may_meet(const Vec3& of_a, const Vec3& of_b, double wide, double time) const
    {
        const Vec3 arm_a = a_.arm(of_a), arm_b = b_.arm(of_b);
        const Vec3 apart = b_.body + arm_b - a_.body - arm_a, way = shift_ * time;
        wide += a_.turning(arm_a.norm(), time) + b_.turning(arm_b.norm(), time);
        const double along = way.squaredNorm();
        const double part = along > 0 ? std::clamp(-apart.dot(way) / along, 0.0, 1.0) : 0;
        return (apart + part * way).squaredNorm() <= wide * wide;
    }

    /// m, that a point of b in a ball may go within a time, as seen from a.
    double drift(const Vec3& of_b, double radius, double time) const
    {
        const Vec3 arm = b_.arm(of_b);
        const double own = shift_.norm() * time + b_.turning(arm.norm() + radius, time);
        return own + a_.turning((b_.body + arm - a_.body).norm() + radius + own, time);
    }

    /// Whether boxes in the shapes' own axes may come within `close` of one another within a time.
    /// Tighter than balls about them where the two hardly move.
    bool may_meet(const Box3& of_a, const Box3& of_b, double close, double time) const
    {
        const Vec3 center = 0.5 * (of_b.lower + of_b.upper), half = 0.5 * (of_b.upper - of_b.lower);
        const Vec3 extent =
            b_turn_.cwiseAbs() * half + Vec3::Constant(close + drift(center, half.norm(), time));
        const Vec3 middle = from_b(center);
        return of_a.overlaps({middle - extent, middle + extent});
    }

    /// A place of b in a's axes, as the ways began.
    Vec3 from_b(const Vec3& of_b) const { return b_turn_ * of_b + b_at_; }

    /// m, by how much a place of a may come closer to b within a time, whatever b is.
    double approach(const Vec3& of_a, double time) const
    {
        const Vec3 arm = a_.arm(of_a);
        const double own = shift_.norm() * time + a_.turning(arm.norm(), time);
        return own + b_.turning((a_.body + arm - b_.body).norm() + own, time);
    }

    /// A place of a in b's axes.
    Vec3 seen_from_b(const Vec3& of_a) const { return b_.shape.to_local(a_.body + a_.arm(of_a)); }

private:
    struct Start {
        Start(const MovingShape& moving, double begin)
            : shape(moving.trajectory.at(begin) * moving.local),
              turn(shape.orientation.toRotationMatrix()),
              body(moving.trajectory.at(begin).position), from_body(shape.position - body),
              spin(moving.trajectory.angle())
        { }
        Vec3 arm(const Vec3& center) const { return turn * center + from_body; }
        // m, that turning takes a point so far from where the body turns about at most.
        double turning(double arm, double time) const { return std::min(2.0, spin * time) * arm; }

        Pose shape;
        Mat3 turn;
        Vec3 body, from_body;
        double spin;
    };

    Start a_, b_;
    Vec3 shift_;
    Mat3 b_turn_;  // of b's axes in a's, as the ways began
    Vec3 b_at_;
};

}  // namespace throng
