// Collide: what the convex and the mesh stage share in making a contact of a local manifold.
#pragma once

#include "kernels/data/contacts.hpp"
#include "kernels/math/hash.hpp"
#include "narrowphase/dispatch.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

/// What was found of a pair is recycled until a point has moved by this share of the smaller
/// shape's smallest half extent, a sixth of the reach of bodies at rest. A third more overlaps no
/// deeper, but saves little.
inline constexpr double kRecycled = 12e-3;

/// The colliders of a pair and where they are.
struct PairPlace {
    std::uint32_t a = 0, b = 0;  // colliders
    std::uint32_t body_a = 0, body_b = 0;
    double speculative_margin = 0;  // m, of both together
};

inline PairPlace place_of(PairKey key, const Colliders& colliders, const Bounds& bounds)
{
    const std::uint32_t a = first_of(key), b = second_of(key);
    return {a, b, colliders.body[a], colliders.body[b],
            bounds.speculative_margin[a] + bounds.speculative_margin[b]};
}

/// From the center of a pair's first shape to that of its second, m. Where both are at one place no
/// way apart is better than another, and each is taken to stand a hair from it towards its own
/// spot: of a crowd made at one point all would part along the same line.
inline Vec3 between_centers(std::uint32_t first,
                            std::uint32_t second,
                            const Colliders& colliders,
                            const Bounds& bounds)
{
    constexpr double kHair = 1e-4;  // of the smaller half extent
    const Vec3& from = bounds.placed[first].position;
    const Vec3& to = bounds.placed[second].position;
    if (from != to) return to - from;
    const double least = std::min(colliders.inner_extent[first], colliders.inner_extent[second]);
    return kHair * least * (spot_of(second) - spot_of(first));
}

/// How far a pair that touched in the last step is looked at, m. A fast body looks for no contacts
/// ahead, but for those with what it slides on: it would lose that to a breath, and fall into it,
/// at every other step.
inline double kept_speculative_margin(const PairPlace& pair, const Bounds& bounds)
{
    return std::max(bounds.speculative_margin[pair.a], bounds.kept[pair.a])
        + std::max(bounds.speculative_margin[pair.b], bounds.kept[pair.b]);
}

/// The axes of one of a pair as it is looked at. A sphere has none of its own and takes the
/// other's: seen along axes that turn, what is far away would tremble.
inline const Quat& axes_of(std::uint32_t collider,
                           std::uint32_t other,
                           const Colliders& colliders,
                           const Bounds& bounds)
{
    const bool round = colliders.shape[collider].kind == ShapeKind::sphere;
    return bounds.placed[round ? other : collider].orientation;
}

/// The frame that a pair is looked at in: its first's.
inline Pose frame_of(std::uint32_t first,
                     std::uint32_t second,
                     const Colliders& colliders,
                     const Bounds& bounds)
{
    return {bounds.placed[first].position, axes_of(first, second, colliders, bounds)};
}

/// The pose of a pair's second shape in its frame; the two are told apart like that.
inline Pose seen_from_first(std::uint32_t first,
                            std::uint32_t second,
                            const Shapes& shapes,
                            const Colliders& colliders,
                            const Bounds& bounds)
{
    const Pose &from = bounds.placed[first], &to = bounds.placed[second];
    const ShapeRef shape = colliders.shape[second];
    const bool round =
        colliders.shape[first].kind == ShapeKind::sphere || shape.kind == ShapeKind::sphere;
    const bool apart = from.position != to.position;
    // Most, and without a copy.
    if (!round && apart) return pose_seen_from_a(shapes, shape, from, to);
    const Pose frame = frame_of(first, second, colliders, bounds);
    Pose seen = {to.position, axes_of(second, first, colliders, bounds)};
    if (!apart) seen.position += between_centers(first, second, colliders, bounds);
    return pose_seen_from_a(shapes, shape, frame, seen);
}

/// True when somebody in the pair can be pushed and somebody is awake.
inline bool wants_contact(const PairPlace& pair, const BodyStates& states)
{
    return (states.dynamic(pair.body_a) || states.dynamic(pair.body_b))
        && (states.moves(pair.body_a) || states.moves(pair.body_b));
}

/// A relative pose, exact in double until here, so that the distance from the origin costs nothing.
template <class Real>
PoseT<Real> rounded(const Pose& pose)
{
    return {pose.position.template cast<Real>(),
            QuatT<Real>(pose.orientation.template cast<Real>())};
}

/// Where a body's anchors are counted from. A still body has no use for its own center, which may
/// be far away: it takes the other's, so that the numbers stay small.
inline const Vec3&
anchor_origin(std::uint32_t body, std::uint32_t other, const BodyStates& states, const Poses& poses)
{
    return poses.position[states.kind[body] == BodyKind::static_ ? other : body];
}

/// Turns a manifold in collider a's frame into a contact in world axes, anchors from the centers of
/// mass, each on its own body's surface. One that was found in double may be far from a's origin.
template <class Real, class From>
void make_contact(const LocalManifold<From>& manifold,
                  const Pose& placed_a,
                  const Vec3& center_a,
                  const Vec3& center_b,
                  Contact<Real>& contact)
{
    const Mat3T<From> axes =
        QuatT<From>(placed_a.orientation.template cast<From>()).toRotationMatrix();
    const Vec3T<From> offset_a = (placed_a.position - center_a).template cast<From>();
    const Vec3T<From> normal = axes * manifold.normal;
    contact.center_offset = (center_a - center_b).template cast<Real>();
    contact.normal = normal.template cast<Real>();
    contact.count = manifold.count;
    for (int k = 0; k < manifold.count; ++k) {
        const auto& from = manifold.points[static_cast<std::size_t>(k)];
        auto& to = contact.points[static_cast<std::size_t>(k)];
        const Vec3T<From> middle = axes * from.position;
        const Vec3T<From> half = normal * (from.separation / 2);
        to.anchor_a = (middle + offset_a - half).template cast<Real>();
        to.separation = static_cast<Real>(from.separation);
        to.feature = from.feature;
        to.impulse = 0;
    }
    contact.friction.setZero();
    contact.rolling.setZero();
    contact.torsional_impulse = 0;
}

/// Radius of the side that a shape turns along a direction, where turning the shape leaves that
/// side as it is; 0 for sides with a shape of their own.
inline double
round_radius(const Shapes& shapes, ShapeRef shape, const Pose& placed, const Vec3& direction)
{
    switch (shape.kind) {
    case ShapeKind::sphere:
        return shapes.spheres[shape.index].radius;
    case ShapeKind::capsule:
        return shapes.capsules[shape.index].radius;
    case ShapeKind::cylinder: {
        const bool on_its_side =
            std::abs((placed.orientation * Vec3::UnitZ()).dot(direction)) < 0.5;
        return on_its_side ? shapes.cylinders[shape.index].radius : 0;
    }
    default:
        return 0;
    }
}

/// Notes which sides of a contact are round.
template <class Real>
void note_round_sides(const Shapes& shapes,
                      ShapeRef a,
                      ShapeRef b,
                      const Pose& placed_a,
                      const Pose& placed_b,
                      Contact<Real>& contact)
{
    const Vec3 normal = contact.normal.template cast<double>();
    contact.round_a = static_cast<Real>(round_radius(shapes, a, placed_a, normal));
    contact.round_b = static_cast<Real>(round_radius(shapes, b, placed_b, normal));
}

/// The same contact with a and b told the other way round.
template <class Real>
void turn_round(Contact<Real>& contact)
{
    for (int k = 0; k < contact.count; ++k)
        contact.points[static_cast<std::size_t>(k)].anchor_a = contact.anchor_b(k);
    contact.normal = -contact.normal;
    contact.center_offset = -contact.center_offset;
    std::swap(contact.round_a, contact.round_b);
}

/// Impulses of the last step are for its substep; a step of another length scales them.
inline double impulse_scale(const StepContext& context)
{
    return context.last_substep > 0 ? context.substep() / context.last_substep : 0.0;
}

/// The same for a contact that stays as it is.
template <class Real>
void scale_impulses(Contact<Real>& contact, Real scale)
{
    for (int k = 0; k < contact.count; ++k)
        contact.points[static_cast<std::size_t>(k)].impulse *= scale;
    contact.friction *= scale;
    contact.rolling *= scale;
    contact.torsional_impulse *= scale;
}

}  // namespace throng
