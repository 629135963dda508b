// Edge on edge: what holds two edges that lie along one another.
//
// Any direction that looks away from all four of their faces parts two such edges about as well as
// another. The axis that parts them best is the normal of one of these faces, by a hair, and which
// of them by chance: planks that lean on one another, and need no friction to, would slide apart.
// And nothing is left of one face over the other by the time that the edges are a hair apart.
// Edges rounded by a little, as every real one is, tell which way they press.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "kernels/geometry/polytope_contacts.hpp"

namespace throng {

/// Of the least half extent, or the ball inside: how far the edges of both are rounded.
inline constexpr double kRounded = 0.05;

/// Cosine from which edges are along one another: a fortieth of a radian.
inline constexpr double kEdgesAlong = 0.9997;

/// Whether a manifold is no wider than a width, m, across some line: then its middle, and the line.
template <class Real>
bool is_strip(const LocalManifold<Real>& manifold,
              Real width,
              Vec3T<Real>& middle,
              Vec3T<Real>& along);

/// Makes a manifold of what two edges that lie along one another have side by side, by the normal
/// that they would have if they were rounded: of two boxes, of which all axes are known to be
/// within the margin, where their manifold is a strip, or where clipping has left nothing.
///
/// Left as it is where rounded edges would touch at a face of either; where faces of both lie on
/// one another, as what bears a beam by an inch bears it straight, and cubes of a wall do not wedge
/// their neighbours apart; and where the edges are beyond the margin.
template <class Real>
void meet_edge_on_edge(const Vec3T<Real>& half_a,
                       const Vec3T<Real>& half_b,
                       const Mat3T<Real>& turn,
                       const Vec3T<Real>& shift,
                       Real speculative_margin,
                       LocalManifold<Real>& manifold);

/// A face of one of two polytopes, whose axis parts them best.
struct LeadingFace {
    std::uint32_t face = ~std::uint32_t{0};  // none
    bool of_b = false;
};

/// The same of two polytopes; where clipping has left nothing, one of the leading face.
void meet_edge_on_edge(const PolytopePair& pair,
                       const LeadingFace& leading,
                       double speculative_margin,
                       LocalManifold<double>& manifold);

}  // namespace throng
