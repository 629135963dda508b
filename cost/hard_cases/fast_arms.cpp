// Springs by the ends of what turns fast, and pivots in contact: H78.
//
// A needle that a spring holds by its end turns by radians in a substep, in flight and between the
// things that it strikes; a bar on a pivot lies on a ball, and others strike it. Nothing of it
// makes energy, however stiff the spring is.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kRadius = 0.01, kHalf = 0.49, kNeedle = 0.31;  // m, m, kg

struct Layout {
    const char* name = "";
    double turn = 0;  // rad, about the upright
    Vec3 off = Vec3::Zero();
    bool backwards = false;  // the needle, or the bar, is made first

    Vec3 at(const Vec3& place) const { return off + along(place); }
    Vec3 along(const Vec3& way) const { return exponential(Vec3(0, 0, turn)) * way; }
    Quat turned(const Quat& by) const { return exponential(Vec3(0, 0, turn)) * by; }
};
constexpr double kFar = 1e5;  // m

const Layout kAsItIs = {};
const Layout kLayouts[] = {{", turned", 1.1},
                           {", far off", 0, Vec3(kFar, -kFar, 0)},
                           {", made first", 0, Vec3::Zero(), true}};

std::string in_power(double number)
{
    return "1e" + std::to_string(int(std::lround(std::log10(number))));
}

std::uint32_t add_needle(SceneParts& parts, std::uint32_t material, double speed, const Layout& as)
{
    Scene& scene = parts.scene();
    scene.shapes.push_back({"", CapsuleShape{kRadius, kHalf}});
    BodyDescription body;
    body.shape = static_cast<std::uint32_t>(scene.shapes.size() - 1);
    body.material = material;
    body.mass = kNeedle;
    body.position = as.at(Vec3(0, 0, 0.6));
    body.orientation = as.turned(Quat(0.9, 0.3, 0.3, 0.1).normalized());
    body.velocity = as.along(Vec3(speed, 0.1 * speed, 0.05 * speed));
    scene.bodies.push_back(body);
    return static_cast<std::uint32_t>(scene.bodies.size() - 1);
}

Spring spring_on(std::uint32_t needle, double stiffness, double ratio)
{
    Spring spring;
    spring.a = needle;
    spring.at_a = Vec3(0, 0, 0.5);
    spring.b = kNone;
    spring.stiffness = stiffness;
    spring.damping = 2 * ratio * std::sqrt(stiffness * kNeedle);
    spring.length = 0.5;
    return spring;
}

// In the air, on a spring to a point of the world.
Scene flown(CaseBench& bench, double stiffness, double speed, const Layout& as)
{
    SceneParts parts(bench.scene());
    const std::uint32_t needle = add_needle(parts, parts.material(0.5), speed, as);
    parts.scene().springs.push_back(spring_on(needle, stiffness, 0));
    parts.scene().springs.back().at_b = as.at(Vec3(0, 0, 1));
    return parts.scene();
}

// The same thrown at a box on the floor, on a spring to the world or to the box.
Scene thrown(
    CaseBench& bench, double stiffness, double ratio, double speed, bool at_box, const Layout& as)
{
    SceneParts parts(bench.scene());
    const std::uint32_t rough = parts.material(0.5);
    parts.plane(rough, Vec3::UnitZ(), 0);
    std::uint32_t needle = as.backwards ? add_needle(parts, rough, speed, as) : 0;
    const Pose place{as.at(Vec3(1.5, 0, 0.25)), as.turned(Quat::Identity())};
    const std::uint32_t box = parts.box(rough, 125, Vec3::Constant(0.25), place);
    if (!as.backwards) needle = add_needle(parts, rough, speed, as);
    Spring spring = spring_on(needle, stiffness, ratio);
    spring.at_b = at_box ? Vec3(0, 0, 0.25) : as.at(Vec3(0, 0, 1));
    if (at_box) spring.b = box;
    parts.scene().springs.push_back(spring);
    return parts.scene();
}

struct Account {
    double first = 0, most = 0, least = 0;  // J, of all energy
    double gained = 0, moving = 0;          // J, on the way; the greatest in motion
};

Account account_of(CaseBench& bench, const Scene& scene, double time)
{
    Account account;
    const auto energy_of = [](const World& world) {
        const Measures now = world.measure();
        const double sum = now.kinetic_energy + now.potential_energy;
        return std::isfinite(sum) ? sum : 1e300;
    };
    bench.inspect(scene, [&](const World& world) {
        account.first = account.most = account.least = energy_of(world);
        account.moving = world.measure().kinetic_energy;
    });
    EnergyLedger ledger;
    const auto watch = [&](World& world, double) {
        account.most = std::max(account.most, energy_of(world));
        account.least = std::min(account.least, energy_of(world));
        return account.most < 1e6 * account.first;
    };
    bench.run(scene, time, watch, &ledger);
    account.gained = ledger.gained();
    account.moving = std::max(account.moving, ledger.greatest_kinetic());
    return account;
}

void keeps(CaseBench& bench, const std::string& setting, const Scene& scene)
{
    const Account account = account_of(bench, scene, bench.brief() ? 1 : 10);
    bench.report(setting, "energy, off the first",
                 std::max(account.most / account.first - 1, 1 - account.least / account.first),
                 1e-4, "1");
}

void gains_nothing(CaseBench& bench, const std::string& setting, const Scene& scene)
{
    const Account account = account_of(bench, scene, bench.brief() ? 1.5 : 10);
    bench.report(setting, "energy beyond the first",
                 std::max(0.0, account.most / account.first - 1), 1e-3, "1");
    bench.report(setting, "energy gained on the way, of the greatest in motion",
                 account.gained / account.moving, 1e-2, "1");
}

void flies(CaseBench& bench)
{
    for (const double stiffness : {1e2, 1e3, 1e4, 1e5, 1e6, 1e8})
        for (const double speed : {30.0, 230.0}) {
            if (bench.brief() && (speed < 100 || stiffness != 1e5)) continue;
            const std::string text = "needle in flight, " + in_power(stiffness) + " N/m, "
                + std::to_string(int(speed)) + " m/s";
            keeps(bench, text, flown(bench, stiffness, speed, kAsItIs));
        }
    if (bench.brief()) return;
    for (const double dt : {1.0 / 240, 1e-3}) {
        Scene scene = flown(bench, 1e5, 230, kAsItIs);
        scene.settings.dt = dt;
        keeps(bench,
              "needle in flight, 1e5 N/m, 230 m/s, dt=1/" + std::to_string(std::lround(1 / dt)),
              scene);
    }
    for (const Layout& as : kLayouts)
        if (!as.backwards)
            keeps(bench, std::string("needle in flight, 1e5 N/m, 230 m/s") + as.name,
                  flown(bench, 1e5, 230, as));
}

void hits(CaseBench& bench)
{
    for (const double stiffness : {1e2, 1e4, 1e5, 1e6, 1e8})
        for (const double ratio : {0.0, 0.3})
            for (const bool at_box : {false, true}) {
                if (bench.brief() && (stiffness != 1e5 || ratio > 0)) continue;
                const std::string text = "needle thrown at a box, " + in_power(stiffness)
                    + (at_box ? " N/m to the box" : " N/m to the world")
                    + (ratio > 0 ? ", damped" : "");
                gains_nothing(bench, text, thrown(bench, stiffness, ratio, 230, at_box, kAsItIs));
            }
    if (bench.brief()) return;
    const std::string text = "needle thrown at a box, 1e5 N/m to the world";
    for (const Layout& as : kLayouts)
        gains_nothing(bench, text + as.name, thrown(bench, 1e5, 0, 230, false, as));
    const auto with = [&](const std::string& how, auto&& change) {
        Scene scene = thrown(bench, 1e5, 0, 230, false, kAsItIs);
        change(scene.settings);
        gains_nothing(bench, text + how, scene);
    };
    with(", dt=1/240", [](Settings& settings) { settings.dt = 1.0 / 240; });
    with(", dt=1/1000", [](Settings& settings) { settings.dt = 1e-3; });
    with(", pgs", [](Settings& settings) { settings.solver = Solver::pgs; });
    with(", direct", [](Settings& settings) { settings.solver = Solver::direct; });
    with(", double", [](Settings& settings) { settings.precision = Precision::double_; });
}

// How it comes down, and between what it is pressed, differs from throw to throw.
void is_thrown_often(CaseBench& bench)
{
    for (const double stiffness : {1e5, 3e5, 1e6})
        for (const double ratio : {0.0, 0.3})
            for (const bool at_box : {false, true}) {
                if (bench.brief()) continue;
                double worst = 0;
                for (int speed = 50; speed <= 290; speed += 20) {
                    const Scene scene = thrown(bench, stiffness, ratio, speed, at_box, kAsItIs);
                    const Account account = account_of(bench, scene, 10);
                    worst = std::max(worst, account.gained / account.moving);
                }
                const std::string text = "needle thrown at a box 13 times, "
                    + std::to_string(int(stiffness / 1e3))
                    + (at_box ? " kN/m to the box" : " kN/m to the world")
                    + (ratio > 0 ? ", damped" : "");
                bench.report(text, "energy gained on the way, of the greatest in motion, at worst",
                             worst, 1e-2, "1");
            }
}

// 2 kg and 1.4 m on a pivot at one end, upon a ball a metre from there.
Scene resting_bar(CaseBench& bench, const Layout& as)
{
    SceneParts parts(bench.scene());
    const std::uint32_t rough = parts.material(0.5);
    parts.plane(rough, Vec3::UnitZ(), 0);
    const auto add_bar = [&] {
        const Pose place{as.at(Vec3(0.7, 0, 0.45)), as.turned(Quat::Identity())};
        parts.body(parts.box(rough, 2, Vec3(0.7, 0.05, 0.05), place)).pivot = Vec3(-0.7, 0, 0);
    };
    if (as.backwards) add_bar();
    parts.ball(rough, 1, 0.2, as.at(Vec3(1, 0, 0.2)));
    if (!as.backwards) add_bar();
    return parts.scene();
}

// Forces are told as they were when it fell asleep.
void rests(CaseBench& bench, const std::string& setting, const Scene& scene, std::size_t bar)
{
    const double bound = scene.settings.solver == Solver::direct ? 1e-4 : 5e-2;
    double borne = 0, speed = 0;
    bench.run(scene, bench.brief() ? 1 : 3, [&](World& world, double) {
        borne = world.contact_force(world.bodies()[bar]).z();
        speed = world.angular_velocity(world.bodies()[bar]).norm();
        return true;
    });
    bench.report("bar on a pivot upon a ball" + setting, "push of the ball, off m g l / 2 d",
                 std::abs(borne / (2 * kGravity * 0.7) - 1), bound, "1");
    bench.report("bar on a pivot upon a ball" + setting, "turning at rest", speed, 1e-4, "rad/s");
}

void has_pivot(CaseBench& bench)
{
    for (const bool exactly : {false, true})
        for (const double dt : {1.0 / 60, 1.0 / 240, 1e-3}) {
            if (bench.brief() && (exactly || dt < 1e-2)) continue;
            Scene scene = resting_bar(bench, kAsItIs);
            scene.settings.dt = dt;
            if (exactly) scene.settings.solver = Solver::direct;
            rests(bench,
                  (exactly ? ", direct, dt=1/" : ", dt=1/") + std::to_string(std::lround(1 / dt)),
                  scene, 2);
        }
    for (const Layout& as : kLayouts)
        if (!bench.brief()) rests(bench, as.name, resting_bar(bench, as), as.backwards ? 1 : 2);
}

// Five balls, one after another, against a bar that hangs by its end.
Scene struck_bar(CaseBench& bench, double ball, double speed, const Layout& as)
{
    SceneParts parts(bench.scene());
    const std::uint32_t rough = parts.material(0.5);
    parts.plane(rough, Vec3::UnitZ(), 0);
    const auto add_bar = [&] {
        const Pose place{as.at(Vec3(0, 0, 1.2)), as.turned(Quat::Identity())};
        parts.body(parts.box(rough, 1, Vec3(0.05, 0.05, 0.5), place)).pivot = Vec3(0, 0, 0.5);
    };
    if (as.backwards) add_bar();
    for (int i = 0; i < 5; ++i) {
        const Vec3 at(-1 - 0.5 * i, 0.02 * (i % 3 - 1), 0.8 + 0.1 * (i % 4));
        parts.body(parts.ball(rough, ball, 0.1, as.at(at))).velocity = as.along(Vec3(speed, 0, 0));
    }
    if (!as.backwards) add_bar();
    return parts.scene();
}

void is_struck(CaseBench& bench)
{
    const auto text = [](double ball, double speed) {
        return "bar on a pivot, struck by balls of " + std::to_string(int(ball)) + " kg at "
            + std::to_string(int(speed)) + " m/s";
    };
    for (const double ball : {1.0, 100.0})
        for (const double speed : {3.0, 30.0}) {
            if (bench.brief() && (ball > 1 || speed < 10)) continue;
            gains_nothing(bench, text(ball, speed), struck_bar(bench, ball, speed, kAsItIs));
        }
    for (const Layout& as : kLayouts)
        if (!bench.brief())
            gains_nothing(bench, text(1, 30) + as.name, struck_bar(bench, 1, 30, as));
}

}  // namespace

void case_fast_arms(CaseBench& bench)
{
    flies(bench);
    hits(bench);
    is_thrown_often(bench);
    has_pivot(bench);
    is_struck(bench);
}

}  // namespace throng
