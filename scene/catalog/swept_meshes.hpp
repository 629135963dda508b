// Swept meshes: round tubes along closed curves, such as knots and the links of a chain.
#pragma once

#include "scene/catalog/closed_meshes.hpp"

#include <span>

namespace throng {

/// A point of a curve, and the unit vector along which the curve goes on from there.
struct CurvePoint {
    Vec3 place = Vec3::Zero(), along = Vec3::UnitX();
};

/// A round tube about a closed curve, told by at least three points in order. Its frames turn as
/// little as they can, and what is missing to meet the first one again is shared among them all.
///
///   tube    m, radius; less than the curve's least radius of curvature and than half of the way
///           between two of its strands, or the mesh cuts itself
///   across  corners of a cross-section, at least 3; they lie on the tube, so the mesh is within
///
/// Source: Wang, Juettler, Zheng and Liu, Computation of rotation minimizing frames (2008): the
///         frame of the next point is that of the last one reflected twice.
TriangleSoup tube_mesh(std::span<const CurvePoint> curve, double tube, std::uint32_t across);

/// A knot wound on a torus about z.
///
///   longways  times round the axis of the torus, and
///   crossways times through its hole; without a common divisor
///   ring      m, from the axis to the middle of the torus
///   swing     m, radius of the torus
struct TorusKnot {
    int longways = 2, crossways = 3;
    double ring = 0, swing = 0;
};
std::vector<CurvePoint> torus_knot(const TorusKnot& knot, std::uint32_t around);

/// The middle line of a chain's link: two half circles in the x-y plane with straight sides along x
/// between them, `half_length` to either side of the middle.
///
///   bend  points of each half circle, at least 2; the sides get as many for their length
std::vector<CurvePoint> link_curve(double half_length, double radius, std::uint32_t bend);

}  // namespace throng
