// Tangles: bodies that are not convex, and go into and through one another.
//
// These scenes ask what only a true shape answers: a hull in its place fills the hole that matters.
#include "scene/catalog/closed_meshes.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/recipes.hpp"
#include "scene/catalog/swept_meshes.hpp"
#include "scene/catalog/threads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace throng {

namespace {

constexpr double kPi = std::numbers::pi;

// How far a body of a tangle reaches from its middle, m.
constexpr double kReach = 0.5;

// Bodies dropped in a container. Each reaches no further than kReach from its origin.
Scene drop_tangle(int size, std::uint64_t seed, std::vector<ShapeDescription> kinds)
{
    Scene scene = begin_scene("knots", size);
    Random random(seed);
    const double spacing = 2 * kReach + 0.1;
    const auto [layers, side] = heap_layout(size);
    add_container(scene, side * spacing / 2 + 0.05, layers * spacing + 2);

    drop_in_turn(scene, std::move(kinds), size, {side, spacing, kReach + 0.1}, random);
    return scene;
}

// Place i of a square of side x side, centered about the origin.
Vec3 place_in_square(int i, int side, double spacing)
{
    const int column = i % side, row = i / side;
    const double half = (side - 1) * spacing / 2;
    return {column * spacing - half, row * spacing - half, 0};
}

}  // namespace

// Trefoils, cinquefoils, tori and links of a chain dropped in an open container: holes into which
// others reach, and bodies that hook into one another.
Scene make_knots(int size, std::uint64_t seed)
{
    // As thick as their strands leave room for.
    const auto knot = [](int crossways, double tube, std::uint32_t around) {
        const double swing = 0.14, ring = kReach - tube - swing;
        return tube_mesh(torus_knot({2, crossways, ring, swing}, around), tube, 10);
    };
    return drop_tangle(
        size, seed,
        {{"trefoil", mesh_shape(fitted(knot(3, 0.09, 72), kReach))},
         {"torus", mesh_shape(fitted(torus_mesh(0.4, 0.1, 32, 12), kReach))},
         {"cinquefoil", mesh_shape(fitted(knot(5, 0.06, 120), kReach))},
         {"link", mesh_shape(fitted(tube_mesh(link_curve(0.15, 0.25, 12), 0.1, 12), kReach))}});
}

Scene make_knots_of(int size, std::uint64_t seed, const TriangleSoup& mesh)
{
    return drop_tangle(size, seed, {{"solid", mesh_shape(fitted(mesh, kReach))}});
}

// A chain of round links between two that are fixed, straight at first and not quite taut. It sags
// into the curve that hanging chains have, and no link may leave the next.
//
// Source: the chain of ten tori 0.55 m apart in Ferguson et al., Intersection-free Rigid Body
//         Dynamics (2021).
Scene make_chain(int size, std::uint64_t)
{
    Scene scene = begin_scene("chain", size);
    const double spacing = 0.55;
    const std::uint32_t link = add_shape(scene, "link", mesh_shape(torus_mesh(0.4, 0.1, 32, 16)));
    // Every other link stands upright.
    const auto pose = [&](int i) {
        const double upright = i % 2 == 0 ? 0 : kPi / 2;
        return Pose{{(i - (size + 1) / 2.0) * spacing, 0, 0}, turn(Vec3::UnitX(), upright)};
    };
    for (const int end : {0, size + 1}) {
        BodyDescription& body = scene.bodies.emplace_back();
        body.name = end == 0 ? "first" : "last";
        body.shape = link;
        body.material = 0;
        body.motion = Motion::static_;
        body.position = pose(end).position;
        body.orientation = pose(end).orientation;
    }
    Instances& links = add_instances(scene, link, static_cast<std::size_t>(size), false);
    for (int i = 1; i <= size; ++i) add_record(links, pose(i));
    return scene;
}

// Tori dropped over pegs, up to five over each, off the middle and askew: they slide down to the
// floor round their peg. With hulls in their place they stay on top.
Scene make_peg(int size, std::uint64_t seed)
{
    Scene scene = begin_scene("peg", size);
    scene.materials[0].friction = 0.2;
    Random random(seed);
    const double ring = 1, tube = 0.25, half_height = 1.5;
    const int stack = 5;
    const int pegs = (size + stack - 1) / stack;
    const int side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(pegs))));
    const double spacing = 2 * (ring + tube) + 0.5;
    const double floor = side * spacing / 2 + 5;
    add_static_box(scene, "floor", {0, 0, -2}, {floor, floor, 2});

    const auto middle = [&](int peg) -> Vec3 {
        return place_in_square(peg, side, spacing) + Vec3(0, 0, half_height);
    };
    const std::uint32_t post = add_shape(scene, "peg", CylinderShape{0.5, half_height});
    Instances& posts = add_instances(scene, post, static_cast<std::size_t>(pegs), false);
    posts.common.motion = Motion::static_;
    for (int peg = 0; peg < pegs; ++peg) add_record(posts, {middle(peg), Quat::Identity()});

    // Leaning by 0.15 off upright, a torus reaches 0.15 higher and lower than a level one.
    const double lean = 0.15, level = 2 * (tube + ring * lean) + 0.05;
    const std::uint32_t torus =
        add_shape(scene, "torus", mesh_shape(torus_mesh(ring, tube, 48, 24)));
    Instances& tori = add_instances(scene, torus, static_cast<std::size_t>(size), false);
    for (int i = 0; i < size; ++i) {
        const double x = random.uniform(-0.1, 0.1);
        const double y = random.uniform(-0.1, 0.1);
        const double toward = random.uniform(0, 2 * kPi);
        const Vec3 axis(std::cos(toward), std::sin(toward), 0);
        const double height = half_height + level * (i % stack + 0.5);
        const Vec3 position = middle(i / stack) + Vec3(x, y, height);
        add_record(tori, {position, turn(axis, random.uniform(-lean, lean))});
    }
    return scene;
}

// Steel bolts in fixed nuts, hardly any friction between them: their weight turns them down the
// thread, which is steep enough for that, until the head is on the nut.
Scene make_bolt(int size, std::uint64_t)
{
    Scene scene = begin_scene("bolt", size);
    Material& steel = scene.materials[0];
    steel.name = "steel";
    steel.density = 8050;
    steel.friction = 0.01;
    const Thread thread{0.01, 0.005, 0.00025};
    const double height = 3.2 * thread.pitch, shaft = 10 * thread.pitch;
    const double spacing = 5 * thread.radius;
    const int side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(size))));
    const auto place = [&](int i) { return place_in_square(i, side, spacing); };
    const auto count = static_cast<std::size_t>(size);
    const std::uint32_t nut = add_shape(scene, "nut", mesh_shape(nut_mesh(thread, height, 24)));
    Instances& nuts = add_instances(scene, nut, count, false);
    nuts.common.motion = Motion::static_;
    for (int i = 0; i < size; ++i) add_record(nuts, {place(i), Quat::Identity()});

    // Whole turns of thread up, so that bolt and nut are in step; a turn of the tip looks out
    // below.
    const Vec3 up(0, 0, shaft - thread.pitch);
    const std::uint32_t bolt = add_shape(scene, "bolt", mesh_shape(bolt_mesh(thread, shaft, 24)));
    Instances& bolts = add_instances(scene, bolt, count, false);
    for (int i = 0; i < size; ++i) add_record(bolts, {place(i) + up, Quat::Identity()});
    return scene;
}

}  // namespace throng
