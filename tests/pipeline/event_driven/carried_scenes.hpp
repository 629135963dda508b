// Carried scenes: those that back_up and subdivide are tested on, and what is read off them.
#pragma once

#include "tests/support/small_scenes.hpp"

#include <algorithm>

namespace throng::given {

inline SceneOf carried(Overlap overlap, double friction, double restitution)
{
    SceneOf made;
    made.scene.settings.overlap = overlap;
    made.scene.settings.precision = Precision::double_;
    made.scene.settings.substeps = 1;
    made.scene.materials[0].friction = friction;
    made.scene.materials[0].restitution = restitution;
    return made;
}

inline Vec3 place_of(const World& world, std::size_t i)
{
    return world.pose(world.bodies()[i]).position;
}
inline Vec3 velocity_of(const World& world, std::size_t i)
{
    return world.velocity(world.bodies()[i]);
}

inline double energy_of(const World& world)
{
    const Measures measures = world.measure();
    return measures.kinetic_energy + measures.potential_energy;
}

// The least distance between any two of balls of one radius, and of them from the floor.
inline double least_separation(const World& world, std::size_t first, double radius)
{
    double least = 1e30;
    for (std::size_t i = first; i < world.bodies().size(); ++i) {
        least = std::min(least, place_of(world, i).z() - radius);
        for (std::size_t k = first; k < i; ++k)
            least = std::min(least, (place_of(world, i) - place_of(world, k)).norm() - 2 * radius);
    }
    return least;
}

inline Scene row_of_balls(Overlap overlap)
{
    SceneOf made = carried(overlap, 0, 1);
    made.scene.gravity = Vec3::Zero();
    made.scene.settings.dt = 0.1;
    for (int i = 0; i < 3; ++i) made.ball(0.5, Vec3(2 * i, 0, 0));
    made.scene.bodies[0].velocity = Vec3(100, 0, 0);
    return made.scene;
}

// Balls over a floor, of which some strike others in the air.
inline Scene heap_of_balls(Overlap overlap, double restitution)
{
    SceneOf made = carried(overlap, 0.3, restitution);
    made.scene.settings.dt = 0.01;
    made.floor();
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j)
                made.ball(0.1, Vec3(0.21 * i + 0.003 * j, 0.21 * k - 0.002 * j, 0.2 + 0.21 * j));
    return made.scene;
}

// Boxes of a meter, a millimeter over one another.
inline Scene stack_of_boxes(Overlap overlap, int boxes)
{
    SceneOf made = carried(overlap, 0.5, 0);
    made.scene.settings.dt = 1.0 / 60;
    made.floor();
    for (int i = 0; i < boxes; ++i) made.box(Vec3::Constant(0.5), Vec3(0, 0, 0.501 + 1.001 * i));
    return made.scene;
}

inline Scene tumbling_boxes(Overlap overlap)
{
    SceneOf made = carried(overlap, 0.4, 0.3);
    made.scene.settings.dt = 0.01;
    made.floor();
    for (int i = 0; i < 4; ++i) {
        BodyDescription& box = made.box(Vec3(0.3, 0.2, 0.1), Vec3(0.1 * i, 0, 0.5 + 0.7 * i));
        box.angular_velocity = Vec3(3, 2.0 * i, 1);
    }
    return made.scene;
}

// A platform that rises and moves along, with a box on it.
inline Scene box_on_a_lift(Overlap overlap)
{
    SceneOf made = carried(overlap, 0.8, 0);
    made.scene.settings.dt = 0.01;
    BodyDescription& lift = made.box(Vec3(1, 1, 0.1), Vec3(0, 0, -0.1));
    lift.motion = Motion::kinematic;
    lift.velocity = Vec3(0.2, 0, 1);
    made.box(Vec3(0.2, 0.2, 0.2), Vec3(0, 0, 0.2001));
    return made.scene;
}

}  // namespace throng::given
