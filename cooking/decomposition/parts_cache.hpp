// Parts cache: convex parts kept on disk by what they were made from (disk_cache.hpp).
#pragma once

#include "cooking/decomposition/convex_parts.hpp"

#include <filesystem>

namespace throng {

/// What parts are made from, as 16 hex digits: vertices, triangles, parts and error wanted, and the
/// version of the files.
std::string parts_key(const Mesh& mesh, const PartsWanted& wanted);

/// split_into_parts(), or what an earlier one of the same key left in the folder: the same bits.
///
///   folder  made where it is not there; empty: nothing is read or written. One that cannot be
///           written is remarked on, and no trouble
ConvexParts
cached_parts(const Mesh& mesh, const PartsWanted& wanted, const std::filesystem::path& folder);

}  // namespace throng
