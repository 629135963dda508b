// Voxel field: a mesh's signed distance on a grid, made, written and read.
//
// OpenVDB finds which values are near the surface and, where the mesh cannot be trusted, which are
// inside; the distances that are kept are throng's own. Its files are what other tools read.
#pragma once

#include "cooking/repair/build_mesh.hpp"
#include "kernels/data/solids.hpp"

#include <filesystem>
#include <string>

namespace throng {

/// How far outside of the surface distances are known unless more is asked for, in voxels.
inline constexpr double kBandVoxels = 3;
/// No trilinear value of a distance, that of anything at all, is further off than this, in voxels:
/// half the diagonal of a cell. On smooth surfaces it is h^2 / 8 times the sum of the curvatures.
inline constexpr double kWorstVoxels = 0.8660254037844387;

/// What tells inside from outside.
///
///   normals  those of the nearest triangle: right for closed meshes that do not cut themselves
///   flood    what cannot be reached from afar is inside. Mends what cuts itself, holes up to a
///            voxel and loose triangles; closed hollows are filled, and what is buried is left out
///   sheet    what lies within a voxel of any triangle is inside: for sheets, which enclose nothing
enum class FieldSign : std::uint8_t { normals, flood, sheet };

struct FieldSettings {
    double voxel = 0;  // m; 0: as voxel_size_for() has it
    FieldSign sign = FieldSign::normals;
    double band = kBandVoxels;                 // voxels; no less than this
    double most_bytes = 1024.0 * 1024 * 1024;  // that making it may take
};

/// A level set, or why there is none.
///
///   error     m, the greatest distance that the field tells of a corner or a middle of a triangle;
///             in truth all are 0
///   warnings  what a user should know, in plain words
///   trouble   empty, or what is wrong and what is wanted
///   hollow    the trouble is that nothing tells an inside
struct FieldResult {
    VoxelBricks bricks;
    double error = 0;
    std::vector<std::string> warnings;
    std::string trouble;
    bool hollow = false;
};

/// The voxel for a wanted error, m: no depth is then further off than that, edges and corners
/// included. On smooth surfaces the error is far less and of second order in the voxel. Without one
/// a 48th of the longest side.
double voxel_size_for(const Mesh& mesh, double error = 0);

/// About what making a level set takes at the most, bytes; its band is in voxels.
double field_bytes(const Mesh& mesh, double voxel, double band = kBandVoxels);

/// The level set of a mesh, on the grid of lay_bricks(). Needs vertex normals. The same bits on
/// every run and any number of threads.
FieldResult build_field(const Mesh& mesh, const FieldSettings& wanted);

/// The surface of a level set, where it is 0 but for a thousandth of a voxel: closed, vertex
/// normals included.
MeshResult field_surface(const VoxelBricks& bricks);

/// What a file of ours says beside the values.
struct FieldNotes {
    std::string key;  // of what it was made from
    double error = 0;
    std::vector<std::string> warnings;
};

/// Writes a level set as a float grid "distance" that other tools read: active where it is below
/// the band, filled inside. Answers what went wrong, or nothing.
std::string
write_vdb(const std::filesystem::path& path, const VoxelBricks& bricks, const FieldNotes& notes);

/// What a .vdb file holds.
///
///   bricks   of a file of ours bit for bit as written; of others the values of the first float
///            level set, filled inside to any depth
///   surface  where it is 0 but for a thousandth of a voxel, vertex normals included; empty unless
///            asked for
///   notes    empty where the file is not ours
struct VdbFile {
    VoxelBricks bricks;
    Mesh surface;
    FieldNotes notes;
    std::string trouble;
};

enum class VdbWants : std::uint8_t { bricks, bricks_and_surface };

VdbFile read_vdb(const std::filesystem::path& path, VdbWants wants);

/// The same from the bytes of a file, whose name trouble then leaves out. For files that somebody
/// made on purpose: OpenVDB does not expect bytes of any kind.
VdbFile read_vdb_bytes(std::string bytes, VdbWants wants);

}  // namespace throng
