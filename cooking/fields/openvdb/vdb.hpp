// VDB: what the module's files share.
#pragma once

#include "cooking/fields/field_module.hpp"

namespace throng::vdb {

/// Bricks filled with distances of a mesh; see FieldModule.
VoxelBricks fill(const Mesh& mesh, const VoxelBricks& laid, FieldSign sign);

MeshResult surface(const VoxelBricks& bricks);
std::string
write(const std::filesystem::path& path, const VoxelBricks& bricks, const FieldNotes& notes);
VdbFile read(const std::filesystem::path& path, VdbWants wants);
VdbFile read_bytes(std::string bytes, VdbWants wants);

}  // namespace throng::vdb
