#include "scene/shapes/level_set.hpp"

#include "cooking/cache/file_checksum.hpp"
#include "cooking/fields/field_values.hpp"
#include "cooking/fields/voxel_field.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "cooking/repair/mesh_health.hpp"
#include "kernels/geometry/mesh.hpp"

#include <algorithm>

namespace throng {
namespace {

LevelSetResult refused(std::string trouble) { return {nullptr, std::move(trouble)}; }

// The surface is made of the field wherever that comes from, so that a file gives the bits of what
// was written to it.
LevelSetResult with_surface(VoxelBricks field, double error)
{
    MeshResult surface = field_surface(field);
    if (!surface.trouble.empty()) return refused("has no surface; wanted values of both signs");
    auto made = std::make_shared<LevelSet>();
    made->surface = std::move(surface.mesh);
    // Values on both sides of a surface are about a voxel apart; where it is cut off, far more.
    made->whole = widest_separation(field) <= 3 * field.voxel && is_closed(made->surface);
    made->field = std::move(field);
    made->error = error;
    return {std::move(made), {}};
}

}  // namespace

LevelSetFacts facts_of(const LevelSet& level_set)
{
    Box3 bounds;
    for (const Vec3& vertex : level_set.surface.vertices) bounds = joined(bounds, {vertex, vertex});
    return {level_set.field.voxel, level_set.error, level_set.whole, bounds,
            level_set.surface.triangles.size()};
}

LevelSetResult read_level_set(std::string bytes)
{
    if (check_checksum(bytes) == ChecksumState::broken)
        return refused("is damaged, by its checksum; wanted it as it was written");
    VdbFile file = read_vdb_bytes(std::move(bytes), VdbWants::bricks);
    if (!file.trouble.empty()) return refused(std::move(file.trouble));
    return with_surface(std::move(file.bricks), file.notes.error);
}

LevelSetResult make_level_set(const std::vector<Vec3>& vertices,
                              const std::vector<std::array<std::uint32_t, 3>>& triangles,
                              double voxel,
                              double band)
{
    RepairedMesh repaired = repair(vertices, triangles);
    if (!repaired.trouble.empty()) return refused(std::move(repaired.trouble));
    FieldSettings wanted;
    wanted.voxel = voxel > 0 ? voxel : voxel_size_for(repaired.mesh);
    wanted.sign = repaired.health.sound() ? FieldSign::normals : FieldSign::flood;
    wanted.band = std::max(kBandVoxels, band / wanted.voxel);
    FieldResult field = build_field(repaired.mesh, wanted);
    if (!field.trouble.empty()) return refused(std::move(field.trouble));
    return with_surface(std::move(field.bricks), field.error);
}

std::string write_level_set(const LevelSet& level_set, const std::string& path)
{
    FieldNotes notes;
    notes.error = level_set.error;
    std::string trouble = write_vdb(path, level_set.field, notes);
    if (trouble.empty() && !append_checksum(path)) trouble = path + ": cannot be written";
    return trouble;
}

bool same_level_set(const LevelSet& a, const LevelSet& b)
{
    const VoxelBricks &x = a.field, &y = b.field;
    return x.origin == y.origin && x.voxel == y.voxel && x.band == y.band && x.bricks == y.bricks
        && x.brick_of == y.brick_of && x.values == y.values;
}

}  // namespace throng
