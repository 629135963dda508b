// Sheets: open meshes over a rectangle of vertices.
#pragma once

#include "throng/scene.hpp"

#include <functional>

namespace throng {

/// So many squares along x and y, of two triangles each, whose front is up: `corner` tells where
/// the one at (i, k) lies, i along x and k along y, and is asked once for each, k first.
TriangleSoup sheet_mesh(int along_x, int along_y, const std::function<Vec3(int, int)>& corner);

/// As many along both.
TriangleSoup sheet_mesh(int cells, const std::function<Vec3(int, int)>& corner);

}  // namespace throng
