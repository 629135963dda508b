// Image views: a pair's shapes drawn three times, along each axis of the frame of the one.
//
// The rays stay where they are in that frame whatever the other does, so what they meet of the one
// can be drawn ahead of time.
#pragma once

#include "kernels/data/bounds.hpp"
#include "kernels/geometry/depth_image.hpp"

namespace throng {

/// Rays along the longest side of the smaller of a pair, where neither says.
inline constexpr int kAutoRays = 32;

/// The most rays along a side, whatever is asked for.
inline constexpr int kMostRays = 512;

/// One for each axis, which is what its rays run along; the next axis in the circle is x to them,
/// the one after that y.
using ThreeGrids = std::array<RayGrid, 3>;
using ThreeImages = std::array<DepthImage*, 3>;

constexpr int across(int axis) { return (axis + 1) % 3; }
constexpr int upward(int axis) { return (axis + 2) % 3; }

/// The axes in a circle, so that `axis` becomes z: exactly, to the last bit.
Pose turned_to(int axis);

/// m, from one ray to the next: the same for a pair, whatever the pose of the other, which is what
/// makes ids last.
double pixel_of(const Shapes& shapes, ShapeRef solid, ShapeRef other);

/// The rays through a box in the solid's frame, at halves of a pixel from its origin.
ThreeGrids grids_through(const Box3& box, double pixel);

/// Draws a shape of any kind but a lone triangle.
///
///   in_a  its pose in the solid's frame
void draw_along_axes(const Shapes& shapes,
                     ShapeRef shape,
                     const Pose& in_a,
                     const ThreeGrids& grids,
                     const ThreeImages& images,
                     Layers layers,
                     double thickness);

/// The same of the solid itself: taken from its layers, where it has some for these rays.
void draw_own(const Shapes& shapes,
              ShapeRef solid,
              const ThreeGrids& grids,
              const ThreeImages& images);

/// What rays meet of a solid that stands alone or is the smaller of a pair: Solid::layers. Empty
/// where so many rays are asked for that they would take some MB.
std::array<RayLayers, 3> layers_of(const Solid& solid);

}  // namespace throng
