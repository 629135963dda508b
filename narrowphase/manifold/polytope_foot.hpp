// Polytope foot: what more of a polytope bears it on a face than the one side that it shows to it.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "kernels/geometry/polytope_contacts.hpp"

namespace throng {

/// Whether steps are long for a body with such a ball inside: its speculative margin, m, or the
/// separation of its deepest point, m, come near the ball's radius, m.
bool is_long_step(double speculative_margin, double deepest, double inner_radius);

/// Spreads a manifold along a face of a over more corners of b, where b does not stand on what it
/// has and steps are long for its size: of the manifold's points and b's corners over the face,
/// four that the step may bring down or that have sunk in. A body of many small faces tips from one
/// to the next within a step, and would sink in a little with each.
///
///   face      of a, along whose normal the manifold is, in a's frame
///   manifold  in a's frame
void spread_foot(const PolytopePair& pair,
                 std::uint16_t face,
                 double speculative_margin,
                 LocalManifold<double>& manifold);

}  // namespace throng
