// Sphere error: how far the surface of spheres taken together is from that of a mesh.
#pragma once

#include "cooking/sphere_trees/ball_tree.hpp"
#include "kernels/data/mesh.hpp"

namespace throng {

/// How far a point is from the balls taken together, m: right outside of them, and below 0 inside,
/// where their surface is at least so far. Infinite where there are none.
double distance_to_balls(std::span<const Ball> balls, const Vec3& point);

/// A bound, m: no point of the mesh's surface is further from the surface of the balls taken
/// together, no point of that further from the mesh, and no point inside the mesh further from the
/// balls. Holds for every point and not only where it was looked.
///
///   mesh   closed, with vertex normals
///   slack  as part of the answer: how much more than the least such bound it may be ...
///   looks  ... unless that takes more looks than this (about 1 microsecond each), when it is
///          looser
///   enough whether it is more is not of interest: any number from there on may be told
///
/// Triangles and the cells of an octree are split where they may hold the worst place: a value
/// that changes no faster than the place does is known in a cell to within its radius.
double sphere_error(const Mesh& mesh,
                    std::span<const Ball> balls,
                    double slack = 0.1,
                    std::size_t looks = 1000000,
                    double enough = std::numeric_limits<double>::infinity());

}  // namespace throng
