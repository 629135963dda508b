// Small scenes: worlds of a few bodies, in one line each, for tests of the step.
#pragma once

#include "throng/world.hpp"

#include <cmath>
#include <string>

namespace throng::given {

/// A scene that is filled in piece by piece.
class SceneOf {
public:
    SceneOf() { scene.materials.push_back({.name = "stuff", .friction = 0.5}); }

    template <class Shape>
    std::uint32_t shape(Shape kind)
    {
        scene.shapes.push_back({"", kind});
        return static_cast<std::uint32_t>(scene.shapes.size() - 1);
    }
    BodyDescription& body(std::uint32_t shape_index, const Vec3& position)
    {
        BodyDescription made;
        made.shape = shape_index;
        made.material = 0;
        made.position = position;
        scene.bodies.push_back(made);
        return scene.bodies.back();
    }
    BodyDescription& floor()
    {
        BodyDescription& made = body(shape(PlaneShape{}), Vec3::Zero());
        made.motion = Motion::static_;
        return made;
    }
    BodyDescription& box(const Vec3& half, const Vec3& position)
    {
        return body(shape(BoxShape{half}), position);
    }
    BodyDescription& ball(double radius, const Vec3& position)
    {
        return body(shape(SphereShape{radius}), position);
    }

    Scene scene;
};

/// A floor, towers of boxes and balls of different sizes, a ramp, a mesh, a platform that turns and
/// a walker that is driven: most effects at once.
inline Scene mixed_scene()
{
    SceneOf made;
    made.scene.materials[0].restitution = 0.2;
    made.scene.materials[0].rolling_friction = 0.01;
    made.floor();
    for (int tower = 0; tower < 3; ++tower)
        for (int i = 0; i < 4; ++i)
            made.box(Vec3(0.5, 0.4, 0.3), Vec3(2.5 * tower, 0.01 * i, 0.3 + 0.61 * i));
    for (int i = 0; i < 6; ++i) made.ball(0.2 + 0.02 * i, Vec3(0.7 * i, 2, 0.5 + 0.3 * i));
    for (int i = 0; i < 4; ++i)
        made.body(made.shape(CapsuleShape{0.2, 0.3}), Vec3(1.0 * i, -2, 0.6)).angular_velocity =
            Vec3(1, 2, 3);
    BodyDescription& platform = made.box(Vec3(1, 1, 0.1), Vec3(-4, 0, 0.5));
    platform.motion = Motion::kinematic;
    platform.angular_velocity = Vec3(0, 0, 1);
    made.box(Vec3(0.2, 0.2, 0.2), Vec3(-4, 0.3, 0.81));
    BodyDescription& walker = made.body(made.shape(CapsuleShape{0.3, 0.5}), Vec3(0, 5, 0.8));
    walker.lock_rotation = true;
    walker.drive_velocity = {1.0, 0.0, std::nullopt};
    MeshShape mesh;
    mesh.vertices = {Vec3(-3, -3, 0.2), Vec3(3, -3, 0.2), Vec3(3, 3, 0.5), Vec3(-3, 3, 0.5)};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    made.body(made.shape(mesh), Vec3(8, 8, 0)).motion = Motion::static_;
    for (int i = 0; i < 3; ++i) made.box(Vec3(0.3, 0.3, 0.3), Vec3(7 + i, 8, 1));
    return made.scene;
}

inline double greatest_speed(const World& world)
{
    double greatest = 0;
    for (const BodyId body : world.bodies())
        greatest =
            std::max({greatest, world.velocity(body).norm(), world.angular_velocity(body).norm()});
    return greatest;
}

inline std::string hash_after(const Scene& scene, int threads, int steps, bool in_order = false)
{
    World world(scene, threads);
    world.run_in_order(in_order);
    world.step(steps);
    return world.state_hash();
}

}  // namespace throng::given
