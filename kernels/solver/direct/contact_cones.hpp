// Contact cones: an island's points as rows over its bodies, in units that know no sizes and
// masses.
//
// Bodies are told in units in which each has mass 1, points in units in which their normal answers
// with 1, and all speeds as shares of the greatest.
#pragma once

#include "kernels/solver/direct/body_matrix.hpp"
#include "kernels/solver/direct/direct.hpp"

#include <vector>

namespace throng {

/// A point as rows: normal, then sliding times friction, then turning times rolling friction.
/// Speeds and impulses are of the rows.
///
///   tie    columns of its two bodies
///   point  its place among the points
///   free   speed without impulses
struct ContactCone {
    std::size_t rows = 1;
    BodyTie tie;
    std::size_t point = 0;
    ConeBlock of_a = ConeBlock::Zero(), of_b = ConeBlock::Zero();
    ConeVector free{};
    ConeVector speed{}, impulse{};

    // How rows were made, to give impulses back.
    double unit = 1;  // impulse of 1, in sqrt(kg) m/s of the greatest speed
    Vec3 axis[kConeRows] = {};
    double share[kConeRows] = {};
    bool turns[kConeRows] = {};
};

class ContactCones {
public:
    std::vector<ContactCone> cones;

    /// False where there is nothing to solve.
    bool take(std::span<const DirectBody> bodies, std::span<const DirectPoint> points);
    /// Gives impulses to the points, and to the bodies the velocities they make.
    void give(std::span<DirectBody> bodies, std::span<DirectPoint> points) const;

    /// Bodies that move.
    std::size_t columns() const { return columns_; }
    std::vector<BodyTie> ties() const;
    /// What the rows of a cone see of a change of velocities, [columns].
    ConeVector seen(const ContactCone& cone, std::span<const BodySix> change) const;
    /// Adds to a change of velocities what an impulse on the rows does.
    void apply_impulse(const ContactCone& cone,
                       const ConeVector& impulse,
                       std::span<BodySix> change) const;
    /// The change that all impulses together make.
    void push_all(std::vector<BodySix>& change) const;
    /// By how much impulses and the velocities they make miss the law: see DirectAnswer. Infinite
    /// where any of them is not finite.
    double residual(std::vector<BodySix>& scratch) const;
    /// What the impulses do to the energy that bodies have beside the least speeds they may part
    /// at, in units of their own: an answer's takes some, whatever the friction.
    double work(std::vector<BodySix>& scratch) const;

private:
    struct Root {
        double linear = 0;
        Mat3 angular = Mat3::Zero();
        std::int32_t column = -1;
    };
    void take_bodies(std::span<const DirectBody> bodies);
    void add_side(const DirectPoint& point,
                  std::span<const DirectBody> bodies,
                  bool is_b,
                  ContactCone& cone) const;
    void take_guess(const DirectPoint& point, ContactCone& cone) const;

    std::vector<Root> roots_;  // [bodies] of inverse masses
    std::size_t columns_ = 0;
    double unit_ = 1;  // sqrt(kg) m/s, of all speeds
};

}  // namespace throng
