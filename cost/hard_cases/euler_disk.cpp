// Euler's disk: H19, a coin that rolls round on its rim while its middle stands still.
//
// Let R be its radius, h half its thickness and s its angle to the floor. Its rim touches at
// r = R d - h n from its middle, d down along a diameter, n its axis. The middle stands still where
// the spin goes along r; then the whole turns about the vertical at W, and dL/dt = r x F has
//
//   W^2 = m g (R cos s - h sin s) / (A sin s cos s - C sin^2 s h / R)
//
// with C = m R^2 / 2 about the axis and A = m (R^2 / 4 + h^2 / 3) across it. Without thickness that
// is 4 g / (R sin s): 77.627169 rad/s for R = 0.0375 m at 10 degrees, 39.618178 for 0.05 m at 30.
//
// And a wheel that rolls along, aslant: its energy stays what it is.
//
// Source: the closed form for a thin disk is in textbooks of mechanics, with a thickness worked out
//         here. The coin is that of rigid-ipc (Ferguson and others, 2021): 24.26 by 1.75 mm.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/names.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kDiskMass = 0.4;  // kg

struct Disk {
    const char* name;
    double radius, half_thickness, angle;  // m, m, rad
};

double precession_of(const Disk& disk)
{
    const double r = disk.radius, h = disk.half_thickness;
    const double sine = std::sin(disk.angle), cosine = std::cos(disk.angle);
    const double across = r * r / 4 + h * h / 3, axial = r * r / 2;
    return std::sqrt(kGravity * (r * cosine - h * sine)
                     / (across * sine * cosine - axial * sine * sine * h / r));
}

// The disk on a plane, at its steady roll round the vertical.
Scene rolling_round(const CaseBench& bench, const Disk& disk, double friction, double lever_arm)
{
    const double sine = std::sin(disk.angle), cosine = std::cos(disk.angle);
    const Vec3 axis(sine, 0, cosine), down(cosine, 0, -sine);
    const Vec3 to_rim = disk.radius * down - disk.half_thickness * axis;
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(friction);
    parts.scene().materials[material].rolling_friction = lever_arm;
    parts.plane(material, Vec3::UnitZ(), 0);
    const Quat turn = exponential(Vec3(0, disk.angle, 0));
    const std::uint32_t id = parts.cylinder(material, kDiskMass, disk.radius, disk.half_thickness,
                                            {Vec3(0, 0, -to_rim.z()), turn});
    parts.body(id).angular_velocity = -precession_of(disk) * sine / disk.radius * to_rim;
    parts.scene().settings.sleep = false;
    return parts.scene();
}

double tilt_of(const Vec3& axis)
{
    return std::atan2(std::hypot(axis.x(), axis.y()), std::abs(axis.z()));
}

struct Rolled {
    double tilt_error = 0, rate_error = 0, middle = 0;  // shares, and m
};

Rolled roll_round(CaseBench& bench, const Disk& disk, const Scene& scene, double turns)
{
    const double rate = precession_of(disk);
    Rolled rolled;
    double angle = 0, before = 0;
    bench.run(scene, turns * 2 * kPi / rate, [&](World& world, double now) {
        const Pose pose = world.pose(world.bodies().back());
        const Vec3 axis = pose.orientation * Vec3::UnitZ();
        const double at = std::atan2(axis.y(), axis.x());
        angle += std::remainder(at - before, 2 * kPi);
        before = at;
        rolled.tilt_error = std::max(rolled.tilt_error, std::abs(tilt_of(axis) / disk.angle - 1));
        rolled.rate_error = std::abs(angle / (rate * now) - 1);
        rolled.middle = std::max(rolled.middle, std::hypot(pose.position.x(), pose.position.y()));
        return std::isfinite(rolled.tilt_error);
    });
    return rolled;
}

constexpr const char *kTilt = "tilt off what it was, at worst", *kRate = "precession off",
                     *kMiddle = "way of the middle over the radius";

struct RollStep {
    const char* name;
    double dt;  // s
};
constexpr RollStep kLongSteps[] = {
    {", dt 1/60", 1.0 / 60}, {", dt 1/240", 1.0 / 240}, {", dt 1e-3", 1e-3}};

// By steps that a user takes first: far too long for what goes round so fast.
void roll_by_long_steps(CaseBench& bench, const Disk& disk, const RollStep& step)
{
    Scene scene = rolling_round(bench, disk, 1, 0);
    scene.settings.dt = step.dt;
    const Rolled rolled = roll_round(bench, disk, scene, 10);
    const std::string name = std::string(disk.name) + step.name;
    const auto beside = [&](const char* quantity, double figure) {
        bench.report_default(name, quantity, figure, 0.01, "1", "dt 5e-6");
    };
    beside(kTilt, rolled.tilt_error);
    beside(kRate, rolled.rate_error);
    beside(kMiddle, rolled.middle / disk.radius);
}

void roll_by_short_steps(CaseBench& bench, const Disk& disk, bool exactly)
{
    Scene scene = rolling_round(bench, disk, 1, 0);
    if (exactly) ask_exactly(scene.settings);
    scene.settings.dt = bench.brief() ? 2e-5 : 5e-6;
    const Rolled rolled = roll_round(bench, disk, scene, bench.brief() ? 1 : 10);
    const std::string name = std::string(disk.name) + (exactly ? ", direct" : "") + ", dt "
        + number_text(scene.settings.dt);
    bench.report(name, kTilt, rolled.tilt_error, 0.01, "1");
    bench.report(name, kRate, rolled.rate_error, 0.01, "1");
    bench.report(name, kMiddle, rolled.middle / disk.radius, 0.01, "1");
}

double energy_of(const World& world)
{
    const Measures measures = world.measure();
    return measures.kinetic_energy + measures.potential_energy;
}

struct Settled {
    double risen = 0;   // rad, above the least so far
    double gained = 0;  // of the first energy, above the least so far
    // J, until half of the tilt was left: what went, and what m g times the lever takes of the spin
    double lost = 0, resisted = 0;
    double tilt = 0, height = 0, speed = 0;  // at the end
};

Settled settle_disk(CaseBench& bench, const Scene& scene, double time)
{
    Settled settled;
    double least = 1e30, lowest = 1e30, first_tilt = 0, first_energy = 0;
    const double resists =
        scene.materials.front().rolling_friction * *scene.bodies.back().mass * kGravity;
    bench.inspect(scene, [&](const World& world) {
        first_energy = energy_of(world);
        first_tilt = tilt_of(world.pose(world.bodies().back()).orientation * Vec3::UnitZ());
    });
    bench.run(scene, time, [&](World& world, double) {
        const BodyId body = world.bodies().back();
        const Pose pose = world.pose(body);
        const double energy = energy_of(world);
        settled.tilt = tilt_of(pose.orientation * Vec3::UnitZ());
        settled.height = pose.position.z();
        settled.speed = world.velocity(body).norm();
        least = std::min(least, settled.tilt);
        settled.risen = std::max(settled.risen, settled.tilt - least);
        lowest = std::min(lowest, energy);
        settled.gained = std::max(settled.gained, (energy - lowest) / first_energy);
        if (least > first_tilt / 2) {
            settled.lost = first_energy - energy;
            settled.resisted += resists * world.angular_velocity(body).norm() * scene.settings.dt;
        }
        return std::isfinite(energy);
    });
    return settled;
}

// Its tilt falls all the time, ever faster, until it lies flat. Friction is great, since by
// solver=direct it shares its cone with what resists rolling, and slides a little for it.
void slow_down(CaseBench& bench, bool exactly)
{
    const Disk disk{"R 50 mm, 30 deg, rolling friction 1 mm", 0.05, 1e-4, 30 * kPi / 180};
    Scene scene = rolling_round(bench, disk, 4, 1e-3);
    scene.settings.dt = 2e-5;
    if (exactly) ask_exactly(scene.settings);
    const Settled settled = settle_disk(bench, scene, bench.brief() ? 0.1 : 5);
    const std::string name = std::string(disk.name) + (exactly ? ", direct" : "");
    const char* const taken = "energy taken off what rolling friction takes";
    const double off = std::abs(settled.lost / settled.resisted - 1);
    if (exactly)
        bench.report(name, taken, off, 0.02, "1");
    else
        bench.report_default(name, taken, off, 0.02, "1", "solver=direct");
    bench.report(name, "tilt risen on the way", settled.risen, 1e-3, "rad");
    bench.report(name, "energy risen on the way, of the first", settled.gained, 1e-3, "1");
    if (bench.brief()) return;
    bench.report(name, "tilt at the end", settled.tilt, 1e-6, "rad");
    bench.report(name, "height at the end off flat",
                 std::abs(settled.height / disk.half_thickness - 1), 1e-2, "1");
}

// Stands almost upright and turns about the vertical, and falls; friction 0.2, and no more.
void spin_coin(CaseBench& bench, const RollStep& step, double time)
{
    const Disk coin{"coin, 85 deg, 900 deg/s", 0.01213, 0.000875, 85 * kPi / 180};
    const double volume = 2 * kPi * coin.radius * coin.radius * coin.half_thickness;
    const double height =
        coin.radius * std::sin(coin.angle) + coin.half_thickness * std::cos(coin.angle);
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.2);
    parts.plane(material, Vec3::UnitZ(), 0);
    const std::uint32_t id =
        parts.cylinder(material, 8900 * volume, coin.radius, coin.half_thickness,
                       {Vec3(0, 0, height), exponential(Vec3(0, coin.angle, 0))});
    parts.body(id).angular_velocity = Vec3(0, 0, 900 * kPi / 180);
    parts.scene().settings.dt = step.dt;
    const Settled settled = settle_disk(bench, parts.scene(), time);
    const std::string name = std::string(coin.name) + step.name;
    const auto judge = [&](const char* quantity, double figure, double bound, const char* unit) {
        if (step.dt > 1e-3)
            bench.report_default(name, quantity, figure, bound, unit, "dt 1e-3");
        else
            bench.report(name, quantity, figure, bound, unit);
    };
    judge("energy risen on the way, of the first", settled.gained, 1e-3, "1");
    if (time < 1) return;
    judge("tilt at the end", settled.tilt, 1e-6, "rad");
    judge("height at the end off flat", std::abs(settled.height / coin.half_thickness - 1), 1e-2,
          "1");
    judge("speed at the end", settled.speed, 1e-4, "m/s");
}

struct Wheel {
    double half_thickness, speed;  // m, m/s
};

// So thin that, as fast as it rolls, it neither comes down nor rights itself.
bool keeps_its_lean(const Wheel& wheel) { return wheel.half_thickness < 0.01; }

std::string name_of(const Wheel& wheel)
{
    return "wheel of 0.6 m, " + number_text(2000 * wheel.half_thickness) + " mm thick, aslant, "
        + number_text(wheel.speed) + " m/s";
}

// Rolls along on its rim, a little aslant, and goes round in a wide curve. Where nothing slips it
// loses nothing, and sways on as it does. One that is thick comes down onto its side, and what that
// blow takes is little.
void roll_along(CaseBench& bench, const Wheel& wheel, const char* setting, void (*set)(Settings&))
{
    constexpr double kRadius = 0.3, kLean = 0.15;  // m, rad
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0.6);
    parts.plane(material, Vec3::UnitZ(), 0);
    const double height = kRadius * std::cos(kLean) + wheel.half_thickness * std::sin(kLean);
    const std::uint32_t id =
        parts.cylinder(material, kDiskMass, kRadius, wheel.half_thickness,
                       {Vec3(0, 0, height), exponential(Vec3(kPi / 2 - kLean, 0, 0))});
    parts.body(id).velocity = Vec3(wheel.speed, 0, 0);
    parts.body(id).angular_velocity = Vec3(0, wheel.speed / kRadius, 0);
    if (set != nullptr) set(parts.scene().settings);
    double first = 0, moving = 0, off = 0, lean = 0;
    bench.inspect(parts.scene(), [&](const World& world) {
        first = energy_of(world);
        moving = world.measure().kinetic_energy;
    });
    bench.run(parts.scene(), bench.brief() ? 2 : 10, [&](World& world, double) {
        off = std::max(off, std::abs(energy_of(world) - first) / moving);
        const Vec3 axis = world.pose(world.bodies().back()).orientation * Vec3::UnitZ();
        lean = std::max(lean, std::asin(std::min(std::abs(axis.z()), 1.0)));
        return std::isfinite(off);
    });
    // One that is thin and slow sways out at 1/60 s by `direct` too.
    const bool held = set != nullptr
        && (parts.scene().settings.dt < 0.01 || wheel.speed > 2 || !keeps_its_lean(wheel));
    const auto tell = [&](const char* quantity, double value, double bound, const char* unit) {
        if (held)
            bench.report(name_of(wheel) + setting, quantity, value, bound, unit);
        else
            bench.report_default(name_of(wheel) + setting, quantity, value, bound, unit, "dt 5e-4");
    };
    tell("energy off what it was, of that of motion", off, 0.02, "1");
    if (keeps_its_lean(wheel) && parts.scene().settings.solver != Solver::direct)
        tell("greatest lean over the first", lean / kLean, 1.1, "1");
}

}  // namespace

void case_euler_disk(CaseBench& bench)
{
    for (const Disk& disk : {Disk{"R 37.5 mm, 10 deg", 0.0375, 1e-4, 10 * kPi / 180},
                             Disk{"R 50 mm, 30 deg", 0.05, 1e-4, 30 * kPi / 180},
                             Disk{"R 37.5 mm, 6 mm thick, 10 deg", 0.0375, 3e-3, 10 * kPi / 180}}) {
        roll_by_short_steps(bench, disk, false);
        roll_by_short_steps(bench, disk, true);
        if (bench.brief()) continue;
        for (const RollStep& step : kLongSteps) roll_by_long_steps(bench, disk, step);
    }
    slow_down(bench, false);
    slow_down(bench, true);
    spin_coin(bench, kLongSteps[0], 5);
    spin_coin(bench, kLongSteps[2], 5);
    spin_coin(bench, {", dt 1e-4", 1e-4}, bench.brief() ? 0.5 : 40);
    const auto finely = [](Settings& settings) { settings.dt = 5e-4; };
    const auto exactly = [](Settings& settings) { settings.solver = Solver::direct; };
    for (const Wheel& wheel : {Wheel{0.05, 3}, Wheel{0.005, 3}, Wheel{0.001, 3}, Wheel{0.02, 1.5},
                               Wheel{0.02, 6}, Wheel{0.001, 1.5}}) {
        roll_along(bench, wheel, "", nullptr);
        roll_along(bench, wheel, ", dt 5e-4", finely);
        roll_along(bench, wheel, ", direct", exactly);
    }
}

}  // namespace throng
