// Edge over a face: what holds a face that lies on an edge a little out of true.
//
// Where a plate lies on a ridge, and leans by more than makes its face the axis that leads, the
// ridge crosses an edge of the plate: one point, at the end that is deepest. Held there alone the
// plate turns about it until the other end is deepest, and so on: it rocks for ever, and sinks in a
// little with each turn. So both ends of what of the ridge is over the face are told.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "kernels/geometry/polytope_contacts.hpp"

namespace throng {

/// Cosine from which the axis of two edges that cross is all but that of a face: 8 degrees.
inline constexpr double kAllButFace = 0.99;

/// Of the two faces beside an edge the flat one that looks most along a direction.
///
///   cosine  of the angle between the two; -2 where neither is flat
std::uint16_t
face_beside(const PolytopeView& shape, std::uint16_t edge, const Vec3& direction, double& cosine);

/// Makes two points of the one where two edges cross, if their axis is all but that of a face that
/// one of them borders: the ends of what of the other is over that face, if both are within the
/// margin. The normal stays.
///
///   half_a, half_b      m, half extents of two boxes
///   turn, shift         b's axes and center, m, in a's frame
///   speculative_margin  m
///   manifold            in a's frame
template <class Real>
void lay_edge_over_face(const Vec3T<Real>& half_a,
                        const Vec3T<Real>& half_b,
                        const Mat3T<Real>& turn,
                        const Vec3T<Real>& shift,
                        Real speculative_margin,
                        LocalManifold<Real>& manifold);

/// The same of two polytopes, whose edges are known.
void lay_edge_over_face(const PolytopePair& pair,
                        std::uint16_t edge_a,
                        std::uint16_t edge_b,
                        double speculative_margin,
                        LocalManifold<double>& manifold);

}  // namespace throng
