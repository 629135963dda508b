// Ballistic boxes: H7.
//
// The center flies along a parabola, which any update of second order has exactly and a
// semi-implicit one misses by g h T / 2; the turning of the complex one is that of H1, P1.
#include "cost/hard_cases/free_bodies.hpp"
#include "cost/hard_cases/hard_cases.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kTime = 10;                             // s
const Vec3 kMoments(97.0 / 120, 41.0 / 60, 17.0 / 120);  // kg m2: 0.1 x 0.4 x 0.9 m, 10 kg

struct Throw {
    const char* name;
    double gravity;  // m/s2, downwards
    Vec3 velocity, spin;
    double energy;  // J, at the start
};

Scene boxes(const CaseBench& bench, const Throw& box, const MotionChoice& choice, int count)
{
    Scene scene = motion_scene(bench, choice);
    scene.gravity = Vec3(0, 0, -box.gravity);
    for (int i = 0; i < count; ++i) {
        BodyDescription& body = add_free_body(scene, 10, kMoments, box.spin);
        body.velocity = box.velocity;
    }
    return scene;
}

// By how much a body's place is off after a constant acceleration, as a share of g h T / 2.
double shift_of(Integrator integrator)
{
    return integrator == Integrator::semi_implicit ? -1 : integrator == Integrator::euler ? 1 : 0;
}

void fly(CaseBench& bench, const Throw& box, Integrator integrator, double dt, int count)
{
    const Vec3 down(0, 0, -box.gravity);
    Vec3 place = Vec3::Zero(), velocity = Vec3::Zero();
    double energy = 0, energy_start = 0, apart = 0, momentum_error = 0;
    const double spin_momentum = kMoments.cwiseProduct(box.spin).norm();
    const Scene scene = boxes(bench, box, {integrator, Rotation::quaternion, dt}, count);
    bench.look_at(scene, [&](const World& world) {
        const Measures start = world.measure();
        energy_start = start.kinetic_energy / count;
    });
    bench.run(scene, kTime, [&](World& world, double now) {
        if (now < kTime - 0.5 * dt) return true;
        const std::vector<BodyId> all = world.bodies();
        place = world.center_of_mass(all[0]);
        velocity = world.velocity(all[0]);
        for (const BodyId body : all)
            apart = std::max(apart, (world.center_of_mass(body) - place).norm());
        const Measures end = world.measure();
        energy = (end.kinetic_energy + end.potential_energy) / count;
        const Vec3 orbital = 10 * count * place.cross(velocity);
        momentum_error =
            std::abs((end.angular_momentum - orbital).norm() / count / spin_momentum - 1);
        return true;
    });
    const Vec3 wanted = box.velocity * kTime + 0.5 * kTime * kTime * down;
    const Vec3 shift = shift_of(integrator) * 0.5 * dt * kTime * -down;
    const std::string setting = std::string(box.name) + ", " + std::to_string(count)
        + (count > 1 ? " bodies, " : " body, ") + name_of(integrator, Rotation::quaternion)
        + (dt < 5e-4 ? ", dt=1e-4" : ", dt=1e-3");
    bench.report(setting, "place off the parabola, less the method's own shift",
                 (place - wanted - shift).norm(), 1e-9, "m");
    bench.report(setting, "velocity error", (velocity - box.velocity - kTime * down).norm(), 1e-9,
                 "m/s");
    // The answer is of moments that were rounded to five digits.
    bench.report(setting, "energy at the start, off the answer",
                 std::abs(energy_start / box.energy - 1), 2e-8, "1");
    if (count > 1) bench.report(setting, "way apart of equal bodies", apart, 0, "m");
    if (integrator == Integrator::rk4)
        bench.report(setting, "energy error", std::abs(energy / energy_start - 1), 1e-9, "1");
    if (integrator == Integrator::splitting)
        bench.report(setting, "angular momentum error", momentum_error, 1e-12, "1");
}

}  // namespace

void case_ballistic(CaseBench& bench)
{
    const Throw simple{"simple", 0, Vec3(-0.9, 0.4, 0.1), Vec3(0.5, 0, 0), 5.001041625};
    const Throw complex{"complex", 9.8, Vec3(-2, 2, 8), Vec3(0.1, 5, 0.1), 368.5464125};
    for (const Throw& box : {simple, complex})
        for (const IntegratorRow& row : integrators()) {
            const Integrator integrator = row.which;
            fly(bench, box, integrator, 1e-3, 1);
            if (!bench.brief()) fly(bench, box, integrator, 1e-4, 1);
        }
    fly(bench, complex, Integrator::rk4, 1e-3, bench.brief() ? 3 : 100);
}

}  // namespace throng
