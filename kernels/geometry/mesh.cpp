#include "kernels/geometry/mesh.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/k_dop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

void add_triangle(const Mesh& mesh, std::uint32_t triangle, Slabs slabs, KDop& to)
{
    for (const std::uint32_t corner : mesh.triangles[triangle])
        add(mesh.vertices[corner], slabs, to);
}

Mesh::SmallBox small_box(const Box3& box, std::uint32_t first, std::uint32_t count)
{
    constexpr float kFar = std::numeric_limits<float>::infinity();
    Mesh::SmallBox small{.first = first, .count = count};
    for (std::size_t k = 0; k < 3; ++k) {
        const double lower = box.lower[static_cast<int>(k)], upper = box.upper[static_cast<int>(k)];
        small.lower[k] = static_cast<float>(lower);
        small.upper[k] = static_cast<float>(upper);
        if (double{small.lower[k]} > lower) small.lower[k] = std::nextafter(small.lower[k], -kFar);
        if (double{small.upper[k]} < upper) small.upper[k] = std::nextafter(small.upper[k], kFar);
    }
    return small;
}

// All six asked at once: which of them parts two boxes nobody can foresee.
bool may_overlap(const Mesh::SmallBox& a, const Mesh::SmallBox& b)
{
    bool together = true;
    for (std::size_t k = 0; k < 3; ++k)
        together &= (a.lower[k] <= b.upper[k]) & (b.lower[k] <= a.upper[k]);
    return together;
}

void begin(TriangleSearch& search)
{
    search.small = small_box(search.box, 0, 0);
    search.found.clear();
    search.count = 0;
    const Mesh& mesh = *search.mesh;
    if (!mesh.small_tree.empty() && may_overlap(search.small, mesh.small_tree[0]))
        search.waiting[search.count++] = 0;
}

// Looks at one node; false where none is left. What is needed next is asked for of memory.
bool go_on(TriangleSearch& search)
{
    if (search.count == 0) return false;
    const Mesh& mesh = *search.mesh;
    const Mesh::SmallBox& node = mesh.small_tree[search.waiting[--search.count]];
    if (node.count == 0) {
        for (const std::uint32_t place : {node.first + 1, node.first}) {
            const Mesh::SmallBox& child = mesh.small_tree[place];
            if (!may_overlap(search.small, child)) continue;
            search.waiting[search.count++] = place;
            const bool inner = child.count == 0;
            const auto& ahead = inner ? mesh.small_tree : mesh.small_boxes;
            __builtin_prefetch(&ahead[child.first]);
            __builtin_prefetch(&ahead[child.first + (inner ? 1 : child.count - 1)]);
        }
        return true;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const Mesh::SmallBox& small = mesh.small_boxes[i];
        if (!may_overlap(search.small, small)) continue;
        search.found.push_back(small.first);
        __builtin_prefetch(&mesh.triangles[small.first]);
        __builtin_prefetch(&mesh.normals[small.first]);
    }
    return true;
}

void ask_for_corners(const Mesh& mesh, std::uint32_t triangle)
{
    for (const std::uint32_t corner : mesh.triangles[triangle])
        __builtin_prefetch(&mesh.vertices[corner]);
    __builtin_prefetch(&mesh.adjacent[triangle]);
    __builtin_prefetch(&mesh.convex_edges[triangle]);
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

void add_small_boxes(Mesh& mesh)
{
    mesh.small_tree.clear();
    for (const Mesh::Node& node : mesh.tree)
        mesh.small_tree.push_back(small_box({node.lower, node.upper}, node.first, node.count));
    mesh.small_boxes.clear();
    for (const std::uint32_t triangle : mesh.order)
        mesh.small_boxes.push_back(small_box(triangle_box(mesh, triangle), triangle, 1));
}

void find_triangles(const Mesh& mesh, const Box3& box, std::vector<std::uint32_t>& found)
{
    static thread_local TriangleSearch search;
    search.mesh = &mesh;
    search.box = box;
    find_triangles({&search, 1});
    found.insert(found.end(), search.found.begin(), search.found.end());
}

// Small boxes tell nearly all that are apart; those that are left are asked exactly.
void find_triangles(std::span<TriangleSearch> searches)
{
    for (TriangleSearch& search : searches) begin(search);
    for (bool on = true; on;) {
        on = false;
        for (TriangleSearch& search : searches) on |= go_on(search);
    }
    for (TriangleSearch& search : searches)
        for (const std::uint32_t triangle : search.found) ask_for_corners(*search.mesh, triangle);
    for (TriangleSearch& search : searches) {
        std::erase_if(search.found, [&](std::uint32_t triangle) {
            return !search.box.overlaps(triangle_box(*search.mesh, triangle));
        });
        std::sort(search.found.begin(), search.found.end());
    }
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
