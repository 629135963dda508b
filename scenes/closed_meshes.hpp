// Closed meshes: shapes with holes, threads and hollows, made by formula.
//
// All are closed, turned outward and in meters. More triangles follow the smooth shape more
// closely.
#pragma once

#include "kernels/math/types.hpp"

#include <array>
#include <vector>

namespace throng {

struct TriangleSoup {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Twelve triangles.
TriangleSoup box_mesh(const Vec3& half_extents);

/// Rings along z from pole to pole; at least 3 by 2.
TriangleSoup ball_mesh(double radius, std::uint32_t around, std::uint32_t rings);

/// About z: a tube of radius `tube`, its middle `ring` from the axis; at least 3 by 3.
TriangleSoup torus_mesh(double ring, double tube, std::uint32_t around, std::uint32_t across);

}  // namespace throng
