// SimBenchmark: the contact tasks by which engines were compared in 2018, each with an answer.
//
// cost/answers has the answers. The size counts balls or planks; the default is the published one.
//
// Source: Kang and Hwangbo, SimBenchmark (leggedrobotics), 2018: rolling, bouncing, 666, elastic
//         666 and Kapla.
#include "scene/catalog/parts.hpp"
#include "scene/catalog/recipes.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// A scene whose one plane is the ground, of the scene's one material.
Scene begin_on_plane(std::string_view name, int size, double friction, double restitution)
{
    Scene scene = begin_scene(name, size);
    scene.materials[0].friction = friction;
    scene.materials[0].restitution = restitution;
    add_ground(scene);
    return scene;
}

// The least number whose so-manieth power is at least the size.
int side_of(int size, int power)
{
    const auto cells = [&](std::int64_t side) {
        return power == 2 ? side * side : side * side * side;
    };
    int side = 1;
    while (cells(side) < size) ++side;
    return side;
}

Instances& add_balls(Scene& scene, int size, double mass, double radius)
{
    const std::uint32_t ball = add_shape(scene, "ball", SphereShape{radius});
    Instances& balls = add_instances(scene, ball, static_cast<std::size_t>(size), false);
    balls.common.mass = mass;
    return balls;
}

// Balls of 10 kg in a cube, each coordinate moved up to a millimeter.
Scene cube_of_balls(
    std::string_view name, int size, std::uint64_t seed, double lowest, double restitution)
{
    constexpr double kPitch = 0.21, kShift = 1e-3;
    Scene scene = begin_on_plane(name, size, 0, restitution);
    Instances& balls = add_balls(scene, size, 10, 0.1);
    Random random(seed);
    const int side = side_of(size, 3);
    for (int i = 0; i < size; ++i) {
        Vec3 at(i % side, i / side % side, i / (side * side));
        at = kPitch * at + Vec3(0, 0, lowest);
        for (int axis = 0; axis < 3; ++axis) at[axis] += random.uniform(0, kShift);
        add_record(balls, {at, Quat::Identity()});
    }
    return scene;
}

}  // namespace

// A box of 10 kg that a force pulls over the ground, with balls of 1 kg at rest on it: it slides,
// and they roll without slip, with 2/7 of its acceleration. The force is along (1, sqrt(3)) / 2, so
// that who holds friction within a pyramid does not move the box at all. It is 150 N for 25 balls,
// and in proportion to the weight for others. Stresses friction's cone, and how far it is solved.
//
// Friction is that of SimBenchmark, 0.4 below the box and 0.8 on it, as the geometric means of what
// three materials have.
Scene make_rolling(int size, std::uint64_t /*seed*/)
{
    constexpr double kBoxMass = 10, kBallMass = 1, kRadius = 0.1, kPitch = 0.4, kHalfHeight = 0.1;
    Scene scene = begin_on_plane("rolling", size, 0.2, 0);
    scene.materials[0].name = "ground";
    Material smooth = scene.materials[0];
    smooth.name = "box and balls";
    smooth.friction = 0.8;
    scene.materials.push_back(smooth);

    // Balls stay behind by 4.2 m in the 4 s that SimBenchmark looks on.
    const int side = side_of(size, 2);
    const double half_width = std::max(10.0, side * kPitch / 2 + 9);
    BodyDescription box;
    box.name = "box";
    box.shape = add_shape(scene, "box", BoxShape{{half_width, half_width, kHalfHeight}});
    box.material = 1;
    box.mass = kBoxMass;
    box.position = Vec3(0, 0, kHalfHeight);
    const double force = 150 * (kBoxMass + kBallMass * size) / (kBoxMass + kBallMass * 25);
    box.force = force * Vec3(0.5, std::sqrt(0.75), 0);
    scene.bodies.push_back(std::move(box));

    Instances& balls = add_balls(scene, size, kBallMass, kRadius);
    balls.common.material = 1;
    const double half = (side - 1) / 2.0;
    for (int i = 0; i < size; ++i) {
        const Vec3 at((i % side - half) * kPitch, (i / side - half) * kPitch,
                      2 * kHalfHeight + kRadius);
        add_record(balls, {at, Quat::Identity()});
    }
    return scene;
}

// Balls of 10 kg, 5 m above the ground and 1 m apart, that lose nothing as they bounce: what energy
// is won or lost is the step's error. Stresses when an impact is taken to be.
Scene make_bouncing(int size, std::uint64_t /*seed*/)
{
    Scene scene = begin_on_plane("bouncing", size, 0, 1);
    Instances& balls = add_balls(scene, size, 10, 0.1);
    const int side = side_of(size, 2);
    for (int i = 0; i < size; ++i)
        add_record(balls, {{i % side * 1.0, i / side * 1.0, 5}, Quat::Identity()});
    return scene;
}

// SimBenchmark's 666: balls fall from a millimeter, without friction or bounce, and spread over the
// ground. Stresses how hard contacts are: what overlaps is the error.
Scene make_ball_cube(int size, std::uint64_t seed)
{
    return cube_of_balls("ball_cube", size, seed, 0.101, 0);
}

// The same from a meter higher, and nothing is lost: elastic 666. Stresses impacts that come
// together.
Scene make_elastic_ball_cube(int size, std::uint64_t seed)
{
    return cube_of_balls("elastic_ball_cube", size, seed, 1.101, 1);
}

// SimBenchmark's Kapla tower: on each floor eight planks across and nine along them, four on the
// right and five on the left, whose ends lie on half of a plank's width and no more. A size that
// ends within a floor leaves off what would lie higher. Stresses endurance: errors that add up.
//
// The friction is not published; this is what the engine that it was written for has where none is
// set.
Scene make_kapla(int size, std::uint64_t /*seed*/)
{
    constexpr int kFloor = 17, kAcross = 8;
    constexpr double kMass = 10, kHigh = 0.1, kPitch = 0.2, kThick = 0.05;
    Scene scene = begin_on_plane("kapla", size, 0.8, 0);
    const std::uint32_t across =
        add_shape(scene, "plank across", BoxShape{Vec3(kThick, kPitch + kThick, kHigh) / 2});
    const std::uint32_t along =
        add_shape(scene, "plank along", BoxShape{Vec3(kPitch, kThick, kHigh) / 2});
    const double pitches[] = {0.5, 2.5, 4.5, 6.5, 1.5, 3.5, 5.5, 0.5, 6.5};
    scene.bodies.reserve(scene.bodies.size() + static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i) {
        const int place = i % kFloor;
        const bool lies_across = place < kAcross;
        const double low = (2 * (i / kFloor) + 0.5) * kHigh;
        BodyDescription& plank = scene.bodies.emplace_back();
        plank.material = 0;
        plank.mass = kMass;
        plank.shape = lies_across ? across : along;
        if (lies_across)
            plank.position = Vec3(place * kPitch, 0, low);
        else
            plank.position = Vec3(pitches[place - kAcross] * kPitch,
                                  place < kAcross + 4 ? -kPitch / 2 : kPitch / 2, low + kHigh);
    }
    return scene;
}

}  // namespace throng
