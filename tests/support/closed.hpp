// Closed: meshes made ready to be taken as solids.
#pragma once

#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "scene/catalog/closed_meshes.hpp"

namespace throng {

inline Mesh closed(const TriangleSoup& soup)
{
    MeshResult made = build_mesh(soup.vertices, soup.triangles);
    find_vertex_normals(made.mesh);
    return std::move(made.mesh);
}

/// Two soups as one.
inline TriangleSoup both(TriangleSoup a, const TriangleSoup& b)
{
    const auto first = static_cast<std::uint32_t>(a.vertices.size());
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (const auto& [i, j, k] : b.triangles)
        a.triangles.push_back({first + i, first + j, first + k});
    return a;
}

inline TriangleSoup moved(TriangleSoup soup, const Vec3& by)
{
    for (Vec3& vertex : soup.vertices) vertex += by;
    return soup;
}

inline TriangleSoup turned_inward(TriangleSoup soup)
{
    for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
    return soup;
}

}  // namespace throng
