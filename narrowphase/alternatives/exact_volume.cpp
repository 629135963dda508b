#include "narrowphase/alternatives/exact_volume.hpp"

#include "kernels/geometry/cut_polyhedron.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/support.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace throng {
namespace {

using Triangle = std::array<Vec3, 3>;

std::vector<Triangle> triangles_of(const Shapes& shapes, ShapeRef shape)
{
    std::vector<Triangle> triangles;
    if (const Mesh* const mesh = mesh_of(shapes, shape)) {
        for (const auto& [i, j, k] : mesh->triangles)
            triangles.push_back({mesh->vertices[i], mesh->vertices[j], mesh->vertices[k]});
        return triangles;
    }
    const PolytopeShape polytope(shapes, shape);
    const PolytopeView view = polytope.view();
    for (std::size_t face = 0; face < view.normals.size(); ++face) {
        const auto corners = view.face(face);
        for (std::size_t i = 2; i < corners.size(); ++i)
            triangles.push_back({view.vertices[corners[0]], view.vertices[corners[i - 1]],
                                 view.vertices[corners[i]]});
    }
    return triangles;
}

// A tetrahedron as a polytope; face i lies across from vertex i.
struct Tetrahedron {
    static constexpr std::array<std::uint32_t, 5> kBegin = {0, 3, 6, 9, 12};
    static constexpr std::array<std::uint16_t, 12> kCorners = {1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1};
    static constexpr std::array<Hull::Edge, 6> kEdges = {
        {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

    std::array<Vec3, 4> vertices;
    std::array<Vec3, 4> normals;
    std::array<double, 4> offsets{};
    Vec3 center;
    Box3 box;
    double sign = 1;

    // Needs: a volume that is not 0.
    Tetrahedron(const Vec3& tip, const Triangle& base, double volume)
        : vertices{tip, base[0], base[1], base[2]}, sign(volume < 0 ? -1 : 1)
    {
        if (volume < 0) std::swap(vertices[1], vertices[2]);
        center = 0.25 * (vertices[0] + vertices[1] + vertices[2] + vertices[3]);
        for (std::size_t face = 0; face < 4; ++face) {
            const Vec3& at = vertices[kCorners[3 * face]];
            const Vec3 across = (vertices[kCorners[3 * face + 1]] - at)
                                    .cross(vertices[kCorners[3 * face + 2]] - at);
            normals[face] = unit_or(across, Vec3(Vec3::UnitZ()));
            offsets[face] = normals[face].dot(at);
            box.lower = box.lower.cwiseMin(vertices[face]);
            box.upper = box.upper.cwiseMax(vertices[face]);
        }
    }
    PolytopeView view() const
    {
        PolytopeView view;
        view.vertices = vertices;
        view.normals = normals;
        view.offsets = offsets;
        view.face_begin = kBegin;
        view.face_vertices = kCorners;
        view.edges = kEdges;
        view.center = center;
        return view;
    }
};

// From the middle of the box round them. What is too flat to have a volume is left out.
std::vector<Tetrahedron> tetrahedra_of(const std::vector<Triangle>& triangles)
{
    Box3 box;
    for (const Triangle& triangle : triangles)
        for (const Vec3& corner : triangle) box = joined(box, {corner, corner});
    const Vec3 tip = 0.5 * (box.lower + box.upper);
    const double size = (box.upper - box.lower).norm();
    const double least = 16 * std::numeric_limits<double>::epsilon() * size * size * size;
    std::vector<Tetrahedron> parts;
    for (const Triangle& base : triangles) {
        const double volume = (base[0] - tip).cross(base[1] - tip).dot(base[2] - tip);
        if (std::abs(volume) > least) parts.emplace_back(tip, base, volume);
    }
    return parts;
}

// What two tetrahedra share, or nothing.
std::optional<Enclosed>
cut_out(const Tetrahedron& a, const Tetrahedron& b, double slack, CutPolyhedron& rest)
{
    rest.start(a.view(), slack, 4);
    for (std::size_t face = 0; face < 4; ++face) {
        const CutPlane plane{b.normals[face], b.offsets[face] - b.normals[face].dot(a.center)};
        if (rest.cut(plane) == CutPolyhedron::Cut::gone) return {};
    }
    return rest.enclosed();
}

double triangle_count(const Shapes& shapes, ShapeRef shape)
{
    if (const Mesh* const mesh = mesh_of(shapes, shape))
        return static_cast<double>(mesh->triangles.size());
    return static_cast<double>(triangles_of(shapes, shape).size());
}

}  // namespace

SharedVolume shared_exactly(const VolumePair& pair)
{
    std::vector<Triangle> of_b = triangles_of(pair.shapes, pair.b);
    for (Triangle& triangle : of_b)
        for (Vec3& corner : triangle) corner = pair.b_in_a * corner;
    const std::vector<Tetrahedron> a = tetrahedra_of(triangles_of(pair.shapes, pair.a));
    const std::vector<Tetrahedron> b = tetrahedra_of(of_b);
    CutPolyhedron rest;
    SharedVolume shared;
    Vec3 moment = Vec3::Zero();
    for (const Tetrahedron& one : a) {
        const double slack =
            4 * std::numeric_limits<double>::epsilon() * (one.box.upper - one.box.lower).norm();
        for (const Tetrahedron& other : b) {
            if (!one.box.overlaps(other.box)) continue;
            const std::optional<Enclosed> part = cut_out(one, other, slack, rest);
            if (!part) continue;
            const double volume = one.sign * other.sign * part->volume;
            shared.volume += volume;
            moment += volume * (part->center + one.center);
        }
    }
    if (!(shared.volume > 0)) return {};
    shared.center = moment / shared.volume;
    return shared;
}

double exact_cost(const VolumePair& pair)
{
    return triangle_count(pair.shapes, pair.a) * triangle_count(pair.shapes, pair.b);
}

}  // namespace throng
