// Bent tracks: H99, what slides or rolls over the concave edges of a mesh.
//
// Answer, of what slides without weight or friction round the inside of a tube of n flat strips: at
// each edge it loses what of its velocity looks into the next strip, and goes on at cos(2 pi / n)
// of its speed; so when it passes each of them is known. What rolls in a bowl of triangles wins
// nothing.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kRadius = 1;    // m, of tubes and bowls
constexpr double kDuration = 2;  // s, in a tube

struct Setting {
    const char* name;
    Pose frame = {};
    bool backwards = false;  // the mesh is made last
    bool inward = false;     // wound the other way
    bool steps_far = false;  // by whole steps, in which a fast body passes several edges
    void (*choose)(Settings&) = [](Settings&) {};
};

// About y, from the bottom on; `share` of the way round. Closed where that is 1.
MeshShape pipe(int strips, double share)
{
    MeshShape mesh;
    const bool closed = share == 1;
    const int lines = closed ? strips : strips + 1;
    for (const double y : {-10.0, 10.0})
        for (int i = 0; i < lines; ++i) {
            const double angle = 2 * kPi * share * (closed ? i : i - 0.5 * strips) / strips;
            mesh.vertices.emplace_back(kRadius * std::sin(angle), y, -kRadius * std::cos(angle));
        }
    for (int i = 0; i < strips; ++i) {
        const auto a = static_cast<std::uint32_t>(i),
                   b = static_cast<std::uint32_t>((i + 1) % lines),
                   count = static_cast<std::uint32_t>(lines);
        mesh.triangles.push_back({a, b, count + b});
        mesh.triangles.push_back({a, count + b, count + a});
    }
    return mesh;
}

// The lowest part of a ball seen from inside, up to 1.2 radians from its bottom.
MeshShape bowl()
{
    constexpr std::uint32_t kAround = 64, kRings = 24;
    MeshShape mesh;
    mesh.vertices.emplace_back(0, 0, -kRadius);
    for (std::uint32_t i = 1; i <= kRings; ++i)
        for (std::uint32_t k = 0; k < kAround; ++k) {
            const double down = 1.2 * i / kRings, round = 2 * kPi * k / kAround;
            mesh.vertices.emplace_back(kRadius
                                       * Vec3(std::sin(down) * std::cos(round),
                                              std::sin(down) * std::sin(round), -std::cos(down)));
        }
    const auto at = [](std::uint32_t ring, std::uint32_t k) {
        return 1 + (ring - 1) * kAround + k % kAround;
    };
    for (std::uint32_t k = 0; k < kAround; ++k)
        mesh.triangles.push_back({0, at(1, k), at(1, k + 1)});
    for (std::uint32_t i = 1; i < kRings; ++i)
        for (std::uint32_t k = 0; k < kAround; ++k) {
            mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    return mesh;
}

struct Guest {
    const char* name;
    decltype(ShapeDescription::shape) shape;
    double radius;       // m, from its center to what it lies on
    bool lying = false;  // its axis along y
};

HullShape drum(double radius)
{
    HullShape hull;
    for (int i = 0; i < 48; ++i)
        for (const double z : {-0.15, 0.15})
            hull.points.emplace_back(radius * std::cos(kPi * i / 24),
                                     radius * std::sin(kPi * i / 24), z);
    return hull;
}

Scene met(const CaseBench& bench,
          const Setting& setting,
          MeshShape mesh,
          double friction,
          const Guest& guest,
          const Pose& at,
          const Vec3& velocity)
{
    if (setting.inward)
        for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    setting.choose(scene.settings);
    scene.settings.sleep = false;
    BodyDescription body, still;
    body.material = still.material = parts.material(friction);
    body.shape = add_shape(scene, "guest", guest.shape);
    still.shape = add_shape(scene, "mesh", std::move(mesh));
    still.motion = Motion::static_;
    still.position = setting.frame.position;
    still.orientation = setting.frame.orientation;
    const Quat lies = turn(Vec3::UnitX(), guest.lying ? kPi / 2 : 0);
    const Pose placed = setting.frame * Pose{at.position, at.orientation * lies};
    body.position = placed.position;
    body.orientation = placed.orientation;
    body.velocity = setting.frame.orientation * velocity;
    scene.gravity = setting.frame.orientation * Vec3(0, 0, -kGravity);
    scene.bodies = {still, body};
    if (setting.backwards) std::swap(scene.bodies[0], scene.bodies[1]);
    return parts.scene();
}

// m/s, after so many seconds from the middle of a strip.
double speed_round(int strips, double along, double speed, double duration)
{
    const double kept = std::cos(2 * kPi / strips);
    double left = duration, way = along / 2;
    while (way < left * speed) {
        left -= way / speed;
        speed *= kept;
        way = along;
    }
    return speed;
}

void slide_round(
    CaseBench& bench, const Setting& setting, int strips, double speed, const Guest& guest)
{
    const double angle = kPi / strips, off = kRadius * std::cos(angle) - guest.radius;
    const Pose at{off * Vec3(std::sin(angle), 0, -std::cos(angle)), Quat::Identity()};
    Scene scene = met(bench, setting, pipe(strips, 1), 0, guest, at,
                      speed * Vec3(std::cos(angle), 0, std::sin(angle)));
    scene.gravity = Vec3::Zero();
    double now = 0;
    bench.run(scene, kDuration, [&](World& world, double) {
        const auto ids = world.bodies();
        now = world.velocity(setting.backwards ? ids.front() : ids.back()).norm();
        return true;
    });
    const double exact = speed_round(strips, 2 * off * std::tan(angle), speed, kDuration);
    bench.report(std::string(guest.name) + " in a tube of " + std::to_string(strips) + " strips at "
                     + std::to_string(static_cast<int>(speed)) + " m/s, " + setting.name,
                 "speed, error", std::abs(now - exact) / exact, 0.01, "1");
}

void roll(CaseBench& bench,
          const Setting& setting,
          const MeshShape& mesh,
          const char* where,
          double friction,
          const Guest& guest)
{
    const double angle = 0.6, off = kRadius - 1.3 * guest.radius;
    const Pose at{off * Vec3(std::sin(angle), 0, -std::cos(angle)), turn(Vec3::UnitY(), -angle)};
    EnergyLedger ledger;
    bench.run(
        met(bench, setting, mesh, friction, guest, at, Vec3::Zero()), bench.brief() ? 4 : 20,
        [](World&, double) { return true; }, &ledger);
    const std::string which = std::string(guest.name) + " in a " + where + ", " + setting.name;
    const double most = ledger.greatest_kinetic();
    bench.report(which, "energy won over the greatest of motion",
                 std::max(0.0, ledger.net()) / most, 1e-6, "1");
    // Soft contacts give back what they took.
    bench.report(which, "the same at any time", ledger.gained() / most, 2e-3, "1");
}

}  // namespace

void case_bent_tracks(CaseBench& bench)
{
    const Quat turned = exponential(Vec3(0.3, -0.5, 0.7));
    const Setting all[] = {
        {.name = "default"},
        {.name = "dt 1/240", .choose = [](Settings& s) { s.dt = 1.0 / 240; }},
        {.name = "dt 1e-3", .choose = [](Settings& s) { s.dt = 1e-3; }},
        {.name = "16 substeps", .choose = [](Settings& s) { s.substeps = 16; }},
        {.name = "double", .choose = [](Settings& s) { s.precision = Precision::double_; }},
        {.name = "pgs", .steps_far = true, .choose = [](Settings& s) { s.solver = Solver::pgs; }},
        {.name = "direct",
         .steps_far = true,
         .choose = [](Settings& s) { s.solver = Solver::direct; }},
        {.name = "turned", .frame = {Vec3::Zero(), turned}},
        {.name = "far off", .frame = {Vec3(3e3, -1e3, 2e3), turned}},
        {.name = "made last", .backwards = true},
        {.name = "wound inward", .inward = true},
    };
    const Guest ball{"ball", SphereShape{0.1}, 0.1}, pea{"pea", SphereShape{0.02}, 0.02},
        capsule{"capsule", CapsuleShape{0.1, 0.15}, 0.1, true},
        cylinder{"cylinder", CylinderShape{0.1, 0.15}, 0.1, true},
        barrel{"drum of 48 sides", drum(0.1), 0.1, true},
        block{"block", BoxShape{Vec3(0.1, 0.1, 0.05)}, 0.08};
    const MeshShape of_triangles = bowl(), half_pipe = pipe(64, 0.5);
    for (const Setting& setting : all) {
        slide_round(bench, setting, 16, 5, ball);
        slide_round(bench, setting, 64, 5, ball);
        slide_round(bench, setting, 64, 5, capsule);
        slide_round(bench, setting, 64, 3, pea);
        slide_round(bench, setting, 200, 1, ball);
        if (!setting.steps_far) slide_round(bench, setting, 200, 5, ball);
        for (const Guest& guest : {ball, capsule, cylinder, barrel}) {
            roll(bench, setting, of_triangles, "bowl", 0.8, guest);
            roll(bench, setting, half_pipe, "half pipe", 0.8, guest);
        }
        roll(bench, setting, half_pipe, "smooth half pipe", 0, block);
        if (bench.brief()) return;
    }
}

}  // namespace throng
