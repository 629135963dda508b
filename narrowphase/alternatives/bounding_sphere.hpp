// Bounding ball: a ball round each shape, as a filter: it says `apart` or nothing.
#pragma once

#include "kernels/geometry/ball.hpp"
#include "narrowphase/alternatives/convex_methods.hpp"

namespace throng {

/// The ball round a shape, in the shape's frame: that of the hull about its center, of all others
/// the least about their middle.
Ball ball_round(const ConvexCore<double>& core);

/// The filter as a method: `apart` with the normal from center to center, or `undecided`. Never
/// `apart` of what touches: the balls are widened by more than their rounding.
MethodAnswer query_bounding_sphere(const ConvexPair& pair,
                                   double speculative_margin,
                                   MethodStart start,
                                   MethodMemory& memory);

}  // namespace throng
