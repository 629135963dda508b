// Capsule contacts: what a capsule shares with the shape beside it, once the way out is known: two
// points where its axis lies along a face, an edge or another capsule, else one.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "kernels/geometry/support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

/// The length of a vector, whatever its scale.
template <class Real>
inline Real length_of(const Vec3T<Real>& v)
{
    const Real square = v.squaredNorm();
    // Twice as far from the ends as need be; the square of a coordinate may be lost before the sum.
    if (square > Real(1e-30) && square < Real(1e30)) return std::sqrt(square);
    return unit_or(v, Vec3T<Real>(Vec3T<Real>::Zero())).dot(v);
}

/// A capsule's axis as the other shape sees it: center + t along, t from -half to half.
///
///   rounding   m, its radius, and the other's radius if that is round as well
template <class Real>
struct CapsuleSegment {
    Vec3T<Real> center, along;  // along: unit
    Real half = 0, radius = 0, convex_radius = 0;

    Vec3T<Real> at(Real t) const { return center + t * along; }
};

/// The way out: unit, from the other shape to the segment, in the other's frame; where along the
/// segment it is nearest; and how far the axis is from the other shape's core, below 0 inside.
template <class Real>
struct CapsuleAxis {
    Vec3T<Real> outward;
    Real at = 0;
    Real separation = 0;
};

/// A stretch of a segment that lies over a face or along an edge, and its height over that along
/// the way out: height + t climb.
template <class Real>
struct SegmentRange {
    Real low = 0, high = 0;
    Real height = 0, climb = 0;

    /// Leaves what has |from + t slope| <= limit.
    void keep(Real from, Real slope, Real limit)
    {
        if (std::abs(slope) * (high - low) < std::numeric_limits<Real>::min()) {
            if (std::abs(from) > limit) high = low - 1;
            return;
        }
        const Real one = (-limit - from) / slope, two = (limit - from) / slope;
        low = std::max(low, std::min(one, two));
        high = std::min(high, std::max(one, two));
    }
    /// Leaves what has from + t slope <= limit.
    void cut(Real from, Real slope, Real limit)
    {
        if (std::abs(slope) * (high - low) < std::numeric_limits<Real>::min()) {
            if (from > limit) high = low - 1;
        } else if (slope > 0) {
            high = std::min(high, (limit - from) / slope);
        } else {
            low = std::max(low, (limit - from) / slope);
        }
    }
};

/// Cosine: an axis that leans more from a face's normal touches an edge or a corner.
template <class Real>
inline constexpr Real kFacing = Real(0.995);

/// True when the segment lies across the way out, within ten degrees; one that leans more touches
/// with an end alone.
template <class Real>
bool lies_across(const CapsuleSegment<Real>& segment, const CapsuleAxis<Real>& axis)
{
    return std::abs(segment.along.dot(axis.outward)) < Real(0.17);
}

/// How far a segment may lie beside an edge and still touch all along it, by how fast it leaves the
/// edge. At a twentieth of the radius the round side has parted by a thousandth of it.
template <class Real>
Real beside_edge(const CapsuleSegment<Real>& segment, Real slope)
{
    const Real widest = Real(0.05) * segment.convex_radius + Real(1e-4) * segment.half;
    return widest * std::max(Real(0), 1 - 10 * std::abs(slope));
}

/// Adds one point, of which the manifold's normal is known: 0 and 1 name the ends, 2 what lies
/// between.
template <class Real>
void add_capsule_point(const CapsuleSegment<Real>& segment,
                       const CapsuleAxis<Real>& axis,
                       LocalManifold<Real>& out)
{
    const Real separation = axis.separation - segment.convex_radius;
    const std::uint32_t feature = axis.at == -segment.half ? 0 : axis.at == segment.half ? 1 : 2;
    out.add(Vec3T<Real>(0, 0, axis.at) + out.normal * (segment.radius + separation / 2), separation,
            feature);
}

/// Adds both ends of a stretch, named as the segment's own ends, so that an end that slides over an
/// edge stays the same point. False, and none, where the stretch is short or has no part in the
/// nearest point.
template <class Real>
bool add_capsule_ends(const CapsuleSegment<Real>& segment,
                      const CapsuleAxis<Real>& axis,
                      const SegmentRange<Real>& range,
                      Real noise,
                      Real speculative_margin,
                      LocalManifold<Real>& out)
{
    // Shorter, two points hold no better than one; a segment across an edge ends here beyond ten
    // degrees.
    const Real shortest = Real(0.5) * segment.radius + Real(0.01) * segment.half;
    if (!(range.high - range.low > shortest)) return false;
    const Real at_low = range.height + range.climb * range.low;
    const Real at_high = range.height + range.climb * range.high;
    if (!(std::min(at_low, at_high) <= axis.separation + 4 * noise)) return false;
    const auto add = [&](Real at, Real height, std::uint32_t feature) {
        const Real separation = std::max(height, axis.separation) - segment.convex_radius;
        if (!(separation <= speculative_margin)) return;
        out.add(Vec3T<Real>(0, 0, at) + out.normal * (segment.radius + separation / 2), separation,
                feature);
    };
    add(range.low, at_low, 0);
    add(range.high, at_high, 1);
    return out.count > 0;
}

}  // namespace throng
