// Piles: bodies dropped in a heap, tumbled, or flying about.
//
// These scenes weigh the whole pipeline: many small contacts of all ages, in one great island
// (pile, spheres, hulls, tumbler) or in none (sparse).
#include "scene/catalog/parts.hpp"
#include "scene/catalog/recipes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace throng {

namespace {

constexpr double kPi = std::numbers::pi;

Vec3 random_half_extents(Random& random) { return random_vector(random, 0.25, 0.5); }

}  // namespace

// Boxes with edges of 0.5 to 1 m, turned at random, dropped in an open container. Box contacts of
// every sort, deep piles, no two bodies alike.
Scene make_pile(int size, std::uint64_t seed)
{
    Scene scene = begin_scene("pile", size);
    Random random(seed);
    const double spacing = 1.35;
    const auto [layers, side] = heap_layout(size);
    add_container(scene, side * spacing / 2 + 0.05, layers * spacing * 0.8 + 2);

    const std::uint32_t box = add_shape(scene, "box", BoxShape{Vec3::Constant(0.5)});
    Instances& boxes = add_instances(scene, box, static_cast<std::size_t>(size), true);
    const Grid grid{side, spacing, 0.7};
    for (int i = 0; i < size; ++i) {
        const Vec3 position = grid.place(i, random);
        const Vec3 half_extents = random_half_extents(random);
        const Vec3 velocity = random_drift(random);
        const Quat orientation = fitting_turn(random, half_extents, 1.3);
        add_record(boxes, {position, orientation}, velocity, Vec3::Zero(), half_extents);
    }
    return scene;
}

// Equal spheres dropped in a container: the cheapest contact there is, so what is left is the cost
// of finding pairs and of solving rows.
Scene make_spheres(int size, std::uint64_t seed)
{
    Scene scene = begin_scene("spheres", size);
    Random random(seed);
    const double spacing = 1.05;
    const auto [layers, side] = heap_layout(size);
    add_container(scene, side * spacing / 2 + 0.05, layers * spacing + 2);

    const std::uint32_t ball = add_shape(scene, "ball", SphereShape{0.5});
    Instances& balls = add_instances(scene, ball, static_cast<std::size_t>(size), false);
    const Grid grid{side, spacing, 0.6};
    for (int i = 0; i < size; ++i) {
        const Vec3 position = grid.place(i, random);
        add_record(balls, {position, Quat::Identity()}, random_drift(random));
    }
    return scene;
}

// Stones of 24 corners and 44 faces from a library of up to 256, dropped in a container: the cost
// of convex contacts at its greatest.
Scene make_hulls(int size, std::uint64_t seed)
{
    Scene scene = begin_scene("hulls", size);
    Random random(seed);
    const double spacing = 1.2;
    const auto [layers, side] = heap_layout(size);
    add_container(scene, side * spacing / 2 + 0.05, layers * spacing + 2);

    const auto kinds = static_cast<std::uint32_t>(std::min(size, 256));
    const auto first = static_cast<std::uint32_t>(scene.shapes.size());
    for (std::uint32_t k = 0; k < kinds; ++k)
        add_shape(scene, "stone " + std::to_string(k), HullShape{random_stone(random)});

    // Bodies rather than instances: neighbors in id order differ in shape.
    const Grid grid{side, spacing, 0.7};
    scene.bodies.reserve(scene.bodies.size() + static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i) {
        BodyDescription& body = scene.bodies.emplace_back();
        body.material = 0;
        body.position = grid.place(i, random);
        body.shape = first + random.below(kinds);
        body.velocity = random_drift(random);
        body.orientation = random_turn(random, kPi);
    }
    return scene;
}

// Boxes in free flight without gravity, 1000 m3 each: hardly a contact, so the broad phase and the
// integrator stand alone.
Scene make_sparse(int size, std::uint64_t seed)
{
    Scene scene = begin_scene("sparse", size);
    Random random(seed);
    scene.gravity = Vec3::Zero();
    const double half = std::pow(size * 1000.0, 1.0 / 3) / 2;

    const std::uint32_t box = add_shape(scene, "box", BoxShape{Vec3::Constant(0.5)});
    Instances& boxes = add_instances(scene, box, static_cast<std::size_t>(size), true);
    for (int i = 0; i < size; ++i) {
        const Vec3 half_extents = random_half_extents(random);
        const Vec3 position = random_vector(random, -half, half);
        const Vec3 velocity = random_vector(random, -5, 5);
        const Vec3 angular_velocity = random_vector(random, -1, 1);
        const Quat orientation = random_turn(random, 3);
        add_record(boxes, {position, orientation}, velocity, angular_velocity, half_extents);
    }
    return scene;
}

// Balls and boxes of all sizes from 5 mm to 5 m, as many of each, dropped on a floor that they
// slide and roll over at speeds that go with the square roots of their sizes: whatever sorts bodies
// by where they are has all of these to sort at once.
//
// Who is of one size has a quarter of a square to itself, and all smaller ones the quarter across.
Scene make_mixed(int size, std::uint64_t seed)
{
    constexpr int kSizes = 10;                   // each half of the one before
    constexpr double kGreatest = 5;              // m
    constexpr double kSquare = 4.4 * kGreatest;  // m: twice the way across a cube
    Scene scene = begin_scene("mixed", size);
    Random random(seed);
    const int squares = (size + kSizes - 1) / kSizes;
    const int side = static_cast<int>(std::ceil(std::sqrt(squares)));
    add_static_box(scene, "floor", {0, 0, -2}, Vec3(side * kSquare, side * kSquare, 2));

    const std::uint32_t shapes[] = {add_shape(scene, "ball", SphereShape{0.5}),
                                    add_shape(scene, "box", BoxShape{Vec3::Constant(0.5)})};
    for (int kind = 0; kind < 2; ++kind) {
        const auto count = static_cast<std::size_t>((size + 1 - kind) / 2);
        if (count == 0) break;
        Instances& group = add_instances(scene, shapes[kind], count, true);
        for (int i = kind; i < size; i += 2) {
            const int square = i / kSizes, level = i % kSizes;
            const double scale = std::ldexp(1.0, -level);
            const double extent = kGreatest * scale * random.uniform(0.5, 1);
            // From the lower corner of the square to that of the level's own, and a quarter on.
            const double own = kSquare * (1 - scale), quarter = kSquare * scale / 4;
            const Vec3 corner((square % side - side / 2.0) * kSquare,
                              (square / side - side / 2.0) * kSquare, 0);
            const double half = extent / 2;
            const Vec3 position =
                corner + Vec3(own + quarter, own + quarter, std::sqrt(3.0) * half + extent / 4);
            const Vec3 velocity = random_drift(random) * std::sqrt(9.81 * extent);
            const Quat orientation = random_turn(random, std::numbers::pi);
            Vec3 half_extents(half, 0, 0);
            for (int axis = 1; kind == 1 && axis < 3; ++axis)
                half_extents[axis] = half * random.uniform(0.4, 1);
            add_record(group, {position, orientation}, velocity, Vec3::Zero(), half_extents);
        }
    }
    return scene;
}

// Boxes in a hollow box that turns about x at 0.3 rad/s: a heap that never comes to rest, so that
// nothing may sleep and contacts never grow old.
Scene make_tumbler(int size, std::uint64_t seed)
{
    Scene scene = begin_scene("tumbler", size);
    Random random(seed);
    const int side = static_cast<int>(std::ceil(std::pow(size, 1.0 / 3)));
    const double spacing = 1.35;
    const double inner = side * spacing / 2 + 0.2;
    const double thick = 1;  // half of a wall's thickness
    const double outer = inner + 2 * thick;
    const double middle = inner + thick;

    const std::uint32_t wall_x = add_shape(scene, "wall x", BoxShape{{thick, outer, outer}});
    const std::uint32_t wall_y = add_shape(scene, "wall y", BoxShape{{inner, thick, outer}});
    const std::uint32_t wall_z = add_shape(scene, "wall z", BoxShape{{inner, inner, thick}});
    CompoundShape hollow;
    for (const double sign : {-1.0, 1.0}) {
        hollow.parts.push_back({wall_x, {{sign * middle, 0, 0}, Quat::Identity()}});
        hollow.parts.push_back({wall_y, {{0, sign * middle, 0}, Quat::Identity()}});
        hollow.parts.push_back({wall_z, {{0, 0, sign * middle}, Quat::Identity()}});
    }
    BodyDescription drum;
    drum.name = "drum";
    drum.shape = add_shape(scene, "drum", std::move(hollow));
    drum.material = 0;
    drum.motion = Motion::kinematic;
    drum.angular_velocity = {0.3, 0, 0};
    scene.bodies.push_back(std::move(drum));

    const std::uint32_t box = add_shape(scene, "box", BoxShape{Vec3::Constant(0.5)});
    Instances& boxes = add_instances(scene, box, static_cast<std::size_t>(size), true);
    const double half = (side - 1) * spacing / 2;
    for (int i = 0; i < size; ++i) {
        const Vec3 half_extents = random_half_extents(random);
        const int column = i % side, row = i / side % side, layer = i / (side * side);
        const Vec3 position = Vec3(column, row, layer) * spacing - Vec3::Constant(half);
        const Quat orientation = fitting_turn(random, half_extents, 1.33);
        add_record(boxes, {position, orientation}, Vec3::Zero(), Vec3::Zero(), half_extents);
    }
    return scene;
}

}  // namespace throng
