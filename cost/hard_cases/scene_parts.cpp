#include "cost/hard_cases/hard_cases.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace throng {

double energy_made(CaseBench& bench,
                   const Scene& scene,
                   double seconds,
                   const std::function<void(World&, double)>& watch)
{
    EnergyLedger ledger;
    bool sound = true;
    bench.run(
        scene, seconds,
        [&](World& world, double now) {
            watch(world, now);
            sound = world.report().bodies_quarantined == 0;
            return sound;
        },
        &ledger);
    return sound ? ledger.gained() / ledger.greatest_kinetic()
                 : std::numeric_limits<double>::infinity();
}

Stands stand_for(CaseBench& bench, const Scene& scene, double seconds)
{
    Stands stands;
    bench.run(scene, seconds, [&](World& world, double now) {
        if (now < seconds - 0.1) return true;
        const std::vector<BodyId> bodies = world.bodies();
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            stands.speed = std::max(stands.speed, world.velocity(bodies[i]).norm());
            const Vec3 off = world.pose(bodies[i]).position - scene.bodies[i].position;
            stands.moved = std::max(stands.moved, off.norm());
        }
        stands.deep = std::max(stands.deep, world.measure().greatest_overlap);
        return true;
    });
    return stands;
}

void ask_exactly(Settings& settings)
{
    settings.solver = Solver::direct;
    settings.precision = Precision::double_;
    settings.substeps = 1;
}

std::uint32_t SceneParts::material(double friction, double restitution)
{
    Material material;
    material.name = "m" + std::to_string(scene_.materials.size());
    material.friction = friction;
    material.restitution = restitution;
    scene_.materials.push_back(material);
    return static_cast<std::uint32_t>(scene_.materials.size() - 1);
}

std::uint32_t SceneParts::level_ground(std::uint32_t material, const Pose& place)
{
    const Vec3 up = place.orientation * Vec3::UnitZ();
    scene_.gravity = place.orientation * Vec3(0, 0, -kGravity);
    return plane(material, up, up.dot(place.position));
}

void SceneParts::hold(std::uint32_t id, Motion motion)
{
    body(id).motion = motion;
    body(id).mass.reset();
}

void SceneParts::pair_materials(std::uint32_t a, std::uint32_t b, double friction)
{
    scene_.pairs.push_back({a, b, friction, std::nullopt});
}

std::uint32_t SceneParts::add(decltype(ShapeDescription::shape) shape, BodyDescription body)
{
    body.shape = static_cast<std::uint32_t>(scene_.shapes.size());
    scene_.shapes.push_back({"s" + std::to_string(body.shape), std::move(shape)});
    scene_.bodies.push_back(std::move(body));
    return static_cast<std::uint32_t>(scene_.bodies.size() - 1);
}

std::uint32_t SceneParts::plane(std::uint32_t material, const Vec3& normal, double offset)
{
    BodyDescription body;
    body.motion = Motion::static_;
    body.material = material;
    return add(PlaneShape{normal, offset}, body);
}

std::uint32_t
SceneParts::box(std::uint32_t material, double mass, const Vec3& half_extents, const Pose& pose)
{
    BodyDescription body;
    body.material = material;
    body.mass = mass;
    body.position = pose.position;
    body.orientation = pose.orientation;
    return add(BoxShape{half_extents}, body);
}

std::uint32_t SceneParts::ball(std::uint32_t material, double mass, double radius, const Vec3& at)
{
    BodyDescription body;
    body.material = material;
    body.mass = mass;
    body.position = at;
    return add(SphereShape{radius}, body);
}

std::uint32_t
SceneParts::hull(std::uint32_t material, double mass, HullShape shape, const Pose& pose)
{
    BodyDescription body;
    body.material = material;
    body.mass = mass;
    body.position = pose.position;
    body.orientation = pose.orientation;
    return add(std::move(shape), body);
}

std::uint32_t SceneParts::cylinder(
    std::uint32_t material, double mass, double radius, double half_length, const Pose& pose)
{
    BodyDescription body;
    body.material = material;
    body.mass = mass;
    body.position = pose.position;
    body.orientation = pose.orientation;
    return add(CylinderShape{radius, half_length}, body);
}

}  // namespace throng
