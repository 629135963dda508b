// Linear paths: when a corner meets a triangle, or an edge an edge, each corner on a straight line.
//
// The queries of deforming meshes, and of the public sets with exact answers. The root finders are
// those of time_of_impact.hpp: along a fixed direction the separation of points that move on
// straight lines is the least of straight lines, so it never bends upward and nothing is stepped
// over.
#pragma once

#include "narrowphase/ccd/time_of_impact.hpp"

#include <array>

namespace throng {

enum class PathKind : std::uint8_t { vertex_face, edge_edge };

/// Four points, where they are at time 0 and at time 1.
///
///   vertex_face  the vertex, then the corners of the triangle
///   edge_edge    the ends of one edge, then those of the other
struct LinearPaths {
    PathKind kind = PathKind::vertex_face;
    std::array<Vec3, 4> from, to;
};

/// How far numbers of this size can be off in what is worked out of them, m: an impact is looked
/// for within this at least, so that none is missed by rounding.
double rounding_of(const LinearPaths& paths);

/// When the two first touch, if they do. What touches, by exact arithmetic, at any time from 0 to 1
/// is always told to; what comes within a tolerance may be.
///
///   tolerance   m, raised to eight times rounding_of() where it is below
Impact time_of_impact(const LinearPaths& paths, ToiMethod method, double tolerance);

}  // namespace throng
