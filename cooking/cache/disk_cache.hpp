// Disk cache: what took long to make, kept on disk by a hash of what it was made from.
//
// A file ends in its checksum: what is damaged or not throng's is made anew. Several
// programs may share a folder.
#pragma once

#include "kernels/data/mesh.hpp"
#include "kernels/math/hash.hpp"

#include <filesystem>
#include <functional>
#include <string>

namespace throng {

/// $XDG_CACHE_HOME/throng, or ~/.cache/throng; empty where neither is known.
std::filesystem::path default_cache_folder();

/// Vertices and triangles, in order.
void add_mesh(const Mesh& mesh, Hash& hash);

/// What was written under the checksum; empty where there is no such file, or its checksum does not
/// hold.
std::string read_cached(const std::filesystem::path& path);

/// Has a file written, adds the checksum and puts it in place; its folder is made where it is not
/// there. Answers what went wrong, or nothing. No program ever reads half a file.
///
///   write  to the path it is given; answers what went wrong, or nothing
std::string write_cached(const std::filesystem::path& path,
                         const std::function<std::string(const std::filesystem::path&)>& write);

}  // namespace throng
