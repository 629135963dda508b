// VDB fill: which values are near a surface, found by OpenVDB; the distances are throng's own.
#include "cooking/fields/field_values.hpp"
#include "cooking/fields/openvdb/vdb.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/voxel_bricks.hpp"
#include "kernels/parallel/blocks.hpp"

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <cmath>

namespace throng::vdb {
namespace {

using openvdb::FloatGrid;
using openvdb::FloatTree;

// The mesh as OpenVDB takes it, in voxels from the grid's first value.
struct GridMesh {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
};

GridMesh on_grid(const Mesh& mesh, const VoxelBricks& laid)
{
    GridMesh made;
    for (const Vec3& vertex : mesh.vertices) {
        const Vec3 at = (vertex - laid.origin) / laid.voxel;
        made.points.emplace_back(at.x(), at.y(), at.z());
    }
    for (const auto& [a, b, c] : mesh.triangles) made.triangles.emplace_back(a, b, c);
    return made;
}

// Distances in voxels about the surface: about two each way, one at the least.
FloatGrid::Ptr near_surface(const Mesh& mesh, const VoxelBricks& laid, FieldSign sign)
{
    namespace tools = openvdb::tools;
    const GridMesh made = on_grid(mesh, laid);
    const tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(made.points,
                                                                                    made.triangles);
    int flags = tools::DISABLE_RENORMALIZATION | tools::DISABLE_NARROW_BAND_TRIMMING;
    if (sign != FieldSign::flood) flags |= tools::UNSIGNED_DISTANCE_FIELD;
    openvdb::util::NullInterrupter never;
    const auto unit = openvdb::math::Transform::createLinearTransform(1.0);
    return tools::meshToVolume<FloatGrid>(never, adapter, *unit, 2.0F, 2.0F, flags);
}

std::vector<FieldSeed> seeds_of(const FloatGrid& grid, const VoxelBricks& laid)
{
    std::vector<FieldSeed> seeds;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
        for (auto value = leaf->cbeginValueOn(); value; ++value) {
            const openvdb::Coord at = value.getCoord();
            bool held = true;
            for (int k = 0; k < 3; ++k) {
                const int bricks = laid.bricks[static_cast<std::size_t>(k)];
                held &= at[k] >= 0 && at[k] <= bricks * VoxelBricks::kCells;
            }
            if (held)
                seeds.push_back({{at[0], at[1], at[2]}, *value * static_cast<float>(laid.voxel)});
        }
    return seeds;
}

// Whether any value about a triangle is outside: else other parts of the mesh bury it.
bool exposed(const Mesh& mesh,
             std::uint32_t triangle,
             const VoxelBricks& laid,
             const openvdb::tree::ValueAccessor<const FloatTree, false>& near)
{
    const Box3 box = triangle_box(mesh, triangle);
    openvdb::Coord low, high;
    for (int k = 0; k < 3; ++k) {
        low[k] = static_cast<int>(std::floor((box.lower[k] - laid.origin[k]) / laid.voxel));
        high[k] = static_cast<int>(std::ceil((box.upper[k] - laid.origin[k]) / laid.voxel));
    }
    for (int z = low[2]; z <= high[2]; ++z)
        for (int y = low[1]; y <= high[1]; ++y)
            for (int x = low[0]; x <= high[0]; ++x)
                if (near.getValue({x, y, z}) >= 0) return true;
    return false;
}

Mesh exposed_part(const Mesh& mesh, const FloatGrid& grid, const VoxelBricks& laid)
{
    std::vector<std::uint8_t> kept(mesh.triangles.size(), 0);
    for_each_block(kept.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
        const openvdb::tree::ValueAccessor<const FloatTree, false> near(grid.tree());
        for (std::size_t i = begin; i < end; ++i)
            kept[i] = exposed(mesh, static_cast<std::uint32_t>(i), laid, near) ? 1 : 0;
    });
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t i = 0; i < kept.size(); ++i)
        if (kept[i] != 0) triangles.push_back(mesh.triangles[i]);
    if (triangles.empty() || triangles.size() == mesh.triangles.size()) return mesh;
    return build_mesh(mesh.vertices, std::move(triangles)).mesh;
}

// What lies that near to the surface becomes inside.
void thicken(VoxelBricks& bricks, double by)
{
    for (float& value : bricks.values) value -= static_cast<float>(by);
    bricks.band -= by;
}

}  // namespace

VoxelBricks fill(const Mesh& mesh, const VoxelBricks& laid, FieldSign sign)
{
    const FloatGrid::Ptr near = near_surface(mesh, laid, sign);
    const std::vector<FieldSeed> seeds = seeds_of(*near, laid);
    switch (sign) {
    case FieldSign::normals:
        return fill_bricks(mesh, laid, seeds, SeedRule::distance);
    case FieldSign::flood:
        return fill_bricks(exposed_part(mesh, *near, laid), laid, seeds, SeedRule::sign);
    case FieldSign::sheet:
        break;
    }
    VoxelBricks bricks = fill_bricks(mesh, laid, seeds, SeedRule::sheet);
    thicken(bricks, laid.voxel);
    return bricks;
}

}  // namespace throng::vdb
