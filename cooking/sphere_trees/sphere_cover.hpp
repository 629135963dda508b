// Sphere cover: few balls inside a mesh that together come near to all of its surface.
#pragma once

#include "cooking/sphere_trees/ball_tree.hpp"
#include "cooking/sphere_trees/mesh_cells.hpp"

namespace throng {

/// A place that balls are to cover: on the surface (depth 0), or inside.
struct CoverPoint {
    Vec3 at = Vec3::Zero();
    double depth = 0;            // m, below the surface
    Vec3 inward = Vec3::Zero();  // unit, of those on the surface
};

/// Places all over a mesh, about as many as wanted: corners and a grid on every triangle, and those
/// inside of a grid of as many over the bounds. In an order that the mesh gives.
std::vector<CoverPoint> cover_points(const Mesh& mesh, std::size_t wanted);

/// Balls as deep as the mesh allows, no more than `count`, chosen so that the place they leave
/// furthest out is as near as may be.
///
/// The place that is furthest gets the largest ball that comes near enough to it; each ball then
/// moves to where it serves its own places best; balls whose places others nearly serve as well
/// are taken out and put where they are wanted more.
///
/// Source: after Gonzalez, Clustering to minimize the maximum intercluster distance (1985), with
///         balls in place of centers; balls within the surface as in Bradshaw and O'Sullivan,
///         Adaptive medial-axis approximation for sphere-tree construction (2004), sections 4, 5.
///
///   separation  m, out: how far the furthest of the places is from the balls, those inside counted
///               double, and no further than they are below the surface
std::vector<Ball> cover_mesh(MeshCells& cells,
                             std::span<const CoverPoint> points,
                             std::size_t count,
                             double& separation);

}  // namespace throng
