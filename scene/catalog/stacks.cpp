// Stacks: equal bricks set down without a gap.
//
// Long chains of load from the top to the ground: what is asked is whether the solver carries it
// and how soon the whole comes to rest.
#include "scene/catalog/parts.hpp"
#include "scene/catalog/recipes.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

// A square pyramid of unit cubes, in whole layers, as near to the size as is at most 5% above it.
// One island, loads that spread.
Scene make_pyramid(int size, std::uint64_t /*seed*/)
{
    const auto cubes = [](std::int64_t m) { return m * (m + 1) * (2 * m + 1) / 6; };
    int layers = 1;
    while (static_cast<double>(cubes(layers + 1)) <= size * 1.05) ++layers;

    Scene scene = begin_scene("pyramid", size);
    const double spacing = 1.05;
    const double extent = layers * spacing + 20;
    add_static_box(scene, "floor", {0, 0, -2}, {extent, extent, 2});
    const std::uint32_t cube = add_shape(scene, "cube", BoxShape{Vec3::Constant(0.5)});
    Instances& group = add_instances(scene, cube, static_cast<std::size_t>(cubes(layers)), false);
    for (int k = 0; k < layers; ++k) {
        const int m = layers - k;
        const double half = (m - 1) / 2.0;
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < m; ++j) {
                const Vec3 position((i - half) * spacing, (j - half) * spacing, 0.5 + k);
                add_record(group, {position, Quat::Identity()});
            }
    }
    return scene;
}

// A wall of bricks of 1 x 0.5 x 0.5 m in running bond, four times as many to a row as there are
// rows: one island, long and thin.
Scene make_wall(int size, std::uint64_t /*seed*/)
{
    Scene scene = begin_scene("wall", size);
    const int rows = std::max(4, static_cast<int>(std::nearbyint(std::sqrt(size / 4.0))));
    const int columns = static_cast<int>(std::ceil(static_cast<double>(size) / rows));
    const Vec3 brick(1, 0.5, 0.5);
    const double pitch = brick.x() + 0.01;
    add_static_box(scene, "floor", {0, 0, -2}, {columns * pitch / 2 + 10, 20, 2});
    const std::uint32_t shape = add_shape(scene, "brick", BoxShape{brick / 2});
    Instances& bricks = add_instances(scene, shape, static_cast<std::size_t>(size), false);
    for (int i = 0; i < size; ++i) {
        const int row = i / columns;
        const double shift = row % 2 ? 0.5 : 0;
        const double x = (i % columns - (columns - 1) / 2.0 + shift) * pitch;
        const Vec3 position(x, 0, brick.z() / 2 + row * brick.z());
        add_record(bricks, {position, Quat::Identity()});
    }
    return scene;
}

// Towers of ten unit cubes, 3 m apart: as many small islands.
Scene make_stacks(int size, std::uint64_t /*seed*/)
{
    const int towers = std::max(1, size / 10);
    const int side = static_cast<int>(std::ceil(std::sqrt(towers)));
    const double spacing = 3;
    Scene scene = begin_scene("stacks", size);
    const double extent = side * spacing / 2 + 10;
    add_static_box(scene, "floor", {0, 0, -2}, {extent, extent, 2});
    const std::uint32_t cube = add_shape(scene, "cube", BoxShape{Vec3::Constant(0.5)});
    Instances& cubes = add_instances(scene, cube, static_cast<std::size_t>(towers) * 10, false);
    const double half = (side - 1) / 2.0;
    for (int tower = 0; tower < towers; ++tower) {
        const int column = tower % side, row = tower / side;
        const double x = (column - half) * spacing;
        const double y = (row - half) * spacing;
        for (int k = 0; k < 10; ++k) add_record(cubes, {{x, y, 0.5 + k}, Quat::Identity()});
    }
    return scene;
}

}  // namespace throng
