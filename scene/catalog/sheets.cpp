#include "scene/catalog/sheets.hpp"

namespace throng {

TriangleSoup sheet_mesh(int along_x, int along_y, const std::function<Vec3(int, int)>& corner)
{
    TriangleSoup mesh;
    for (int i = 0; i <= along_x; ++i)
        for (int k = 0; k <= along_y; ++k) mesh.vertices.push_back(corner(i, k));
    const auto at = [&](int i, int k) { return static_cast<std::uint32_t>(i * (along_y + 1) + k); };
    for (int i = 0; i < along_x; ++i)
        for (int k = 0; k < along_y; ++k) {
            mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    return mesh;
}

TriangleSoup sheet_mesh(int cells, const std::function<Vec3(int, int)>& corner)
{
    return sheet_mesh(cells, cells, corner);
}

}  // namespace throng
