// Machines: one thing strikes the next.
#include "scene/catalog/parts.hpp"
#include "scene/catalog/recipes.hpp"

#include <cmath>

namespace throng {

// Pieces of 0.25 x 0.5 x 1 m in a row on a plane; the first is turning over its foot, so that it
// falls. Stresses the order of events: a wave that must run at a steady speed, whatever the step,
// over pieces that stand still or sleep until it comes.
//
// Source: Catto's solver2d, "double domino"; spacing 0.75 of the height (tables go from 0.5 to
// 0.9).
Scene make_dominoes(int size, std::uint64_t /*seed*/)
{
    Scene scene = begin_scene("dominoes", size);
    add_ground(scene);

    const Vec3 half(0.125, 0.25, 0.5);
    const double spacing = 0.75;
    const std::uint32_t piece = add_shape(scene, "piece", BoxShape{half});
    Instances& pieces = add_instances(scene, piece, static_cast<std::size_t>(size), false);

    // Twice what it takes to pass the tipping point (0.92 rad/s), about the foot on the far side.
    const Vec3 push(0, 2, 0);
    const Vec3 foot_to_center(-half.x(), 0, half.z());
    add_record(pieces, {{0, 0, half.z()}, Quat::Identity()}, push.cross(foot_to_center), push);
    for (int i = 1; i < size; ++i)
        add_record(pieces, {{i * spacing, 0, half.z()}, Quat::Identity()});
    return scene;
}

// Equal balls that touch in a line along x, and one that comes in at 1 m/s. No gravity, no
// friction, nothing lost: the last one must leave at 1 m/s and the others stay. Stresses
// restitution across a chain of contacts, where all impacts happen at once and their order decides
// the answer.
//
// Source: Smith and others, Reflections on Simultaneous Impact (2012).
Scene make_cradle(int size, std::uint64_t /*seed*/)
{
    Scene scene = begin_scene("cradle", size);
    scene.gravity = Vec3::Zero();
    scene.materials[0].name = "steel";
    scene.materials[0].friction = 0;
    scene.materials[0].restitution = 1;

    // A radius of 1/2 m keeps all places exact, so that the balls touch to the last bit.
    const double radius = 0.5, separation = 0.25;
    const std::uint32_t ball = add_shape(scene, "ball", SphereShape{radius});
    Instances& balls = add_instances(scene, ball, static_cast<std::size_t>(size), false);
    add_record(balls, {{-separation, 0, 0}, Quat::Identity()}, {1, 0, 0});
    for (int i = 1; i < size; ++i) add_record(balls, {{2 * radius * i, 0, 0}, Quat::Identity()});
    return scene;
}

// Balls of 5 mm radius at 1 km/s, from 10 m away, against a plate of 1 mm. Each crosses 17 m in a
// step of 1/60 s, and touches first at 9.9945 ms: none may come through. Stresses fast motion.
//
// Source: after the cube at 1 km/s against a thin plate in rigid-ipc's scenes (Ferguson and others,
//         Intersection-free Rigid Body Dynamics, 2021).
Scene make_bullet_plate(int size, std::uint64_t /*seed*/)
{
    Scene scene = begin_scene("bullet_plate", size);
    scene.gravity = Vec3::Zero();
    const double radius = 0.005, half_thickness = 0.0005, spacing = 0.05;
    const int side = static_cast<int>(std::ceil(std::sqrt(size)));
    const double half_width = side * spacing / 2 + 0.5;
    add_static_box(scene, "plate", Vec3::Zero(), {half_thickness, half_width, half_width});

    const std::uint32_t bullet = add_shape(scene, "bullet", SphereShape{radius});
    Instances& bullets = add_instances(scene, bullet, static_cast<std::size_t>(size), false);
    bullets.common.fast = true;
    const double half = (side - 1) / 2.0;
    for (int i = 0; i < size; ++i) {
        const int column = i % side, row = i / side;
        const Vec3 position(-10, (column - half) * spacing, (row - half) * spacing);
        add_record(bullets, {position, Quat::Identity()}, {1000, 0, 0});
    }
    return scene;
}

// Balls of 1 kg, each on a spring of 100 N/m and 1 m with its other end fixed above it, let go
// 0.2 m beside where it would hang still and as much below, each on another side. Nothing touches
// and nothing is lost: what is off is off by the step alone, and energy tells it. Stresses the
// integrator, and what is measured where no contact is.
//
// Source: the elastic pendulum; about hanging still its swings are those of a spring, sqrt(k / m),
//         and of a pendulum, sqrt(g / (l + m g / k)).
Scene make_spring(int size, std::uint64_t /*seed*/)
{
    Scene scene = begin_scene("spring", size);
    constexpr double kStiffness = 100, kLength = 1, kMass = 1, kApart = 4;
    const double radius = std::cbrt(kMass / (scene.materials[0].density * 4 / 3 * std::acos(-1.0)));
    const double hung = kLength - kMass * scene.gravity.z() / kStiffness;
    const std::uint32_t ball = add_shape(scene, "ball", SphereShape{radius});
    Instances& balls = add_instances(scene, ball, static_cast<std::size_t>(size), false);
    const int side = static_cast<int>(std::ceil(std::sqrt(size)));
    for (int i = 0; i < size; ++i) {
        Spring spring;
        spring.b = static_cast<std::uint32_t>(i);
        spring.at_a = Vec3(kApart * (i % side), kApart * (i / side), 0);
        spring.stiffness = kStiffness;
        spring.length = kLength;
        const double way = 2.4 * i;  // rad, about the golden angle
        const Vec3 aside = 0.2 * Vec3(std::cos(way), std::sin(way), -1);
        const Vec3 at = spring.at_a + Vec3(0, 0, -hung) + aside;
        scene.springs.push_back(spring);
        add_record(balls, {at, Quat::Identity()});
    }
    return scene;
}

}  // namespace throng
