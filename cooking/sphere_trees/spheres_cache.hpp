// Spheres cache: sphere trees kept on disk by what they were made from (disk_cache.hpp).
#pragma once

#include "cooking/sphere_trees/sphere_tree.hpp"

#include <filesystem>
#include <string>

namespace throng {

/// What a tree is made from, as 16 hex digits: vertices, triangles, limits, and the version of the
/// files.
std::string spheres_key(const Mesh& mesh, const SphereTreeLimits& limits);

/// A tree, and what is to be said about its making: that it could not be kept, or nothing.
struct CachedSpheres {
    SphereTree tree;
    std::string warning;
};

/// build_sphere_tree(), or what an earlier one of the same key left in the folder: the same bits.
/// A tree without levels is not kept.
///
///   folder  made where it is not there; empty: nothing is read or written
CachedSpheres cached_spheres(const Mesh& mesh,
                             const SphereTreeLimits& limits,
                             const std::filesystem::path& folder);

}  // namespace throng
