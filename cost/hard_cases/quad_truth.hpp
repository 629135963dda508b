// Quad truth: how far apart two polytopes are, tried exhaustively in four times the digits.
//
// The answer sheet of the convex cases. It knows no method, no topology but that of the solids, and
// leaves nothing out: depth is the best of every face normal and every edge by every edge, distance
// the least of every vertex, edge and face against every other. A hundred and thirteen bits leave
// some thirty digits, so that what is compared with it is compared with the truth.
#pragma once

#include "throng/math.hpp"

#include <array>
#include <span>
#include <vector>

namespace throng {

__extension__ using Quad = __float128;  // no keyword of the standard, hence the first word

struct QuadVec {
    Quad x = 0, y = 0, z = 0;
};

/// A turn and a place in quadruple precision.
struct QuadPose {
    std::array<QuadVec, 3> rows;
    QuadVec position;

    /// The quaternion is made one of unit length; places are told from `origin`.
    explicit QuadPose(const Pose& pose, const Vec3& origin = Vec3::Zero());
    /// As given: nothing is made orthogonal.
    QuadPose(const Mat3& turn, const Vec3& place);
};

/// A convex polyhedron in the world. Of the lists, more than is needed does no harm: an axis that
/// is no face normal parts no further, and a triangle inside is no nearer.
///
///   normals     not of unit length; each stands for both ways
///   directions  of edges, each once
struct QuadSolid {
    std::vector<QuadVec> corners, normals, directions;
    std::vector<std::array<std::uint16_t, 2>> segments;
    std::vector<std::array<std::uint16_t, 3>> triangles;
};

QuadSolid quad_box(const Vec3& half_extents, const QuadPose& pose);

/// The hull of a few points, which must enclose a volume: every three are a face, every two an
/// edge. Takes time with the fourth power of their number.
QuadSolid quad_cloud(std::span<const Vec3> points, const QuadPose& pose);

/// separation: the distance; below 0 minus the least move that parts them. normal: unit, from a to
/// b, of the best axis, which is that of the distance where they touch alone.
struct QuadTruth {
    double separation = 0;
    Vec3 normal = Vec3::UnitZ();
};
QuadTruth quad_truth(const QuadSolid& a, const QuadSolid& b);

/// How far apart the two lie along a direction from a to b, made one of unit length.
double quad_separation_along(const QuadSolid& a, const QuadSolid& b, const Vec3& direction);

/// How far a point is beyond the furthest face; below 0 inside.
double quad_outside(const QuadSolid& solid, const Vec3& point);

}  // namespace throng
