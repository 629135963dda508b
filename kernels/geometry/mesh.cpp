#include "kernels/geometry/mesh.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/k_dop.hpp"

#include <algorithm>

namespace throng {

namespace {

void add_triangle(const Mesh& mesh, std::uint32_t triangle, Slabs slabs, KDop& to)
{
    for (const std::uint32_t corner : mesh.triangles[triangle])
        add(mesh.vertices[corner], slabs, to);
}

}  // namespace

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

void bound_by_k_dops(Mesh& mesh, int k)
{
    const Slabs slabs = slabs_of(k);
    mesh.sides = k;
    mesh.k_dops.assign(mesh.tree.size(), empty_k_dop(slabs));
    // Children stand behind their parents.
    for (std::size_t i = mesh.tree.size(); i-- > 0;) {
        const Mesh::Node& node = mesh.tree[i];
        KDop& dop = mesh.k_dops[i];
        for (std::uint32_t t = node.first; t < node.first + node.count; ++t)
            add_triangle(mesh, mesh.order[t], slabs, dop);
        if (node.count > 0) continue;
        add(mesh.k_dops[node.first], slabs, dop);
        add(mesh.k_dops[node.first + 1], slabs, dop);
    }
}

void find_triangles(const Mesh& mesh,
                    const Box3& box,
                    const KDop& k_dop,
                    double speculative_margin,
                    std::vector<std::uint32_t>& found)
{
    THRONG_CHECK(mesh.k_dops.size() == mesh.tree.size(), "the mesh has its k-DOPs");
    const Slabs slabs = slabs_of(mesh.sides);
    const auto is_near = [&](const KDop& other) {
        return parting_slab(k_dop, other, slabs, speculative_margin) == slabs.end;
    };
    const auto begin = static_cast<std::ptrdiff_t>(found.size());
    visit_nodes(
        mesh,
        [&](const Mesh::Node& node) {
            const auto place = static_cast<std::size_t>(&node - mesh.tree.data());
            return box.overlaps({node.lower, node.upper}) && is_near(mesh.k_dops[place]);
        },
        [&](std::uint32_t triangle) {
            if (!box.overlaps(triangle_box(mesh, triangle))) return;
            KDop dop = empty_k_dop(slabs);
            add_triangle(mesh, triangle, slabs, dop);
            if (is_near(dop)) found.push_back(triangle);
        });
    std::sort(found.begin() + begin, found.end());
}

}  // namespace throng
