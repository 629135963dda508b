// Rest under forces: H92, stacks near attractors and on springs.
//
// Answer: they come to rest as they would without, and sleep; and what swings without friction
// keeps its swing.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace throng {

namespace {

constexpr double kMass = 500, kHalf = 0.5;  // kg, m, of a cube
constexpr double kPlanet = 600;             // m, to its middle

enum class Acts : std::uint8_t {
    faint,    // an attractor that nobody would notice
    repels,   // one that drives off by 2 m/s2
    planet,   // one in place of gravity
    aside,    // a spring that draws a cube in the middle aside
    presses,  // one that presses the top down by four fifths of its weight
    between,  // one from the top to the bottom
    lifts     // one that bears a third of the top
};

struct Stack {
    const char* setting;
    Acts acts = Acts::faint;
    int count = 3;
    double stiffness = 2000;  // N/m, of a spring
    double damping = 0;       // N s/m
    double dt = 1.0 / 60;     // s
    Quat turn = Quat::Identity();
    Vec3 off = Vec3::Zero();
    bool top_first = false;
    void (*choose)(Settings&) = [](Settings&) {};
};

// From a cube to a place in the stack's axes.
void tie(Scene& scene, const Stack& stack, std::uint32_t body, const Vec3& to)
{
    Spring spring;
    spring.a = body;
    spring.at_b = stack.off + stack.turn * to;
    spring.stiffness = stack.stiffness;
    spring.damping = stack.damping;
    scene.springs.push_back(spring);
}

void act(Scene& scene, const Stack& stack, const std::vector<std::uint32_t>& cubes)
{
    const auto place = [&](const Vec3& at) -> Vec3 { return stack.off + stack.turn * at; };
    const std::size_t middle = cubes.size() / 2;
    const double top = kHalf * (2 * static_cast<double>(cubes.size()) - 1);
    switch (stack.acts) {
    case Acts::faint:
        scene.attractors.push_back({place(Vec3(40, 20, 43)), -1});
        break;
    case Acts::repels:
        scene.attractors.push_back({place(Vec3(40, 20, 43)), -7800});
        break;
    case Acts::planet:
        scene.gravity = Vec3::Zero();
        scene.attractors.push_back({place(Vec3(0, 0, -kPlanet)), kGravity * kPlanet * kPlanet});
        break;
    case Acts::aside:
        tie(scene, stack, cubes[middle],
            Vec3(500 / stack.stiffness, 0, kHalf * (2 * static_cast<double>(middle) + 1)));
        break;
    case Acts::presses:
        tie(scene, stack, cubes.back(), Vec3(0, 0, top - 4000 / stack.stiffness));
        break;
    case Acts::between:
        scene.springs.push_back({cubes.back(), cubes.front(), Vec3::Zero(), Vec3::Zero(),
                                 stack.stiffness, stack.damping, 0});
        break;
    case Acts::lifts:
        tie(scene, stack, cubes.back(), Vec3(0, 0, top + 1600 / stack.stiffness));
        break;
    }
}

void stand(CaseBench& bench, const Stack& stack)
{
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    scene.settings.dt = stack.dt;
    scene.settings.sleep = false;
    stack.choose(scene.settings);
    const Vec3 up = stack.turn * Vec3::UnitZ();
    scene.gravity = -kGravity * up;
    parts.plane(parts.material(0.5), up, up.dot(stack.off));
    std::vector<std::uint32_t> cubes(static_cast<std::size_t>(stack.count));
    for (int i = 0; i < stack.count; ++i) {
        const int place = stack.top_first ? stack.count - 1 - i : i;
        const Vec3 at = stack.off + kHalf * (2 * place + 1) * up;
        cubes[static_cast<std::size_t>(place)] =
            parts.box(0, kMass, Vec3::Constant(kHalf), {at, stack.turn});
    }
    act(scene, stack, cubes);

    EnergyLedger ledger;
    const double time = bench.brief() ? 5 : 10, rest_by = time - 1;
    double fastest = 0;
    const auto watch = [&](World& world, double now) {
        if (now < rest_by) return true;
        for (const BodyId id : world.bodies())
            fastest = std::max(fastest, world.velocity(id).norm());
        return true;
    };
    bench.run(scene, time, watch, &ledger);
    bench.report(stack.setting, "greatest speed in the last second", fastest, 1e-4, "m/s");
    bench.report(stack.setting, "energy gained over the weight times a millimeter",
                 ledger.gained() / (1e-3 * kMass * stack.count * kGravity), 0.01, "1");
}

// With sleep on, as it is by default.
void sleep(CaseBench& bench)
{
    SceneParts parts(bench.scene());
    parts.plane(parts.material(0.5), Vec3::UnitZ(), 0);
    for (int i = 0; i < 3; ++i)
        parts.box(0, kMass, Vec3::Constant(kHalf), {Vec3(0, 0, kHalf * (2 * i + 1))});
    parts.scene().attractors.push_back({Vec3(40, 20, 43), -1});
    std::size_t awake = 0;
    const auto watch = [&](World& world, double) {
        awake = world.report().bodies_awake;
        return true;
    };
    bench.run(parts.scene(), 3, watch);
    bench.report("default, a faint attractor", "awake after 3 s", static_cast<double>(awake), 0,
                 "1");
}

// A ball that bounces lower and lower where no gravity says what is slow.
void settle(CaseBench& bench, const std::string& setting, void (*choose)(Settings&))
{
    SceneParts parts(bench.scene());
    parts.scene().settings.sleep = false;
    choose(parts.scene().settings);
    parts.scene().gravity = Vec3::Zero();
    parts.scene().attractors.push_back({Vec3(0, 0, -kPlanet), kGravity * kPlanet * kPlanet});
    parts.plane(parts.material(0, 0.5), Vec3::UnitZ(), 0);
    const std::uint32_t ball = parts.ball(0, kMass, kHalf, Vec3(0, 0, 1));
    double speed = 0;
    const auto watch = [&](World& world, double) {
        speed = world.velocity(BodyId{ball}).norm();
        return true;
    };
    bench.run(parts.scene(), 4, watch);
    bench.report(setting + ", a ball on a planet, e 0.5", "speed after 4 s", speed, 1e-4, "m/s");
}

// A box of 1 kg that swings on a spring along a smooth floor, upon which another may press it.
void swing(CaseBench& bench, double amplitude, double stiffness, double pressed)
{
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    scene.settings.sleep = false;
    parts.plane(parts.material(0), Vec3::UnitZ(), 0);
    const std::uint32_t box = parts.box(0, 1, Vec3::Constant(0.1), {Vec3(amplitude, 0, 0.1)});
    scene.springs.push_back({box, kNone, Vec3::Zero(), Vec3(0, 0, 0.1), stiffness, 0, 0});
    if (pressed > 0)
        scene.springs.push_back({box, kNone, Vec3::Zero(), Vec3(0, 0, -pressed), 1, 0, 0});
    const double all = stiffness + (pressed > 0 ? 1 : 0);
    double furthest = 0;
    const double time = bench.brief() ? 3 : 60;
    const auto watch = [&](World& world, double now) {
        const double x = world.pose(BodyId{box}).position.x(), v = world.velocity(BodyId{box}).x();
        if (now > time - 1) furthest = std::max(furthest, std::sqrt(x * x + v * v / all));
        return true;
    };
    bench.run(scene, time, watch);
    char setting[80];
    std::snprintf(setting, sizeof setting, "default, swing of %g m, %g N/m, pressed by %g N",
                  amplitude, stiffness, pressed);
    bench.report(setting, "amplitude at the end, off what it was",
                 std::abs(furthest / amplitude - 1), 0.01, "1");
}

}  // namespace

void case_rest_under_forces(CaseBench& bench)
{
    using enum Acts;
    const auto more = [](Settings& settings) { settings.substeps = 16; };
    const auto plainly = [](Settings& settings) { settings.solver = Solver::pgs; };
    const auto finely = [](Settings& settings) { settings.precision = Precision::double_; };
    const auto by_order = [](Settings& settings) { settings.integrator = Integrator::rk4; };
    const auto softly = [](Settings& settings) { settings.response = Response::penalty; };
    const Quat aslant = Quat(0.9, 0.2, -0.3, 0.1).normalized();
    const Vec3 far(1e5, -2e5, 3e5);
    const Stack all[] = {
        {.setting = "default, a faint attractor"},
        {.setting = "default, a faint attractor, dt=1/240", .dt = 1.0 / 240},
        {.setting = "default, a faint attractor, dt=1e-3", .dt = 1e-3},
        {.setting = "default, an attractor that drives off", .acts = repels},
        {.setting = "default, a planet", .acts = planet},
        {.setting = "default, a planet, turned", .acts = planet, .turn = aslant},
        {.setting = "default, a planet, far off", .acts = planet, .off = far},
        {.setting = "default, a planet, the top first", .acts = planet, .top_first = true},
        {.setting = "default, a planet, 16 substeps", .acts = planet, .choose = more},
        {.setting = "default, drawn aside", .acts = aside},
        {.setting = "default, drawn aside, 50 kN/m", .acts = aside, .stiffness = 5e4},
        {.setting = "default, drawn aside, dt=1/240", .acts = aside, .dt = 1.0 / 240},
        {.setting = "default, pressed", .acts = presses},
        {.setting = "default, pressed, damped", .acts = presses, .damping = 300},
        {.setting = "default, pressed, turned", .acts = presses, .turn = aslant},
        {.setting = "default, pressed, far off", .acts = presses, .off = far},
        {.setting = "default, pressed, the top first", .acts = presses, .top_first = true},
        {.setting = "default, pressed, 16 substeps", .acts = presses, .choose = more},
        {.setting = "default, pressed, dt=1e-3", .acts = presses, .dt = 1e-3},
        {.setting = "default, a spring from top to bottom", .acts = between},
        {.setting = "default, lifted", .acts = lifts},
        {.setting = "double, a planet", .acts = planet, .choose = finely},
        {.setting = "double, pressed", .acts = presses, .choose = finely},
        {.setting = "pgs, a planet", .acts = planet, .choose = plainly},
        {.setting = "pgs, pressed", .acts = presses, .choose = plainly},
        {.setting = "rk4, a planet", .acts = planet, .choose = by_order},
        {.setting = "direct, a planet", .acts = planet, .choose = ask_exactly},
        {.setting = "direct, pressed", .acts = presses, .choose = ask_exactly},
    };
    for (const Stack& stack : all) stand(bench, stack);
    sleep(bench);
    settle(bench, "default", [](Settings&) {});
    settle(bench, "16 substeps", more);
    settle(bench, "double", finely);
    settle(bench, "pgs", plainly);
    settle(bench, "rk4", by_order);
    settle(bench, "direct", ask_exactly);
    settle(bench, "penalty", softly);
    for (const double amplitude : {0.1, 0.01, 0.001})
        for (const double stiffness : {20.0, 100.0, 500.0})
            for (const double pressed : {0.0, 10.0}) swing(bench, amplitude, stiffness, pressed);
}

}  // namespace throng
