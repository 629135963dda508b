#include "scene/catalog/closed_meshes.hpp"

#include <cmath>
#include <numbers>

namespace throng {
namespace {

Vec3 on_circle(double radius, std::uint32_t step, std::uint32_t steps)
{
    const double angle = 2 * std::numbers::pi * step / steps;
    return {radius * std::cos(angle), radius * std::sin(angle), 0};
}

}  // namespace

TriangleSoup box_mesh(const Vec3& half)
{
    TriangleSoup mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.vertices.emplace_back((corner & 1) != 0 ? half.x() : -half.x(),
                                   (corner & 2) != 0 ? half.y() : -half.y(),
                                   (corner & 4) != 0 ? half.z() : -half.z());
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

TriangleSoup ball_mesh(double radius, std::uint32_t around, std::uint32_t rings)
{
    TriangleSoup mesh;
    mesh.vertices.emplace_back(0, 0, -radius);
    for (std::uint32_t ring = 1; ring < rings; ++ring)
        for (std::uint32_t i = 0; i < around; ++i) {
            const double height = -std::cos(std::numbers::pi * ring / rings);
            const double width = std::sin(std::numbers::pi * ring / rings);
            mesh.vertices.emplace_back(on_circle(radius * width, i, around)
                                       + Vec3(0, 0, radius * height));
        }
    mesh.vertices.emplace_back(0, 0, radius);
    const auto top = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    const auto at = [&](std::uint32_t ring, std::uint32_t i) {
        return 1 + (ring - 1) * around + i % around;
    };
    for (std::uint32_t i = 0; i < around; ++i) {
        mesh.triangles.push_back({0, at(1, i + 1), at(1, i)});
        for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
            mesh.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i + 1)});
            mesh.triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)});
        }
        mesh.triangles.push_back({at(rings - 1, i), at(rings - 1, i + 1), top});
    }
    return mesh;
}

TriangleSoup torus_mesh(double ring, double tube, std::uint32_t around, std::uint32_t across)
{
    TriangleSoup mesh;
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t k = 0; k < across; ++k) {
            const Vec3 out = on_circle(1, i, around), turn = on_circle(tube, k, across);
            mesh.vertices.emplace_back(out * (ring + turn.x()) + Vec3(0, 0, turn.y()));
        }
    close_grid(mesh, around, across);
    return mesh;
}

void close_grid(TriangleSoup& mesh, std::uint32_t around, std::uint32_t across)
{
    const auto at = [&](std::uint32_t i, std::uint32_t k) {
        return i % around * across + k % across;
    };
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t k = 0; k < across; ++k) {
            mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
}

}  // namespace throng
