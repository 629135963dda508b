// Closed meshes: plain shapes made by formula, and what the others are made with.
//
// All are closed, turned outward and in meters. More triangles follow the smooth shape more
// closely. Tubes along curves are in swept_meshes.hpp, bolts and nuts in threads.hpp, lumps of any
// number of triangles in noisy_balls.hpp.
#pragma once

#include "throng/scene.hpp"

namespace throng {

/// Twelve triangles.
TriangleSoup box_mesh(const Vec3& half_extents);

/// Rings along z from pole to pole; at least 3 by 2.
TriangleSoup ball_mesh(double radius, std::uint32_t around, std::uint32_t rings);

/// About z: a tube of radius `tube`, its middle `ring` from the axis; at least 3 by 3.
TriangleSoup torus_mesh(double ring, double tube, std::uint32_t around, std::uint32_t across);

/// Triangles over a grid of vertices that goes round both ways, vertex (i, k) at i * across + k.
/// They face outward where k turns from outward to what lies left of the way of i.
void close_grid(TriangleSoup& mesh, std::uint32_t around, std::uint32_t across);

}  // namespace throng
