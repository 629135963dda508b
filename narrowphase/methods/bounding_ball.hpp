// Bounding ball: a ball round each shape, as a filter: it says `apart` or nothing.
#pragma once

#include "narrowphase/methods/convex_methods.hpp"

namespace throng {

/// A ball round a shape, in the shape's frame: that of the hull about its center, of all others the
/// least about their middle.
struct Ball {
    Vec3 center = Vec3::Zero();
    double radius = 0;
};

Ball ball_round(const Core<double>& core);

/// The filter as a method: `apart` with the normal from center to center, or `undecided`. Never
/// `apart` of what touches: the balls are widened by more than their rounding.
MethodAnswer
ask_bounding_ball(const ConvexPair& pair, double reach, MethodStart start, MethodMemory& memory);

}  // namespace throng
