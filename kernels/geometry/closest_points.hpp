// Closest points: point, segment and triangle against one another.
//
// Segments of no length and triangles of no area are what they look like: points and segments.
// Results are in the frame the arguments are given in. Instantiated for float and double.
#pragma once

#include "throng/math.hpp"

#include <array>

namespace throng {

template <class Real>
struct Segment {
    Vec3T<Real> from, to;
};

/// point = from + at * (to - from), at in [0, 1].
template <class Real>
struct SegmentPoint {
    Vec3T<Real> point;
    Real at;
};

template <class Real>
SegmentPoint<Real> closest_on_segment(const Vec3T<Real>& point, const Segment<Real>& segment);

/// Where on a triangle a point lies. Edges are numbered as in a mesh: 0 is v0-v1, 1 is v1-v2,
/// 2 is v2-v0.
enum class TriangleRegion : std::uint8_t { face, edge0, edge1, edge2, vertex0, vertex1, vertex2 };

/// The edges that a place on the rim is on: at a corner both, else the same twice. Not of the face.
inline std::array<std::size_t, 2> edges_at(TriangleRegion where)
{
    const auto region = static_cast<std::size_t>(where);
    if (region > 3) return {(region - 2) % 3, region - 4};
    return {region - 1, region - 1};
}

/// point = weights[0] v0 + weights[1] v1 + weights[2] v2; weights at least 0, of sum 1.
template <class Real>
struct TrianglePoint {
    Vec3T<Real> point, weights;
    TriangleRegion region;
};

template <class Real>
TrianglePoint<Real> closest_on_triangle(const Vec3T<Real>& point,
                                        const Vec3T<Real>& v0,
                                        const Vec3T<Real>& v1,
                                        const Vec3T<Real>& v2);

/// on_a is at_a of the way along a, on_b is at_b of the way along b.
template <class Real>
struct ClosestPoints {
    Vec3T<Real> on_a, on_b;
    Real at_a, at_b;
};

/// Closest points of two segments.
///
/// Parallel segments have many closest pairs; the one nearest a.from is returned, so that a rod
/// lying on another does not jump from step to step.
template <class Real>
ClosestPoints<Real> closest_points(const Segment<Real>& a, const Segment<Real>& b);

}  // namespace throng
