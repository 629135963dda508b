// Support: what a convex shape shows to a direction: its furthest point, and its furthest face.
//
// A shape is seen as a core rounded by a radius: a sphere is a point, a capsule a segment, both
// rounded; cylinder, box and hull are their own core. Methods that measure distance work on cores,
// so that round shapes get exact answers. Everything here is in the shape's own frame.
#pragma once

#include "kernels/data/shapes.hpp"

#include <array>
#include <span>

namespace throng {

/// The core of a convex shape, with all that its furthest points depend on at hand.
///
///   extents   box: half extents; cylinder: (radius, radius, half length); capsule: (0, 0, half
///             length); sphere: 0; hull: half the sides of its bounds about `middle`
///   radius    by which the core is rounded: 0 but for spheres and capsules
///   size      greatest distance of the core from its frame's origin, rounding included, or a
///             bound within twice of it: what tolerances are relative to
///   middle    a point inside the core
///   corners   of a triangle, or whatever points there are
template <class Real>
struct ConvexCore {
    ShapeKind kind = ShapeKind::sphere;
    Vec3T<Real> extents = Vec3T<Real>::Zero();
    Real convex_radius = 0;
    Real size = 0;
    Vec3T<Real> middle = Vec3T<Real>::Zero();
    const Hull* hull = nullptr;
    const Vec3T<Real>* corners = nullptr;
    std::uint32_t corner_count = 0;
};

/// That of a triangle, or of the hull of more points: each is looked at for every support. At least
/// one. Keep them while it lives.
template <class Real>
ConvexCore<Real> convex_core_of_points(std::span<const Vec3T<Real>> corners);

/// Needs: a sphere, capsule, cylinder, box or hull.
template <class Real>
ConvexCore<Real> convex_core_of(const Shapes& shapes, ShapeRef shape);

/// A point of a core that lies furthest along some direction.
///
///   feature   box: corner, bit i set where coordinate i is positive; hull: vertex; capsule: end;
///             cylinder: cap (0 below, 1 above); triangle: corner; sphere: 0
template <class Real>
struct SupportPoint {
    Vec3T<Real> position = Vec3T<Real>::Zero();
    std::uint32_t feature = 0;
};

/// The furthest point of a core along a direction of any length, 0 included; the first of equals.
template <class Real>
SupportPoint<Real> support(const ConvexCore<Real>& core, const Vec3T<Real>& direction);

inline constexpr int kMaxFaceCorners = 32;

/// What a core shows to a direction: a polygon, a segment or a point.
///
///   corners   counter-clockwise seen from outside
///   features  of each corner, unique within the shape
///   normal    unit: of a polygon its own, outward; of a segment or a point the direction asked for
///   feature   which face, edge or point it is
///   flat      normal is a true face normal of the shape and not a stand-in
template <class Real>
struct SupportFace {
    std::array<Vec3T<Real>, kMaxFaceCorners> corners;
    std::array<std::uint32_t, kMaxFaceCorners> features;
    int count = 0;
    Vec3T<Real> normal = Vec3T<Real>::UnitZ();
    std::uint32_t feature = 0;
    bool flat = false;

    void add(const Vec3T<Real>& corner, std::uint32_t corner_feature)
    {
        corners[static_cast<std::size_t>(count)] = corner;
        features[static_cast<std::size_t>(count++)] = corner_feature;
    }
};

/// The face that a core turns towards a direction.
///
/// Box and hull always give the face whose normal is nearest. A cylinder gives a cap, as eight
/// corners on its rim, when the direction is within 45 degrees of its axis, else the line of its
/// side; a capsule's core gives its whole segment when it lies across the direction within some ten
/// degrees, else the nearer end. A hull face of more than kMaxFaceCorners corners is thinned
/// evenly.
///
///   direction   unit
template <class Real>
SupportFace<Real> support_face(const ConvexCore<Real>& core, const Vec3T<Real>& direction);

/// Four corners of the cap that a cylinder turns towards a direction, at right angles to one
/// another on its rim. The first is the furthest point of all once the cap leans by 0.0002 or more;
/// below that they turn back smoothly to places that stay with the body. The eight of
/// support_face() are these and those between.
template <class Real>
SupportFace<Real> rim_points(const ConvexCore<Real>& cylinder, const Vec3T<Real>& direction);

/// The unit vector along v, whatever its scale; the fallback where v is 0.
template <class Real>
Vec3T<Real> unit_or(const Vec3T<Real>& v, const Vec3T<Real>& fallback)
{
    const Real scale = v.cwiseAbs().maxCoeff();
    if (!(scale > 0)) return fallback;
    const Vec3T<Real> scaled = v / scale;
    return scaled / std::sqrt(scaled.squaredNorm());
}

/// A unit vector at right angles to a unit vector: the same on every machine and every call.
template <class Real>
Vec3T<Real> any_perpendicular(const Vec3T<Real>& unit)
{
    int least = 0;
    if (std::abs(unit.y()) < std::abs(unit[least])) least = 1;
    if (std::abs(unit.z()) < std::abs(unit[least])) least = 2;
    Vec3T<Real> axis = Vec3T<Real>::Zero();
    axis[least] = 1;
    const Vec3T<Real> across = axis - unit * unit[least];
    return across / std::sqrt(across.squaredNorm());
}

}  // namespace throng
