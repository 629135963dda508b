// Springs on bodies in contact: H72.
//
// A box on a smooth floor swings on a spring for ever, as wide as it was let go; so does whatever
// springs hold together, however stiff they are, and nothing that touches something makes energy of
// it.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kFirst = 0.1, kHalf = 0.05, kTime = 10;  // m, m, s

double energy_of(const World& world)
{
    const Measures now = world.measure();
    return now.kinetic_energy + now.potential_energy;
}

Spring spring_between(std::uint32_t a, std::uint32_t b, double stiffness, double length)
{
    Spring spring;
    spring.a = a;
    spring.b = b;
    spring.stiffness = stiffness;
    spring.length = length;
    return spring;
}

struct Setting {
    const char* name;
    void (*ask)(Settings&);
};
constexpr Setting kSettings[] = {
    {"default", [](Settings&) {}},
    {"pgs", [](Settings& settings) { settings.solver = Solver::pgs; }},
    {"direct", [](Settings& settings) { settings.solver = Solver::direct; }},
    {"most exact", ask_exactly},
    {"rk4", [](Settings& settings) { settings.integrator = Integrator::rk4; }},
};

// 1 kg on a smooth floor, far enough along a spring that pulls along x.
SceneParts swinging_box(CaseBench& bench, double stiffness)
{
    SceneParts parts(bench.scene());
    const std::uint32_t smooth = parts.material(0);
    parts.plane(smooth, Vec3::UnitZ(), 0);
    const std::uint32_t box =
        parts.box(smooth, 1, Vec3::Constant(kHalf), {Vec3(kFirst, 0, kHalf), Quat::Identity()});
    Spring spring = spring_between(box, kNone, stiffness, 1);
    spring.at_b = Vec3(-1, 0, kHalf);
    parts.scene().springs.push_back(spring);
    return parts;
}

// m, and s: how wide it swings at any time and in the last two seconds; when it passes the middle
// for the 31st time.
struct Swing {
    double widest = 0, last = 0, passes_at = 0;
};

Swing swing(CaseBench& bench, const Scene& scene)
{
    Swing result;
    double before = kFirst, then = 0;
    int passes = 0;
    bench.run(scene, kTime, [&](World& world, double now) {
        const double x = world.pose(world.bodies().back()).position.x();
        result.widest = std::max(result.widest, std::abs(x));
        if (now > kTime - 2) result.last = std::max(result.last, std::abs(x));
        if (x * before < 0 && ++passes == 31)
            result.passes_at = then + (now - then) * before / (before - x);
        before = x;
        then = now;
        return result.widest < 100 * kFirst;
    });
    return result;
}

void keeps_its_swing(CaseBench& bench)
{
    const double w = 10, when = 30.5 * kPi / w;
    for (const Setting& setting : kSettings)
        for (const double dt : {1.0 / 60, 1.0 / 240, 1e-3}) {
            if (bench.brief() && dt < 1e-2 && setting.name != kSettings[0].name) continue;
            SceneParts parts = swinging_box(bench, w * w);
            parts.scene().settings.dt = dt;
            setting.ask(parts.scene().settings);
            const Swing seen = swing(bench, parts.scene());
            const std::string text = "100 N/m, " + std::string(setting.name) + ", dt=1/"
                + std::to_string(std::lround(1 / dt));
            bench.report(
                text, "swing, off the first",
                std::max(std::abs(seen.widest / kFirst - 1), std::abs(seen.last / kFirst - 1)),
                1e-2, "1");
            bench.report(text, "31st passage, of its time", std::abs(seen.passes_at / when - 1),
                         setting.ask == ask_exactly ? 5e-3 : 2e-3, "1");
        }
}

// Where a substep is half of the longest a spring bears a swing is a seventh wider than it began.
void holds_at_any_stiffness(CaseBench& bench)
{
    for (const Setting& setting : kSettings)
        for (const double stiffness : {1e3, 1e4, 1e5, 1e6, 1e8}) {
            if (bench.brief() && (stiffness < 1e4 || stiffness == 1e5)) continue;
            SceneParts parts = swinging_box(bench, stiffness);
            setting.ask(parts.scene().settings);
            const Swing seen = swing(bench, parts.scene());
            bench.report("1e" + std::to_string(std::lround(std::log10(stiffness))) + " N/m, "
                             + setting.name,
                         "swing, beyond the first", seen.widest / kFirst - 1, 0.16, "1");
        }
}

// The box is in contact with a tile, a hair below it, for half of its way, and with nothing for the
// other half.
void comes_and_goes(CaseBench& bench)
{
    SceneParts parts(bench.scene());
    parts.scene().gravity = Vec3::Zero();
    const std::uint32_t smooth = parts.material(0);
    const std::uint32_t tile =
        parts.box(smooth, 1, Vec3(0.2, 0.2, 0.2), {Vec3(-0.25, 0, -0.2), Quat::Identity()});
    parts.hold(tile);
    const double height = kHalf + 1e-3;
    const std::uint32_t box =
        parts.box(smooth, 1, Vec3::Constant(kHalf), {Vec3(kFirst, 0, height), Quat::Identity()});
    Spring spring = spring_between(box, kNone, 100, 1);
    spring.at_b = Vec3(1, 0, height);
    parts.scene().springs.push_back(spring);
    const Swing seen = swing(bench, parts.scene());
    bench.report("100 N/m, over the edge of a tile", "swing, off the first",
                 std::max(std::abs(seen.widest / kFirst - 1), std::abs(seen.last / kFirst - 1)),
                 1e-2, "1");
}

// A weight on a damped spring beside a smooth wall that it is pressed against.
void sags(CaseBench& bench)
{
    for (const double stiffness : {1e3, 1e5, 1e7}) {
        SceneParts parts(bench.scene());
        const std::uint32_t smooth = parts.material(0);
        parts.plane(smooth, Vec3::UnitX(), 0);
        const std::uint32_t box =
            parts.box(smooth, 1, Vec3::Constant(kHalf), {Vec3(kHalf, 0, 0), Quat::Identity()});
        parts.body(box).force = Vec3(-5, 0, 0);
        Spring spring = spring_between(box, kNone, stiffness, 1);
        spring.at_b = Vec3(kHalf, 0, 1);
        spring.damping = 2 * std::sqrt(stiffness);
        parts.scene().springs.push_back(spring);
        double sag = 0, borne = 0, speed = 0;
        bench.run(parts.scene(), 3, [&](World& world, double) {
            const BodyId id = world.bodies().back();
            sag = -world.pose(id).position.z();
            borne = world.contact_force(id).x();
            speed = world.velocity(id).norm();
            return true;
        });
        const std::string text = "a weight on 1e"
            + std::to_string(std::lround(std::log10(stiffness))) + " N/m by a wall";
        bench.report(text, "sag, off m g / k", std::abs(sag * stiffness / kGravity - 1), 1e-3, "1");
        bench.report(text, "push of the wall, off its load", std::abs(borne / 5 - 1), 1e-3, "1");
        bench.report(text, "speed at rest", speed, 1e-4, "m/s");
    }
}

// Of a scene left to itself: the most energy there ever is, of that at first.
void gains_nothing(CaseBench& bench, const std::string& setting, const Scene& scene, double bound)
{
    double first = 0, most = 0;
    bench.inspect(scene, [&](const World& world) { first = energy_of(world); });
    bench.run(scene, bench.brief() ? 1 : kTime, [&](World& world, double) {
        const double now = energy_of(world);
        most = std::max(most, std::isfinite(now) ? now : 1e300);
        return most < 100 * first;
    });
    bench.report(setting, "energy beyond the first", std::max(0.0, most / first - 1), bound, "1");
}

// 169 balls and the springs between them, laid over a ball.
Scene net(CaseBench& bench, double stiffness)
{
    constexpr std::uint32_t kSide = 13;
    SceneParts parts(bench.scene());
    const std::uint32_t rough = parts.material(0.3);
    parts.plane(rough, Vec3::UnitZ(), 0);
    const std::uint32_t big = parts.ball(rough, 1, 0.4, Vec3(0, 0, 0.4));
    parts.hold(big);
    std::uint32_t first = 0;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
        const std::uint32_t row = i / kSide, column = i % kSide;
        const std::uint32_t ball =
            parts.ball(rough, 0.0335, 0.02, Vec3(0.1 * (row - 6.0), 0.1 * (column - 6.0), 0.9));
        if (i == 0) first = ball;
        const auto tie = [&](std::uint32_t other) {
            parts.scene().springs.push_back(spring_between(other, ball, stiffness, 0.1));
        };
        if (row > 0) tie(first + i - kSide);
        if (column > 0) tie(first + i - 1);
    }
    return parts.scene();
}

// Boxes in a row on the floor, heavy and light in turn, on springs by their corners.
Scene chain(CaseBench& bench, double stiffness, double friction)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(friction);
    parts.plane(material, Vec3::UnitZ(), 0);
    std::uint32_t before = kNone;
    for (int i = 0; i < 6; ++i) {
        const std::uint32_t box =
            parts.box(material, i % 2 == 0 ? 1 : 30, Vec3::Constant(kHalf),
                      {Vec3(0.22 * i, 0.01 * (i % 3), kHalf), Quat::Identity()});
        Spring spring = spring_between(box, before, stiffness, 0.1);
        spring.at_a = Vec3(-kHalf, kHalf, 0.02);
        spring.at_b = before == kNone ? Vec3(-0.2, 0, 0.3) : Vec3(kHalf, -kHalf, 0);
        parts.scene().springs.push_back(spring);
        before = box;
    }
    return parts.scene();
}

void many(CaseBench& bench)
{
    gains_nothing(bench, "a net of 200 N/m over a ball", net(bench, 200), 0.01);
    if (!bench.brief()) gains_nothing(bench, "a net of 1e4 N/m over a ball", net(bench, 1e4), 0.01);
    for (const double friction : {0.0, 0.5})
        for (const double stiffness : {1e2, 1e4, 1e6}) {
            const std::string text = "a chain of 1e"
                + std::to_string(std::lround(std::log10(stiffness))) + " N/m, friction "
                + (friction > 0 ? "0.5" : "0");
            gains_nothing(bench, text, chain(bench, stiffness, friction), 0.05);
        }
}

}  // namespace

void case_springs_in_contact(CaseBench& bench)
{
    keeps_its_swing(bench);
    holds_at_any_stiffness(bench);
    comes_and_goes(bench);
    sags(bench);
    many(bench);
}

}  // namespace throng
