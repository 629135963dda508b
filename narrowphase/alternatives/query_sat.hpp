// SAT as a method: the axes that could part two polytopes, the likely ones first.
#pragma once

#include "narrowphase/alternatives/convex_methods.hpp"

namespace throng {

/// Touch and depth of two polytopes.
///
/// `plain` is polytope_separation() of separating_axes.hpp. The others look at the faces that the
/// balls inside the two do not rule out, by climbing, and at the edges that meet on the Gauss map;
/// they stop at the first axis that parts the two, so that a separation above 0 is not the best.
/// `cached` begins with the axis that was best in the last step, by its features: while it parts
/// the two it costs one climb from the vertex known. Rounds are the sets of axes gone through: the
/// one remembered, the likely ones, faces of a, faces of b, edges. Thread-local scratch.
///
/// Source: Gregorius, The Separating Axis Test between Convex Polyhedra (GDC 2013).
MethodAnswer query_sat(const ConvexPair& pair,
                       double speculative_margin,
                       MethodStart start,
                       MethodMemory& memory);

}  // namespace throng
