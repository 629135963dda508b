// The longest step of a spring: H46.
//
// A mass on a spring, moved by an explicit rule, swings wider and wider beyond a limit that is
// known: 2 / w undamped and (2 / w)(sqrt(1 + z^2) - z) damped for the semi-implicit rule, 2 sqrt(2)
// / w for rk4, none for Euler's, which grows by sqrt(1 + w^2 h^2) a step. throng has to tell.
//
// By default no spring gets there: from half of the limit on it goes by an implicit rule, so that
// on either side nothing swings wider, and there is nothing to tell; in flight that holds whatever
// answers contacts.
#include "cost/hard_cases/free_bodies.hpp"
#include "cost/hard_cases/hard_cases.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kStiffness = 1e6, kMass = 1, kFrequency = 1000;  // N/m, kg, rad/s
constexpr double kFirst = 1e-3;                                   // m, the first swing

struct Swing {
    double widest = 0;  // m
    double last = 0;    // m, how wide the last swing would come to be
    bool warned = false;
};

// The spring's own length is far beyond any swing, or the law would be another.
Swing swing(CaseBench& bench,
            const MotionChoice& choice,
            double ratio,
            int steps,
            Response response = Response::impulse)
{
    constexpr double kLength = 1, kTooWide = 0.1;  // m
    Scene scene = motion_scene(bench, choice);
    scene.settings.response = response;
    BodyDescription& body = add_free_body(scene, kMass, Vec3(1, 1, 1), Vec3::Zero());
    body.position = Vec3(0, 0, kLength + kFirst);
    Spring spring;
    spring.a = 0;
    spring.stiffness = kStiffness;
    spring.damping = 2 * ratio * kFrequency * kMass;
    spring.length = kLength;
    scene.springs.push_back(spring);
    Swing result;
    bench.run(scene, steps * choice.dt, [&](World& world, double) {
        const BodyId mass = world.bodies()[0];
        const double off = world.center_of_mass(mass).z() - kLength;
        result.warned = !world.warnings().empty();
        result.widest = std::max(result.widest, std::abs(off));
        result.last = std::hypot(off, world.velocity(mass).z() / kFrequency);
        return result.widest < kTooWide;
    });
    return result;
}

constexpr int kSteps = 2000;

std::string setting_of(Integrator integrator, Response response, double ratio)
{
    const char* const of = ratio == 0 ? "0" : ratio < 0.5 ? "0.1" : "1";
    return name_of(integrator, Rotation::quaternion)
        + (response == Response::penalty ? ", penalty" : "") + ", damping ratio " + of;
}

void either_side(CaseBench& bench, Integrator integrator, double ratio, double limit)
{
    const std::string setting = setting_of(integrator, Response::impulse, ratio);
    const Swing within =
        swing(bench, {integrator, Rotation::quaternion, 0.98 * limit}, ratio, kSteps);
    // Next to the limit a swing is 1 / sqrt(1 - 0.98^2) as wide as it is far from it.
    bench.report(setting + ", 0.98 of the limit", "widest swing, of the first",
                 within.widest / kFirst, 6, "1");
    bench.report(setting + ", 0.98 of the limit", "warnings", within.warned ? 1 : 0, 0, "1");
    const Swing beyond =
        swing(bench, {integrator, Rotation::quaternion, 1.02 * limit}, ratio, kSteps);
    bench.report(setting + ", 1.02 of the limit", "first swing, of the widest",
                 kFirst / beyond.widest, 2e-2, "1");
    bench.report(setting + ", 1.02 of the limit", "warnings that are missing",
                 beyond.warned ? 0 : 1, 0, "1");
}

// By default: at shares of the limit, and far beyond.
void holds_on_either_side(CaseBench& bench, double ratio, double limit, Response response)
{
    const std::string setting = setting_of(Integrator::semi_implicit, response, ratio);
    for (const double share : {0.49, 0.51, 0.98, 1.02, 10.0, 1000.0}) {
        const std::string text = std::to_string(share);
        const Swing swung =
            swing(bench, {Integrator::semi_implicit, Rotation::quaternion, share * limit}, ratio,
                  kSteps, response);
        const std::string at =
            setting + ", " + text.substr(0, text.find('.') + 3) + " of the limit";
        // At half of the limit the semi-implicit rule makes it 1 / sqrt(1 - 0.5^2) as wide.
        bench.report(at, "widest swing, of the first", swung.widest / kFirst,
                     share < 0.5 ? 1.16 : 1 + 1e-6, "1");
        bench.report(at, "warnings", swung.warned ? 1 : 0, 0, "1");
    }
}

void grow(CaseBench& bench)
{
    constexpr double kDt = 1e-5;
    constexpr int kMany = 20000;
    const Swing swung = swing(bench, {Integrator::euler, Rotation::quaternion, kDt}, 0, kMany);
    const double wide = kFirst * std::pow(1 + kFrequency * kDt * kFrequency * kDt, 0.5 * kMany);
    bench.report("euler, dt=1e-5", "growth from its law", std::abs(swung.last / wide - 1), 1e-9,
                 "1");
    bench.report("euler, dt=1e-5", "warnings that are missing", swung.warned ? 0 : 1, 0, "1");
}

}  // namespace

void case_spring_limit(CaseBench& bench)
{
    for (const double ratio : {0.0, 0.1, 1.0}) {
        const double limit = 2 / kFrequency * (std::sqrt(1 + ratio * ratio) - ratio);
        for (const Response response : {Response::impulse, Response::penalty})
            holds_on_either_side(bench, ratio, limit, response);
    }
    either_side(bench, Integrator::splitting, 0, 2 / kFrequency);
    either_side(bench, Integrator::rk4, 0, 2 * std::sqrt(2.0) / kFrequency);
    grow(bench);
    penalty_limit(bench);
}

}  // namespace throng
