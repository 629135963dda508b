// Flat bounces: H95, who falls flat comes up flat, on a floor of any kind and of shapes of any
// number.
//
// Answer: all that meets the floor meets it at once. A body that falls flat by a height h bounces
// off by e2 h and does not turn, however many triangles, tiles or shapes of its own it falls on.
#include "cost/hard_cases/floors.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kHigh = 1, kHalf = 0.2;  // m, by which they fall; half of their height
constexpr const char* kBodies[] = {"box", "cylinder", "hull", "capsule", "two boxes", "table"};
constexpr Floor kSeamed[] = {Floor::mesh, Floor::grid, Floor::tiles};

struct Bounce {
    const char* how = "";
    double restitution = 0.5;
    Vec3 at = Vec3::Zero();
    double slant = 0;   // rad, of floor and gravity alike
    bool last = false;  // the floor is made after what falls
    void (*choose)(Settings&) = [](Settings&) {};
};

CompoundShape of_boxes(Scene& scene, const Vec3& half, const std::vector<Vec3>& at)
{
    const auto part = static_cast<std::uint32_t>(scene.shapes.size());
    scene.shapes.push_back({"part", BoxShape{half}});
    CompoundShape compound;
    for (const Vec3& place : at) compound.parts.push_back({part, {place, Quat::Identity()}});
    return compound;
}

std::uint32_t put_body(SceneParts& parts, std::uint32_t material, int kind, const Pose& pose)
{
    const std::uint32_t id = parts.box(material, 10, Vec3(0.3, 0.3, kHalf), pose);
    Scene& scene = parts.scene();
    const std::uint32_t shape = scene.bodies[id].shape;
    const auto choose = [&](auto of) { scene.shapes[shape].shape = std::move(of); };
    if (kind == 1) choose(CylinderShape{0.3, kHalf});
    if (kind == 2) {
        HullShape hull;
        for (int i = 0; i < 7; ++i)
            for (const double z : {-kHalf, kHalf})
                hull.points.emplace_back(0.3 * std::cos(2 * kPi * i / 7),
                                         0.3 * std::sin(2 * kPi * i / 7), z);
        choose(hull);
    }
    if (kind == 3) {
        choose(CapsuleShape{kHalf, 0.4});
        Quat& turn = scene.bodies[id].orientation;
        turn = turn * exponential(Vec3(kPi / 2, 0, 0));
    }
    if (kind == 4)
        choose(of_boxes(scene, Vec3(0.3, 0.1, kHalf), {Vec3(0, 0.2, 0), Vec3(0, -0.2, 0)}));
    if (kind == 5)
        choose(of_boxes(
            scene, Vec3(0.03, 0.04, kHalf),
            {Vec3(0.3, 0.2, 0), Vec3(-0.3, 0.2, 0), Vec3(0.3, -0.2, 0), Vec3(-0.3, -0.2, 0)}));
    return id;
}

// What falls is over seams of all that have some.
FloorSize size_of(Floor floor)
{
    return floor == Floor::tiles ? FloorSize{4, 0.5, 8} : FloorSize{3.7, 0.5, 20};
}

void bounce(CaseBench& bench, int kind, Floor floor, const Bounce& how)
{
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    how.choose(scene.settings);
    const std::uint32_t material = parts.material(0.3, how.restitution);
    const Pose frame{how.at, exponential(Vec3(0.28, 0.96, 0) * how.slant)};
    scene.gravity = frame.orientation * Vec3(0, 0, -kGravity);
    if (!how.last) put_floor(parts, material, floor, frame, size_of(floor));
    const std::uint32_t id = put_body(parts, material, kind,
                                      {frame * Vec3(0.03, 0.02, kHalf + kHigh),
                                       frame.orientation * exponential(Vec3(0, 0, 0.2))});
    if (how.last) put_floor(parts, material, floor, frame, size_of(floor));
    const Vec3 up = frame.orientation * Vec3::UnitZ();
    // Its energy between the first bounce and the second tells how high it goes.
    const double lands = std::sqrt(2 * kHigh / kGravity);
    const double time = lands * (1 + how.restitution);
    double height = 0, spin = 0;
    bench.run(scene, time, [&](World& world, double) {
        const BodyId body = world.bodies()[id];
        const double speed = up.dot(world.velocity(body));
        height = up.dot(world.pose(body).position - frame.position) - kHalf
            + speed * speed / (2 * kGravity);
        spin = world.angular_velocity(body).norm();
        return true;
    });
    const std::string setting = std::string(kBodies[kind]) + " on " + name_of(floor) + how.how;
    const double wanted = how.restitution * how.restitution * kHigh;
    bench.report(setting, "error of the height of its bounce", std::abs(height / wanted - 1), 0.06,
                 "1");
    bench.report(setting, "spin that it comes up with", spin, 1e-2, "rad/s");
}

}  // namespace

void case_flat_bounces(CaseBench& bench)
{
    constexpr int kKinds = std::size(kBodies);
    for (int kind = 0; kind < kKinds; ++kind) {
        for (const Floor floor : kSeamed)
            if (!bench.brief() || floor != Floor::mesh) bounce(bench, kind, floor, {});
        if (bench.brief()) continue;
        for (const Floor floor : {Floor::plane, Floor::box}) bounce(bench, kind, floor, {});
    }
    if (bench.brief()) return;
    const Bounce ways[] = {
        {.how = ", e = 1", .restitution = 1},
        {.how = ", dt 1/240", .choose = [](Settings& settings) { settings.dt = 1.0 / 240; }},
        {.how = ", dt 1e-3", .choose = [](Settings& settings) { settings.dt = 1e-3; }},
        {.how = ", 16 substeps", .choose = [](Settings& settings) { settings.substeps = 16; }},
        {.how = ", pgs", .choose = [](Settings& settings) { settings.solver = Solver::pgs; }},
        {.how = ", direct", .choose = [](Settings& s) { s.solver = Solver::direct; }},
        {.how = ", turned", .slant = 1.1},
        {.how = ", far off", .at = Vec3(3e4, -1e4, 2e4)},
        {.how = ", made last", .last = true},
    };
    for (const int kind : {0, 4, 5})
        for (const Bounce& way : ways) {
            bounce(bench, kind, Floor::plane, way);
            for (const Floor floor : kSeamed) bounce(bench, kind, floor, way);
        }
    Bounce held{.how = ", back_up"};
    held.choose = [](Settings& settings) { settings.overlap = Overlap::back_up; };
    for (int kind = 0; kind < kKinds; ++kind)
        for (const Floor floor : {Floor::plane, Floor::mesh}) bounce(bench, kind, floor, held);
}

}  // namespace throng
