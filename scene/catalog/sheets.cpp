#include "scene/catalog/sheets.hpp"

namespace throng {

TriangleSoup sheet_mesh(int cells, const std::function<Vec3(int, int)>& corner)
{
    TriangleSoup mesh;
    for (int i = 0; i <= cells; ++i)
        for (int k = 0; k <= cells; ++k) mesh.vertices.push_back(corner(i, k));
    const auto at = [&](int i, int k) { return static_cast<std::uint32_t>(i * (cells + 1) + k); };
    for (int i = 0; i < cells; ++i)
        for (int k = 0; k < cells; ++k) {
            mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    return mesh;
}

}  // namespace throng
