// Direction sweep: how deep two convex shapes overlap, by trying directions.
//
// An answer sheet: slow, and it knows nothing of a shape but how far it reaches.
#pragma once

#include "throng/math.hpp"

#include <functional>

namespace throng {

/// Greatest direction . x over the points of a shape, for a unit direction.
using Extent = std::function<double(const Vec3&)>;

/// The greatest separation along any of the directions tried: below 0 minus the depth of overlap,
/// above 0 the distance. Never above the truth but for rounding; below it by what the search left.
///
///   a, b     in one frame
///   grid     directions on each side of a cube, squared and times six, to begin with
///   normal   the direction, unit, from a to b; may be null
double sweep_directions(const Extent& a, const Extent& b, int grid, Vec3* normal);

}  // namespace throng
