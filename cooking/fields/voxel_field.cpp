#include "cooking/fields/voxel_field.hpp"

#include "cooking/fields/field_module.hpp"
#include "cooking/fields/field_values.hpp"
#include "cooking/short_text.hpp"
#include "kernels/check.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/voxel_bricks.hpp"
#include "kernels/parallel/blocks.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

constexpr int kCells = VoxelBricks::kCells;

struct Worth {
    double error = 0;      // m
    double thin_area = 0;  // of all, where half a voxel below the surface is outside already
};

// Where a flood told the inside, normals may look either way, and what is on either side counts.
Worth worth_of(const Mesh& mesh, const VoxelBricks& bricks, FieldSign sign)
{
    constexpr std::size_t kGrain = 1024;
    struct Part {
        double error = 0, thin = 0, all = 0;
    };
    std::vector<Part> parts(block_count(mesh.triangles.size(), kGrain));
    for_each_block(
        mesh.triangles.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
            Part& part = parts[block];
            const auto off = [&](const Vec3& at) {
                part.error =
                    std::max(part.error, std::abs(sample_bricks<double>(bricks, at).distance));
            };
            for (std::size_t i = begin; i < end; ++i) {
                const auto& [a, b, c] = mesh.triangles[i];
                const Vec3 &va = mesh.vertices[a], &vb = mesh.vertices[b], &vc = mesh.vertices[c];
                const Vec3 middle = (va + vb + vc) / 3;
                for (const Vec3& at : {va, vb, vc, middle}) off(at);
                const double area = (vb - va).cross(vc - va).norm();
                const Vec3 up = mesh.normals[i] * (bricks.voxel / 2);
                const auto inside = [&](const Vec3& at) {
                    return sample_bricks<double>(bricks, at).distance < 0;
                };
                part.all += area;
                const bool thick =
                    inside(middle - up) || (sign != FieldSign::normals && inside(middle + up));
                if (!thick) part.thin += area;
            }
        });
    Worth worth;
    double thin = 0, all = 0;
    for (const Part& part : parts) {
        worth.error = std::max(worth.error, part.error);
        thin += part.thin;
        all += part.all;
    }
    worth.thin_area = all > 0 ? thin / all : 0;
    return worth;
}

std::string trouble_with_size(const Mesh& mesh, double voxel, const FieldSettings& settings)
{
    if (!(voxel > 0) || !std::isfinite(voxel))
        return "voxel_size is " + short_text(voxel) + " m; give a positive one";
    // Bricks and their values are counted in 32 bits.
    const double limit = std::min(settings.most_bytes, 8e9);
    const double bytes = field_bytes(mesh, voxel, settings.band);
    if (bytes <= limit) return {};
    double low = voxel, high = 2 * longest_side(mesh);
    for (int i = 0; i < 60 && high > low * 1.001; ++i) {
        const double middle = std::sqrt(low * high);
        (field_bytes(mesh, middle, settings.band) > limit ? low : high) = middle;
    }
    constexpr double kMega = 1024.0 * 1024;
    return "voxel field would need " + short_text(bytes / kMega) + " MB at voxel size "
        + short_text(voxel) + " m, more than the limit of " + short_text(limit / kMega)
        + " MB; give voxel_size at least " + short_text(high * 1.01);
}

// Where hardly anything is inside, a value here and there may still be.
std::string trouble_with_inside(const VoxelBricks& bricks, const Worth& worth)
{
    // A hole of a voxel leaves values of three between them at the most.
    if (widest_separation(bricks) > 3 * bricks.voxel)
        return "is open wider than a voxel of " + short_text(bricks.voxel)
            + " m, so that nothing tells its inside; give a closed mesh, or a greater voxel_size";
    if (count_inside(bricks) > 0 && worth.thin_area < 0.5) return {};
    return "nothing is inside at voxel size " + short_text(bricks.voxel)
        + " m: the mesh is thinner than a voxel nearly everywhere, or open wider than one; give a "
          "closed mesh, a smaller voxel_size where it is thin or a greater one where it is open";
}

}  // namespace

double voxel_size_for(const Mesh& mesh, double error)
{
    if (error > 0) return error / kWorstVoxels;
    return longest_side(mesh) / 48;
}

// All bricks of the box are named; those are stored that the band or the inside reach into. Making
// them takes a working copy with a triangle and a state for each value, and a tree near the surface
// with its points.
double field_bytes(const Mesh& mesh, double voxel, double band_voxels)
{
    const Box3 box = box_of(mesh);
    const double side = kCells * voxel, band = band_voxels * voxel;
    double all = 1, volume = 0, area = 0;
    for (int k = 0; k < 3; ++k) all *= (box.upper[k] - box.lower[k] + 2 * band) / side + 2;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 &va = mesh.vertices[a], &vb = mesh.vertices[b], &vc = mesh.vertices[c];
        area += 0.5 * (vb - va).cross(vc - va).norm();
        volume += va.dot(vb.cross(vc)) / 6;
    }
    const double reached = (std::abs(volume) + area * (band + 1.5 * side)) / (side * side * side);
    const double stored = std::min(all, reached + 8);
    constexpr double kStored = 4.0 * VoxelBricks::kValues, kWorking = 9.0 * 512;
    const double near_bytes = 48 * 4 * area / (voxel * voxel);
    return 8 * all + stored * (2 * kStored + 2 * kWorking) + near_bytes;
}

FieldResult build_field(const Mesh& mesh, const FieldSettings& wanted)
{
    THRONG_CHECK(mesh.vertex_normals.size() == mesh.vertices.size(), "a side needs vertex normals");
    FieldResult result;
    FieldSettings settings = wanted;
    if (settings.sign == FieldSign::sheet) settings.band += 1;  // which thickening it takes
    const double voxel = settings.voxel != 0 ? settings.voxel : voxel_size_for(mesh);
    result.trouble = trouble_with_size(mesh, voxel, settings);
    if (!result.trouble.empty()) return result;

    const OpenedFieldModule& opened = field_module();
    if (opened.module == nullptr) {
        result.trouble = opened.trouble;
        return result;
    }
    const VoxelBricks laid = lay_bricks(box_of(mesh), voxel, settings.band * voxel);
    result.bricks = opened.module->fill(mesh, laid, settings.sign);

    const Worth worth = worth_of(mesh, result.bricks, settings.sign);
    result.trouble = trouble_with_inside(result.bricks, worth);
    if (!result.trouble.empty()) {
        result.bricks = {};
        result.hollow = true;
        return result;
    }
    result.error = worth.error;
    if (worth.thin_area > 0)
        result.warnings.push_back(
            "thinner than a voxel somewhere: " + short_text(100 * worth.thin_area)
            + " % of the surface; what is there is lost or blunted at voxel size "
            + short_text(voxel) + " m, give voxel_size " + short_text(voxel / 2)
            + " or less to keep more of it");
    return result;
}

MeshResult field_surface(const VoxelBricks& bricks)
{
    const OpenedFieldModule& opened = field_module();
    if (opened.module != nullptr) return opened.module->surface(bricks);
    MeshResult none;
    none.trouble = opened.trouble;
    return none;
}

std::string
write_vdb(const std::filesystem::path& path, const VoxelBricks& bricks, const FieldNotes& notes)
{
    const OpenedFieldModule& opened = field_module();
    if (opened.module != nullptr) return opened.module->write(path, bricks, notes);
    return path.string() + ": " + opened.trouble;
}

VdbFile read_vdb(const std::filesystem::path& path, VdbWants wants)
{
    const OpenedFieldModule& opened = field_module();
    if (opened.module != nullptr) return opened.module->read(path, wants);
    VdbFile none;
    none.trouble = path.string() + ": " + opened.trouble;
    return none;
}

VdbFile read_vdb_bytes(std::string bytes, VdbWants wants)
{
    const OpenedFieldModule& opened = field_module();
    if (opened.module != nullptr) return opened.module->read_bytes(std::move(bytes), wants);
    VdbFile none;
    none.trouble = opened.trouble;
    return none;
}

}  // namespace throng
