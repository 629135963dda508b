// Field module: what is asked of OpenVDB, by way of a library that is opened when first needed.
//
// Few scenes have voxels, and OpenVDB is most of what a program would have to load: it brings a
// logger with a thread of its own along. So what needs it is libthrong_cooking.so.
#pragma once

#include "cooking/fields/voxel_field.hpp"

#include <functional>

namespace throng {

/// The module's functions. They are called on the world's threads and may throw std::bad_alloc.
///
///   version, size  of throng and of this table: those of the program that opens it, or it is not
///                  taken
///   fill           the distances of a mesh on laid bricks, see build_field()
///   surface, write, read, read_bytes   see voxel_field.hpp
struct FieldModule {
    const char* version = nullptr;
    std::size_t size = 0;
    VoxelBricks (*fill)(const Mesh& mesh, const VoxelBricks& laid, FieldSign sign) = nullptr;
    MeshResult (*surface)(const VoxelBricks& bricks) = nullptr;
    std::string (*write)(const std::filesystem::path& path,
                         const VoxelBricks& bricks,
                         const FieldNotes& notes) = nullptr;
    VdbFile (*read)(const std::filesystem::path& path, VdbWants wants) = nullptr;
    VdbFile (*read_bytes)(std::string bytes, VdbWants wants) = nullptr;
};

/// The module, or why there is none and what is wanted.
struct OpenedFieldModule {
    const FieldModule* module = nullptr;
    std::string trouble;
};

/// Builds the module's file; answers whether it did.
using BuildFieldModule = std::function<bool()>;

/// Who is asked, once, for a file that is found nowhere. To be said before field_module() is
/// called.
void build_field_module_by(BuildFieldModule build);

/// Opens it at the first call; what came of that stays. THRONG_COOKING names its file; without that
/// it is looked for beside the program or library that holds this code, in `lib` beside that one's
/// folder, and where the system looks for libraries.
const OpenedFieldModule& field_module();

}  // namespace throng
