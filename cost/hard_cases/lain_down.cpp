// Lain down: H113, bodies of flat and of round sides that fall on a floor and lie still, never
// overlapping.
//
// Answer: at rest.
//
// Held at its lowest corner alone a body tips over to the next, and back, in every piece of every
// step, as does what rolls on its rim; and what a spring draws down has gone before what lies on it
// begins to fall.
#include "cost/hard_cases/floors.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/random.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace throng {

namespace {

constexpr double kSize = 0.3;  // m, of a body across
constexpr double kSeconds = 4;
constexpr double kStill = 1e-4;  // m/s
constexpr FloorSize kFloor{10, kSize, 20};

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    int seeds = 3;
    bool by_halves = false;
};

void add_body(SceneParts& parts, const std::string& kind, const BodyDescription& body)
{
    if (kind == "ring") {
        parts.add(mesh_shape(torus_mesh(kSize, kSize / 3, 16, 8)), body);
    } else if (kind == "disc") {
        parts.add(CylinderShape{kSize, kSize / 20}, body);
    } else if (kind == "plate") {
        parts.add(BoxShape{Vec3(kSize, kSize / 2, kSize / 20)}, body);
    } else {
        Scene& scene = parts.scene();
        const auto bar = static_cast<std::uint32_t>(scene.shapes.size());
        scene.shapes.push_back({"bar", BoxShape{Vec3(kSize, kSize / 8, kSize / 8)}});
        CompoundShape cross;
        cross.parts.push_back({bar, Pose{}});
        cross.parts.push_back({bar, {Vec3::Zero(), Quat(std::sqrt(0.5), 0, 0, std::sqrt(0.5))}});
        parts.add(cross, body);
    }
}

// m/s, of the fastest at the end, its turning told at its rim.
double speed(const World& world)
{
    double most = 0;
    for (const BodyId body : world.bodies())
        most = std::max(most,
                        world.velocity(body).norm() + kSize * world.angular_velocity(body).norm());
    return most;
}

struct End {
    double speed = 0;   // m/s
    double waited = 0;  // times that work came to its end
};

void run(CaseBench& bench, const Scene& scene, End& worst)
{
    double at_end = 0, waited = 0;
    bench.run(scene, bench.brief() ? 1.5 : kSeconds, [&](World& world, double) {
        at_end = speed(world);
        waited = static_cast<double>(world.report().fallbacks);
        return true;
    });
    worst.speed = std::max(worst.speed, at_end);
    worst.waited += waited;
}

End fall(CaseBench& bench, const How& how, const std::string& kind, Floor floor)
{
    End worst;
    for (int seed = 0; seed < (bench.brief() ? 1 : how.seeds); ++seed) {
        Random random(static_cast<std::uint64_t>(seed));
        SceneParts parts(bench.scene());
        parts.scene().settings.overlap = Overlap::back_up;
        how.set(parts.scene().settings);
        const std::uint32_t material = parts.material(0.5);
        put_floor(parts, material, floor, Pose{}, kFloor);
        BodyDescription body;
        body.material = material;
        body.mass = 1;
        body.position = Vec3(0, 0, 1.3 * kSize);
        body.orientation = random_turn(random, 0.6);
        add_body(parts, kind, body);
        run(bench, parts.scene(), worst);
    }
    return worst;
}

// Boxes one on another, the lowest drawn down by a spring with as much as `times` its weight.
End press(CaseBench& bench, const How& how, double times)
{
    constexpr double kMass = 1, kStretch = 0.01;  // kg, m
    End worst;
    SceneParts parts(bench.scene());
    parts.scene().settings.overlap = Overlap::back_up;
    how.set(parts.scene().settings);
    const std::uint32_t material = parts.material(0.5);
    parts.plane(material, Vec3::UnitZ(), 0);
    for (int i = 0; i < 4; ++i)
        parts.box(material, kMass, Vec3::Constant(kSize / 2),
                  {Vec3(0, 0, kSize / 2 + (kSize + 1e-4) * i), Quat::Identity()});
    Spring spring;
    spring.a = 1;
    spring.length = kSize / 2 - kStretch;
    spring.stiffness = times * kMass * kGravity / kStretch;
    spring.damping = 0.1 * std::sqrt(spring.stiffness * kMass);
    parts.scene().springs.push_back(spring);
    run(bench, parts.scene(), worst);
    return worst;
}

}  // namespace

void case_lain_down(CaseBench& bench)
{
    const How hows[] = {
        {"default"},
        {"default, dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }, 1},
        {"1 substep", [](Settings& s) { s.substeps = 1; }},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }, 1},
        {"double", [](Settings& s) { s.precision = Precision::double_; }, 1},
        {"subdivide", [](Settings& s) { s.overlap = Overlap::subdivide; }, 1, true},
    };
    for (const How& how : hows) {
        const auto report = [&](const std::string& what, const End& end) {
            bench.report(how.setting, what + ": speed at the end", end.speed, kStill, "m/s");
            // Of pieces that end too deep by what the shortest goes, subdivide tells as well.
            if (how.by_halves) return;
            bench.report(how.setting, what + ": times that work came to its end", end.waited, 0,
                         "1");
        };
        for (const char* kind : {"ring", "disc", "plate", "cross"})
            for (const Floor floor : {Floor::plane, Floor::box, Floor::grid})
                report(std::string(kind) + " on a " + name_of(floor),
                       fall(bench, how, kind, floor));
        for (const double times : {10.0, 1e4})
            report(times > 100 ? "boxes, drawn down hard" : "boxes, drawn down",
                   press(bench, how, times));
        if (bench.brief()) return;
    }
}

}  // namespace throng
