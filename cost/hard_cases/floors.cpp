#include "cost/hard_cases/floors.hpp"

#include "scene/catalog/parts.hpp"
#include "scene/catalog/random.hpp"
#include "scene/catalog/sheets.hpp"
#include "throng/rotation.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

HullShape slab(const FloorSize& size)
{
    HullShape hull;
    for (int i = 0; i < 8; ++i)
        hull.points.emplace_back(i & 1 ? size.wide : -size.wide, i & 2 ? size.wide : -size.wide,
                                 i & 4 ? size.thick : -size.thick);
    return hull;
}

MeshShape grid(const FloorSize& size, int cells)
{
    Random random(1);
    const auto along = [&](int i) { return size.wide * (2.0 * i / cells - 1); };
    return mesh_shape(sheet_mesh(cells, [&](int i, int k) {
        return Vec3(along(i), along(k), size.thick + random.uniform(0, size.height));
    }));
}

void lay_tiles(SceneParts& parts, std::uint32_t material, const Pose& frame, const FloorSize& size)
{
    const FloorSize tile{size.wide / size.cells, size.thick};
    const auto middle = [&](int i) { return tile.wide * (2 * i + 1) - size.wide; };
    for (int i = 0; i < size.cells; ++i)
        for (int k = 0; k < size.cells; ++k)
            put_floor(parts, material, Floor::box,
                      {frame * Vec3(middle(i), middle(k), 0), frame.orientation}, tile);
}

}  // namespace

const char* name_of(Floor floor)
{
    constexpr const char* kNames[] = {"plane", "box", "mesh", "hull", "grid", "tiles"};
    return kNames[static_cast<int>(floor)];
}

void put_floor(SceneParts& parts,
               std::uint32_t material,
               Floor floor,
               const Pose& frame,
               const FloorSize& size)
{
    const Vec3 up = frame.orientation * Vec3::UnitZ();
    if (floor == Floor::plane) {
        parts.plane(material, up, up.dot(frame.position));
        return;
    }
    if (floor == Floor::tiles) return lay_tiles(parts, material, frame, size);
    const std::uint32_t id = parts.box(material, 1, Vec3(size.wide, size.wide, size.thick),
                                       {frame.position - size.thick * up, frame.orientation});
    parts.hold(id);
    auto& shape = parts.scene().shapes[parts.body(id).shape].shape;
    if (floor == Floor::hull) shape = slab(size);
    if (floor == Floor::mesh) shape = grid(size, 1);
    if (floor == Floor::grid) shape = grid(size, size.cells);
}

double lowest_of(std::span<const Vec3> points, const Pose& pose)
{
    double lowest = std::numeric_limits<double>::infinity();
    for (const Vec3& point : points) lowest = std::min(lowest, (pose.orientation * point).z());
    return lowest + pose.position.z();
}

}  // namespace throng
