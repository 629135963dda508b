// Field cache: level sets kept on disk by what they were made from, as files that other tools read
// (disk_cache.hpp).
#pragma once

#include "cooking/fields/voxel_field.hpp"

namespace throng {

/// What a level set is made from, as 16 hex digits: vertices, triangles, voxel, band, sign, and the
/// version of the files.
std::string field_key(const Mesh& mesh, const FieldSettings& settings);

/// build_field(), or what an earlier one of the same key left in the folder: the same bits.
///
///   folder  made where it is not there; empty: nothing is read or written. One that cannot be
///           written is remarked on, and no trouble
FieldResult
cached_field(const Mesh& mesh, const FieldSettings& settings, const std::filesystem::path& folder);

}  // namespace throng
