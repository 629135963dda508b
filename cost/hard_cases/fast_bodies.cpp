// Fast bodies: H38 a bullet and a plate, H39 a rod that turns, H40 two that meet.
//
// Answers: the geometry says when they first touch. Asked of each method of the dial toi_method,
// whose error is at most the time in which the tolerance is crossed; then a world is run with it,
// in which nothing may get through.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/dials.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kSpeed = 1000;  // m/s

// Each method in turn, by the dial's own words.
void for_each_method(const std::function<void(std::string_view, ToiMethod)>& body)
{
    for (const Choice& choice : find_dial("toi_method")->choices) {
        Settings settings;
        set_dial(settings, "toi_method", choice.text);
        body(choice.text, settings.toi_method);
    }
}

// When two meet, s, and how fast they come together then, m/s.
struct KnownImpact {
    double time, speed;
};

// What a method tells of a meeting that is known: how late, how early, and what it took.
void judge(CaseBench& bench,
           const char* setting,
           const ImpactQuery& query,
           const ShapeMotion& a,
           const ShapeMotion& b,
           double duration,
           const KnownImpact& truth)
{
    for_each_method([&](std::string_view name, ToiMethod method) {
        const ImpactAnswer answer = bench.ask_impact(query, method, a, b, duration);
        const double off = answer.meets ? answer.time - truth.time : duration;
        // The times themselves are rounded, and so is the truth.
        const double rounding = 1e-14 * duration;
        const double within = bench.settings().toi_tolerance * query.size() / truth.speed;
        bench.report_method(name, setting, "late", std::max(0.0, off), rounding, "s");
        bench.report_method(name, setting, "early", std::max(0.0, -off), within + rounding, "s");
        bench.report_method(name, setting, "evaluations", answer.evaluations, 1e3, "1");
    });
}

void judge_miss(CaseBench& bench,
                const char* setting,
                const ImpactQuery& query,
                const ShapeMotion& a,
                const ShapeMotion& b,
                double duration)
{
    for_each_method([&](std::string_view name, ToiMethod method) {
        const ImpactAnswer answer = bench.ask_impact(query, method, a, b, duration);
        bench.report_method(name, setting, "told to meet", answer.meets ? 1 : 0, 0, "1");
    });
}

ShapeDescription sheet()
{
    MeshShape mesh;
    mesh.vertices = {{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}};  // faces -x, where they come from
    return {"", mesh};
}

ShapeDescription ball(double radius) { return {"", SphereShape{radius}}; }
ShapeDescription box(const Vec3& half) { return {"", BoxShape{half}}; }

std::uint32_t add_body(Scene& scene, const ShapeDescription& shape, const ShapeMotion& motion)
{
    scene.shapes.push_back(shape);
    BodyDescription body;
    body.shape = static_cast<std::uint32_t>(scene.shapes.size() - 1);
    body.material = 0;
    body.position = motion.pose.position;
    body.orientation = motion.pose.orientation;
    body.velocity = motion.velocity;
    body.angular_velocity = motion.angular_velocity;
    scene.bodies.push_back(body);
    return static_cast<std::uint32_t>(scene.bodies.size() - 1);
}

void add_still(Scene& scene, const ShapeDescription& shape, const Vec3& position)
{
    ShapeMotion motion;
    motion.pose.position = position;
    scene.bodies[add_body(scene, shape, motion)].motion = Motion::static_;
}

Scene weightless(const CaseBench& bench, double dt, ToiMethod method, double restitution)
{
    Scene scene = bench.scene();
    scene.gravity = Vec3::Zero();
    scene.settings.dt = dt;
    scene.settings.toi_method = method;
    scene.materials.push_back({.name = "steel", .friction = 0, .restitution = restitution});
    return scene;
}

ShapeMotion moving(const Vec3& position, const Vec3& velocity)
{
    ShapeMotion motion;
    motion.pose.position = position;
    motion.velocity = velocity;
    return motion;
}

// What flies, and half its extent along x.
struct Flyer {
    ShapeDescription shape;
    ShapeMotion motion;
    double half;  // m
};

// What stands at x = 0, and where its face is.
struct Obstacle {
    ShapeDescription shape;
    double face;  // m
};

// Runs a body against what stands in its way and shows how far its front came past the face.
void run_against(CaseBench& bench,
                 const std::string& setting,
                 const Flyer& flyer,
                 const Obstacle& obstacle,
                 double dt)
{
    for_each_method([&](std::string_view name, ToiMethod method) {
        Scene scene = weightless(bench, dt, method, 0);
        add_still(scene, obstacle.shape, Vec3::Zero());
        scene.bodies[add_body(scene, flyer.shape, flyer.motion)].fast = true;
        double deepest = -1e30;
        bench.run(scene, 0.25, [&](World& world, double) {
            const double x = world.pose(world.bodies().back()).position.x();
            deepest = std::max(deepest, x + flyer.half - obstacle.face);
            return true;
        });
        // A hundredth of its half extent is what contacts may give while they stop it.
        bench.report(std::string(name) + ", " + setting, "depth past the face over half extent",
                     std::max(0.0, deepest) / flyer.half, 1e-2, "1");
    });
}

}  // namespace

void case_bullet_plate(CaseBench& bench)
{
    const double radius = 0.005, half_thickness = 0.0005;
    const ShapeDescription bullet = ball(radius), plate = box({half_thickness, 1, 1});
    const ShapeMotion flight = moving({-10, 0.1, 0.2}, {kSpeed, 0, 0}), still;
    judge(bench, "plate of 1 mm", ImpactQuery(bullet, plate), flight, still, 1.0 / 60,
          {(10 - radius - half_thickness) / kSpeed, kSpeed});
    judge(bench, "sheet of triangles", ImpactQuery(bullet, sheet()), flight, still, 1.0 / 60,
          {(10 - radius) / kSpeed, kSpeed});
    const Flyer shot{bullet, flight, radius};
    for (const auto& [name, dt] :
         {std::pair("dt=1/60", 1.0 / 60), std::pair("dt=1/240", 1.0 / 240)}) {
        run_against(bench, std::string("plate of 1 mm, ") + name, shot, {plate, -half_thickness},
                    dt);
        run_against(bench, std::string("sheet of triangles, ") + name, shot, {sheet(), 0}, dt);
    }
    run_against(bench, "cube of 1 m from 5 m, dt=0.01",
                {box(Vec3::Constant(0.5)), moving({-5, 0, 0}, {kSpeed, 0, 0}), 0.5},
                {plate, -half_thickness}, 0.01);
}

void case_spinning_rod(CaseBench& bench)
{
    const double spin = 50 * kPi, wall = 0.6;
    // Along y, about z, so that it turns towards +x.
    ShapeMotion turning, still;
    turning.pose.orientation = exponential(Vec3(-kPi / 2, 0, 0));
    turning.angular_velocity = Vec3(0, 0, -spin);
    still.pose.position = Vec3(wall + 0.05, 0, 0);
    const ShapeDescription slab = box({0.05, 3, 3});
    for (const auto& [name, radius] :
         {std::pair("line", 1e-7), std::pair("capsule r=0.02", 0.02)}) {
        const double sine = wall - radius;
        judge(bench, name, ImpactQuery({"", CapsuleShape{radius, 1}}, slab), turning, still,
              1.0 / 60, {std::asin(sine) / spin, spin * std::sqrt(1 - sine * sine)});
    }

    // A stick of 4 m that comes down on a wall of 0.25 m, at spins from none to 50 rad/s.
    for_each_method([&](std::string_view name, ToiMethod method) {
        double deepest = 0;
        for (int i = 0; i <= (bench.brief() ? 2 : 10); ++i) {
            Scene scene = weightless(bench, 1.0 / 60, method, 0);
            add_still(scene, box({0.125, 40, 40}), Vec3::Zero());
            ShapeMotion stick = moving({-20, 0, 0}, {100, 0, 0});
            stick.angular_velocity = Vec3(0, 0, bench.brief() ? 25 * i : 5 * i);
            scene.bodies[add_body(scene, box({0.1, 2, 0.1}), stick)].fast = true;
            bench.run(scene, 1, [&](World& world, double) {
                const double x = world.pose(world.bodies().back()).position.x();
                deepest = std::max(deepest, x + 0.125);
                return true;
            });
        }
        // Its middle is at least its half thickness from the face while no part of it is through.
        bench.report(std::string(name) + ", stick of 4 m at 100 m/s, to 50 rad/s",
                     "way of its middle past the face", deepest, 0, "m");
    });
}

namespace {

// Two balls on ways side by side: how near they come to having changed places, and how their
// velocities differ from those they began with.
void run_pair(CaseBench& bench, const std::string& setting, double offset, bool hits)
{
    for_each_method([&](std::string_view name, ToiMethod method) {
        Scene scene = weightless(bench, 1.0 / 60, method, 1);
        for (const double side : {-1.0, 1.0})
            add_body(scene, ball(0.01),
                     moving({5 * side, side > 0 ? offset : 0.0, 0}, {-kSpeed * side, 0, 0}));
        double change = 0, momentum = 0;
        bench.run(scene, 0.1, [&](World& world, double) {
            const auto bodies = world.bodies();
            const Vec3 a = world.velocity(bodies[0]), b = world.velocity(bodies[1]);
            change = (a - Vec3(kSpeed, 0, 0)).norm() / kSpeed;
            momentum = (a + b).norm() / kSpeed;
            return true;
        });
        const std::string of = std::string(name) + ", " + setting;
        // Balls as heavy as each other swap what they have along the line of their centers.
        const double along = std::sqrt(std::max(0.0, 1 - offset * offset / (0.02 * 0.02)));
        const double wanted = hits ? 2 * along : 0;
        bench.report(of, "error of the change of velocity", std::abs(change - wanted),
                     hits ? 1e-2 : 0, "1");
        bench.report(of, "momentum gained", momentum, 1e-5, "1");
    });
}

// A slot that leaves a cube 0.1 mm on either side: flown through along it, and into its wall.
void run_between_plates(CaseBench& bench, const std::string& setting, const ShapeMotion& flight)
{
    for_each_method([&](std::string_view name, ToiMethod method) {
        Scene scene = weightless(bench, 1.0 / 60, method, 0);
        for (const double side : {-1.0, 1.0})
            add_still(scene, box({0.05, 2, 2}), {side * (0.55 + 1e-4), 0, 0});
        scene.bodies[add_body(scene, box(Vec3::Constant(0.5)), flight)].fast = true;
        double deepest = 0, along = 0;
        bench.run(scene, 1, [&](World& world, double) {
            const BodyId cube = world.bodies().back();
            deepest = std::max(deepest, std::abs(world.pose(cube).position.x()) - 1e-4);
            along = world.velocity(cube).y();
            return true;
        });
        const std::string of = std::string(name) + ", " + setting;
        bench.report(of, "overlap", deepest, 1e-4, "m");
        bench.report(of, "speed along the slot that was lost", flight.velocity.y() - along, 1e-9,
                     "m/s");
    });
}

// Sixty bounces to and fro, each whole: a face meets a face, and neither spin nor speed may come
// of it.
void bounce_between_plates(CaseBench& bench)
{
    Scene scene = weightless(bench, 1.0 / 60, ToiMethod::newton, 1);
    for (const double side : {-1.0, 1.0})
        add_still(scene, box({0.05, 2, 2}), {side * (0.55 + 1e-4), 0, 0});
    add_body(scene, box(Vec3::Constant(0.5)), moving(Vec3::Zero(), {10, 0, 0}));
    double energy = 0, gained = 0;
    bench.inspect(scene, [&](const World& world) { energy = world.measure().kinetic_energy; });
    bench.run(scene, 1, [&](World& world, double) {
        gained = std::max(gained, world.measure().kinetic_energy / energy - 1);
        return true;
    });
    bench.report("cube at 10 m/s that bounces between plates", "energy gained", gained, 1e-3, "1");
}

}  // namespace

void case_fast_pair(CaseBench& bench)
{
    const ImpactQuery pair(ball(0.01), ball(0.01));
    const ShapeMotion right = moving({-5, 0, 0}, {kSpeed, 0, 0});
    const auto left = [](double offset) { return moving({5, offset, 0}, {-kSpeed, 0, 0}); };
    const double duration = 1.0 / 60, together = 2 * kSpeed;
    judge(bench, "head on", pair, right, left(0), duration, {0.00499, together});
    const double along = std::sqrt(0.02 * 0.02 - 0.015 * 0.015);
    judge(bench, "offset 0.015 m", pair, right, left(0.015), duration,
          {(10 - along) / together, together * along / 0.02});
    judge_miss(bench, "offset 0.0201 m", pair, right, left(0.0201), duration);
    judge(bench, "cube 0.1 mm from a plate",
          ImpactQuery(box(Vec3::Constant(0.5)), box({0.05, 2, 2})),
          moving(Vec3::Zero(), {10, 0, 0}), moving({0.55 + 1e-4, 0, 0}, Vec3::Zero()), duration,
          {1e-5, 10});
    run_pair(bench, "head on", 0, true);
    run_pair(bench, "offset 0.015 m", 0.015, true);
    run_pair(bench, "offset 0.0201 m", 0.0201, false);
    run_between_plates(bench, "cube at 10 m/s through a slot, 0.1 mm beside it",
                       moving({0, -4, 0}, {0, 10, 0}));
    run_between_plates(bench, "cube at 10 m/s into a plate 0.1 mm away",
                       moving(Vec3::Zero(), {10, 0, 0}));
    bounce_between_plates(bench);
}

}  // namespace throng
