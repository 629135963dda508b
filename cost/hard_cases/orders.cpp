// Orders: H126, how errors fall with what they are made smaller by: a step, or a tolerance.
//
// Answers: a soft contact whose rate goes with the substep h gives way as h^2, and one of a fixed
// rate by the same at any. Who slides stops within a substep of where Coulomb's law has him, who
// falls by the semi-implicit rule is g h t / 2 ahead, and bounces when a substep ends: order 1.
// Bodies that are carried to where they touch, on exact paths, bounce exactly at any step. A time
// of impact is off by what the tolerance is crossed in: order 1 in that; bisection asks for each
// bit, conservative advancement for each digit, and Newton's method hardly for more.
#include "cost/hard_cases/free_bodies.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"
#include "throng/queries.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <span>
#include <string>

namespace throng {

namespace {

constexpr double kOff = 0.15;  // of a fitted order
constexpr double kSteps[] = {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 480};

struct How {
    std::string setting;
    std::function<void(Settings&)> set = [](Settings&) {};
    Pose place = {};
};

const Pose kFarOff{Vec3(700, -300, 100), Quat(0.8, 0.36, 0, 0.48)};

void report_order(CaseBench& bench,
                  const How& how,
                  const std::string& what,
                  double expected,
                  std::span<const double> steps,
                  std::span<const double> errors)
{
    const double order = fitted_order(steps, errors, 0, 1e30);
    bench.show(how.setting, "order of " + what, order, "1");
    bench.report(how.setting, "order of " + what + ", off " + number_text(expected),
                 std::abs(order - expected), kOff, "1");
}

// The same with one thing more set.
How with(const How& how, const std::function<void(Settings&)>& more)
{
    How both = how;
    both.set = [set = how.set, more](Settings& settings) {
        set(settings);
        more(settings);
    };
    return both;
}

// The greatest overlap of ten boxes on one another that are at rest.
double overlap_of_stack(CaseBench& bench, const How& how)
{
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    parts.scene().settings.sleep = false;
    const std::uint32_t stone = parts.material(0.5);
    parts.level_ground(stone, how.place);
    for (int i = 0; i < 10; ++i)
        parts.box(stone, 1, Vec3::Constant(0.5),
                  how.place * Pose{Vec3(0, 0, 0.5 + i), Quat::Identity()});
    double overlap = 0;
    bench.run(parts.scene(), 6, [&](World& world, double time) {
        if (time > 5.9) overlap = world.measure().greatest_overlap;
        return true;
    });
    return overlap;
}

void order_of_overlap(CaseBench& bench, const How& how, double expected)
{
    const double substeps[] = {2, 4, 8, 16, 32};
    std::vector<double> steps, overlaps;
    for (const double each : std::span(substeps).first(bench.brief() ? 3 : std::size(substeps))) {
        const auto set = [&](Settings& settings) { settings.substeps = static_cast<int>(each); };
        steps.push_back(1 / each);
        overlaps.push_back(overlap_of_stack(bench, with(how, set)));
    }
    report_order(bench, how, "the overlap in the substep", expected, steps, overlaps);
}

// Runs for a time, s, and tells how far bodies are off where they should be then, rms: what `off`
// has of each, by its place in the list and where it is in the axes of the whole.
double rms_at_end(CaseBench& bench,
                  const How& how,
                  const Scene& scene,
                  std::span<const std::uint32_t> bodies,
                  double time,
                  const std::function<double(std::size_t, const Vec3&)>& off)
{
    double squares = 0;
    bench.run(scene, time, [&](World& world, double) {
        squares = 0;
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            const Vec3 at = how.place.inverse() * world.pose(world.bodies()[bodies[i]]).position;
            squares += std::pow(off(i, at), 2) / static_cast<double>(bodies.size());
        }
        return true;
    });
    return std::sqrt(squares);
}

// How far eight boxes slide until they stop, off what Coulomb's law has.
double error_of_stop(CaseBench& bench, const How& how)
{
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    const double friction = 0.5;
    const std::uint32_t wood = parts.material(friction);
    parts.level_ground(wood, how.place);
    const double speeds[] = {3.1, 3.37, 3.62, 3.9, 4.13, 4.41, 4.77, 5.05};
    std::vector<std::uint32_t> boxes;
    for (const double speed : speeds) {
        const Pose at{Vec3(0, 3.0 * static_cast<double>(boxes.size()), 0.1), Quat::Identity()};
        boxes.push_back(parts.box(wood, 1, Vec3(0.5, 0.5, 0.1), how.place * at));
        parts.body(boxes.back()).velocity = how.place.orientation * Vec3(speed, 0, 0);
    }
    return rms_at_end(bench, how, parts.scene(), boxes, 2, [&](std::size_t i, const Vec3& at) {
        return at.x() - speeds[i] * speeds[i] / (2 * friction * kGravity);
    });
}

// Eight balls that fall and bounce without loss for 3 s.
double error_of_bounces(CaseBench& bench, const How& how)
{
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    const std::uint32_t ivory = parts.material(0, 1);
    parts.level_ground(ivory, how.place);
    const double radius = 0.1, time = 3;
    const double heights[] = {1, 1.13, 1.29, 1.41, 1.57, 1.73, 1.9, 2.11};
    std::vector<std::uint32_t> balls;
    for (const double height : heights)
        balls.push_back(parts.ball(
            ivory, 1, radius,
            how.place * Vec3(3.0 * static_cast<double>(balls.size()), 0, height + radius)));
    return rms_at_end(bench, how, parts.scene(), balls, time, [&](std::size_t i, const Vec3& at) {
        const double fall = std::sqrt(2 * heights[i] / kGravity);
        const double since = std::fmod(time - fall, 2 * fall);
        return at.z() - radius - kGravity * since * (fall - since / 2);
    });
}

std::vector<double>
errors_by_step(CaseBench& bench, const How& how, double (*error)(CaseBench&, const How&))
{
    std::vector<double> errors;
    for (const double dt : kSteps) {
        const auto set = [&](Settings& settings) { settings.dt = dt; };
        errors.push_back(error(bench, with(how, set)));
    }
    return errors;
}

// A rod of 1 m that turns and meets a wall at such a distance from its pivot, asked of each method
// by tolerances from a millimeter to a nanometer.
void orders_of_impact_times(CaseBench& bench, double wall, double advances)
{
    const double spin = 50 * kPi, radius = 0.1, tolerances[] = {1e-3, 1e-6, 1e-9};
    ShapeMotion turning, still;
    turning.pose.orientation = exponential(Vec3(-kPi / 2, 0, 0));
    turning.angular_velocity = Vec3(0, 0, -spin);
    still.pose.position = Vec3(wall + radius + 0.05, 0, 0);
    const ImpactQuery query({"", CapsuleShape{radius, 1}}, {"", BoxShape{Vec3(0.05, 3, 3)}});
    for (const Choice& choice : find_dial("toi_method")->choices) {
        Settings settings;
        set_dial(settings, "toi_method", choice.text);
        std::vector<double> errors;
        int first = 0, last = 0;
        for (const double tolerance : tolerances) {
            const ImpactAnswer answer =
                query.ask(turning, still, 1.0 / 60, settings.toi_method, tolerance / query.size());
            errors.push_back(std::abs(answer.time - std::asin(wall) / spin));
            (tolerance == tolerances[0] ? first : last) = answer.evaluations;
        }
        const How how{std::string(choice.text) + ", wall at " + number_text(wall) + " m"};
        report_order(bench, how, "the time of impact in the tolerance", 1, tolerances, errors);
        if (settings.toi_method == ToiMethod::newton)
            bench.report(how.setting, "evaluations from 1e-3 to 1e-9 m", last - first, 6, "1");
        if (settings.toi_method == ToiMethod::bisection)
            bench.report(how.setting, "evaluations a bit, from 1e-3 to 1e-9 m",
                         (last - first) / std::log2(1e6), 2.5, "1");
        if (settings.toi_method == ToiMethod::conservative)
            bench.report(how.setting, "evaluations to 1e-9 m over those of the theory",
                         last / advances, 1.25, "1");
    }
}

}  // namespace

void case_orders(CaseBench& bench)
{
    const auto unescalated = [](Settings& s) { s.escalation = Escalation::off; };
    order_of_overlap(bench, {"escalation=off", unescalated}, 2);
    order_of_overlap(bench,
                     {"escalation=off, contact_rate=fixed:30",
                      [&](Settings& s) {
                          unescalated(s);
                          set_dial(s, "contact_rate", "fixed:30");
                      }},
                     0);
    const How by_default{"default"};
    const How hows[] = {by_default,
                        {"default, turned, far off", [](Settings&) {}, kFarOff},
                        {"direct", [](Settings& s) { s.solver = Solver::direct; }},
                        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }},
                        {"1 substep", [](Settings& s) { s.substeps = 1; }},
                        {"double", [](Settings& s) { s.precision = Precision::double_; }}};
    for (const How& how : std::span(hows).first(bench.brief() ? 1 : std::size(hows))) {
        report_order(bench, how, "the way to a stop in dt", 1, kSteps,
                     errors_by_step(bench, how, error_of_stop));
        report_order(bench, how, "bounces in dt", 1, kSteps,
                     errors_by_step(bench, how, error_of_bounces));
    }
    const How exact{"overlap=back_up, integrator=rk4", [](Settings& s) {
                        s.overlap = Overlap::back_up;
                        s.integrator = Integrator::rk4;
                        s.precision = Precision::double_;
                    }};
    double worst = 0;
    for (const double error : errors_by_step(bench, exact, error_of_bounces))
        worst = std::max(worst, error);
    bench.report(exact.setting, "bounces: greatest error at any dt", worst, 2e-4, "m");
    orders_of_impact_times(bench, 0.6, 12);
    orders_of_impact_times(bench, 0.99, 112);
    orders_of_impact_times(bench, 0.9999, 901);
}

}  // namespace throng
