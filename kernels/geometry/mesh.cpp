#include "kernels/geometry/mesh.hpp"

#include <algorithm>

namespace throng {

bool is_closed(const Mesh& mesh)
{
    return !mesh.adjacent.empty()
        && std::all_of(mesh.adjacent.begin(), mesh.adjacent.end(), [](const auto& adjacent) {
               return *std::min_element(adjacent.begin(), adjacent.end()) >= 0;
           });
}

const Mesh* mesh_of(const Shapes& shapes, ShapeRef shape)
{
    if (shape.kind == ShapeKind::mesh) return &shapes.meshes[shape.index];
    if (shape.kind == ShapeKind::solid) return &shapes.solids[shape.index].mesh;
    return nullptr;
}

Box3 triangle_box(const Mesh& mesh, std::uint32_t triangle)
{
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Vec3 &va = mesh.vertices[a], &vb = mesh.vertices[b], &vc = mesh.vertices[c];
    return {va.cwiseMin(vb).cwiseMin(vc), va.cwiseMax(vb).cwiseMax(vc)};
}

Box3 box_of(const Mesh& mesh) { return {mesh.tree.front().lower, mesh.tree.front().upper}; }

double longest_side(const Mesh& mesh)
{
    const Box3 box = box_of(mesh);
    return (box.upper - box.lower).maxCoeff();
}

void find_triangles(const Mesh& mesh, const Box3& box, std::vector<std::uint32_t>& found)
{
    const auto begin = static_cast<std::ptrdiff_t>(found.size());
    visit_triangles(mesh, box, [&](std::uint32_t triangle) { found.push_back(triangle); });
    std::sort(found.begin() + begin, found.end());
}

}  // namespace throng
