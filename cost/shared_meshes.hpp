// Shared meshes: scans and models from public projects, kept beside the project and not in it.
#pragma once

#include "scene/catalog/closed_meshes.hpp"

#include <optional>
#include <string>

namespace throng {

/// The triangles of a file of the shared data, repaired as a moving mesh is; nothing where the file
/// is absent. Looks in meshes/ of the directory named by THRONG_DATA, then of shared/data beside
/// each folder above the sources.
///
/// Throws SceneError where the file is there and is no mesh.
std::optional<TriangleSoup> shared_mesh(const std::string& file);

}  // namespace throng
