// Crowds: people, or robots, that walk where they will and may not turn over.
#include "scene/catalog/parts.hpp"
#include "scene/catalog/recipes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace throng {

// Upright capsules of 80 kg, each driven at 1.4 m/s along +x or -x, among square pillars: many
// light contacts, rotations locked, nothing ever at rest.
Scene make_crowd(int size, std::uint64_t seed)
{
    Scene scene = begin_scene("crowd", size);
    Random random(seed);
    const int side = static_cast<int>(std::ceil(std::sqrt(size)));
    const double spacing = 1.2, radius = 0.3, half_length = 0.6, speed = 1.4;
    const double extent = side * spacing / 2 + 30;
    add_static_box(scene, "floor", {0, 0, -2}, {extent, extent, 2});

    // One pillar for 50 people, each in a cell of its own that nobody starts in.
    const double half = (side - 1) * spacing / 2;
    const auto side_cells = static_cast<std::size_t>(side);
    std::vector<bool> taken(side_cells * side_cells, false);
    const std::uint32_t pillar = add_shape(scene, "pillar", BoxShape{{0.3, 0.3, 1}});
    for (int k = 0; k < std::max(1, size / 50); ++k) {
        const std::uint32_t column = random.below(static_cast<std::uint32_t>(side));
        const std::uint32_t row = random.below(static_cast<std::uint32_t>(side));
        const std::size_t cell = row * side_cells + column;
        if (taken[cell]) continue;
        taken[cell] = true;
        BodyDescription& body = scene.bodies.emplace_back();
        body.name = "pillar " + std::to_string(scene.bodies.size() - 1);
        body.shape = pillar;
        body.material = 0;
        body.motion = Motion::static_;
        body.position = {column * spacing - half, row * spacing - half, 1};
        body.orientation = turn(Vec3::UnitZ(), random.uniform(0, std::numbers::pi));
    }

    // Bodies rather than instances: neighbors in id order differ in what drives them.
    const std::uint32_t person = add_shape(scene, "person", CapsuleShape{radius, half_length});
    scene.bodies.reserve(scene.bodies.size() + static_cast<std::size_t>(size));
    const auto wanted = scene.bodies.size() + static_cast<std::size_t>(size);
    for (std::size_t cell = 0; scene.bodies.size() < wanted; ++cell) {
        if (cell < taken.size() && taken[cell]) continue;
        const double ahead = random.below(2) == 0 ? -speed : speed;
        const auto column = static_cast<int>(cell % side_cells);
        const auto row = static_cast<int>(cell / side_cells);
        const double x = column * spacing - half + random.uniform(-0.1, 0.1);
        const double y = row * spacing - half + random.uniform(-0.1, 0.1);
        BodyDescription& body = scene.bodies.emplace_back();
        body.shape = person;
        body.material = 0;
        body.mass = 80;
        body.position = {x, y, radius + half_length};
        body.velocity = {ahead, 0, 0};
        body.drive_velocity = {ahead, 0.0, std::nullopt};
        body.lock_rotation = true;
    }
    return scene;
}

}  // namespace throng
