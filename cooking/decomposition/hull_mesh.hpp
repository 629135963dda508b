// Hull mesh: a hull as triangles, for those who need its volume or its distance and no contacts.
#pragma once

#include "kernels/data/mesh.hpp"

#include <cstddef>
#include <span>

namespace throng {

/// Triangles counter-clockwise seen from outside. Empty where the points enclose no volume.
struct HullMesh {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Vec3> normals;    // [triangles] unit, outward
    std::vector<double> offsets;  // [triangles] normal . x
    double volume = 0;            // m^3

    bool empty() const { return triangles.empty(); }
};

/// The hull of the points; the same points in the same order give the same bits.
HullMesh hull_mesh(std::span<const Vec3> points);

/// How far a point is above the plane of the face that it is highest above; below 0 inside.
double height_above(const HullMesh& hull, const Vec3& point);

/// How far a point is outside of a hull; 0 inside.
double distance_outside(const HullMesh& hull, const Vec3& point);

/// The hull of some of a hull's vertices, chosen one after the other as those that stick out
/// furthest, until none does by more than `enough` or there are `most`. At most `most` vertices and
/// at least 26; what has no more than that is left as it is.
HullMesh simplified(const HullMesh& hull, std::size_t most, double enough);

/// The same, of a hull with few vertices too: what lies along its edges and faces is left out.
HullMesh thinned(const HullMesh& hull, std::size_t most, double enough);

/// Corners of a triangle in turn, the two that are furthest apart first.
std::array<Vec3, 3> longest_edge_first(const std::array<Vec3, 3>& corners);

/// How far the surface of a hull is outside of a mesh at the most.
///
///   least   m, that far outside a point was found
///   bound   m, no point is further outside
///   where   the point found
struct Overhang {
    double least = 0, bound = 0;
    Vec3 where = Vec3::Zero();
};

/// How triangles are cut to look into them: in four, which finds what is furthest out with few
/// looks, or in two across their longest edge and with balls in the mesh to measure from, which
/// proves with fewer that nothing is, where they are long or lie along the surface.
enum class FacetCut { in_four, in_two };

/// Looks for the overhang by cutting triangles where they may still reach further outside than what
/// was found, the most promising first.
///
///   slack   m, wanted difference of the two answers
///   enough  m, triangles that reach no further outside need not be looked into
///   looks   the most points to look at, apart from one for each triangle
Overhang find_overhang(const Mesh& mesh,
                       const HullMesh& hull,
                       double slack,
                       double enough,
                       std::size_t looks,
                       FacetCut cut = FacetCut::in_four);

}  // namespace throng
