// Small scenes for tests of forces: a body that nothing else acts on, a crate on a floor.
#pragma once

#include "throng/world.hpp"

namespace throng::test {

inline Scene empty_scene(Integrator integrator = Integrator::rk4)
{
    Scene scene;
    scene.gravity = Vec3::Zero();
    scene.settings.precision = Precision::double_;
    scene.settings.integrator = integrator;
    scene.settings.dt = 1e-2;
    scene.settings.substeps = 2;
    return scene;
}

// 2 kg, moments 1, 2 and 3 times 0.1 kg m2.
inline BodyDescription& add_body(Scene& scene, const Vec3& position = Vec3::Zero())
{
    BodyDescription body;
    body.mass = 2;
    body.inertia = Sym3{0.1, 0.2, 0.3};
    body.position = position;
    scene.bodies.push_back(body);
    return scene.bodies.back();
}

inline Spring spring_between(std::uint32_t a, std::uint32_t b, double stiffness, double length)
{
    Spring spring;
    spring.a = a;
    spring.b = b;
    spring.stiffness = stiffness;
    spring.length = length;
    return spring;
}

inline void add_floor(Scene& scene, double friction)
{
    scene.materials.push_back({"m", 1000, friction, 0, 0});
    scene.shapes.push_back({"floor", PlaneShape{}});
    scene.shapes.push_back({"crate", BoxShape{Vec3(0.5, 0.5, 0.25)}});
    BodyDescription floor;
    floor.shape = floor.material = 0;
    floor.motion = Motion::static_;
    scene.bodies.push_back(floor);
}

inline BodyDescription& add_crate(Scene& scene, const Vec3& position)
{
    BodyDescription crate;
    crate.shape = 1;
    crate.material = 0;
    crate.mass = 1;
    crate.position = position;
    scene.bodies.push_back(crate);
    return scene.bodies.back();
}

inline double energy(const World& world)
{
    const Measures now = world.measure();
    return now.kinetic_energy + now.potential_energy;
}

}  // namespace throng::test
