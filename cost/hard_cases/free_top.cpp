// Free tops: H1, H2, H5 and H6.
//
// Answers for H1 were worked out in quadruple precision and checked against the closed form by
// elliptic functions. Its bounds are twice the errors that a plain program of each method made at
// the same steps; below 1e-11 rad rounding is all there is.
#include "cost/hard_cases/free_bodies.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace throng {

namespace {

constexpr double kRounding = 1e-11;  // rad

struct Top {
    const char* name;
    Vec3 moments, spin;
    Quat after;  // 10 s
};

const std::array<Top, 3>& tops()
{
    static const std::array<Top, 3> kTops = {{
        {"P1", Vec3(97.0 / 120, 41.0 / 60, 17.0 / 120), Vec3(0.1, 5, 0.1),
         Quat(0.225164563413958, -0.619927562499452, -0.277029150687195, 0.698745723640310)},
        {"P2", Vec3(1, 2, 3), Vec3(0.1, 10, 0.1),
         Quat(-0.015646241514854, 0.965439574274270, -0.000079716094040, -0.260156908801055)},
        {"P3", Vec3(1, 2, 3), Vec3(1, 2, 3),
         Quat(0.075296477090981, -0.159560295830693, -0.308386425654513, -0.934755992226925)},
    }};
    return kTops;
}

// Errors that were published for a method at 1/60, 1e-2, 1e-3 and 1e-4 s; 0: none was.
struct KnownErrors {
    std::size_t top;
    Integrator integrator;
    std::array<double, 4> error;  // rad
};
constexpr std::array<double, 4> kSteps = {1.0 / 60, 1e-2, 1e-3, 1e-4};
constexpr KnownErrors kKnown[] = {
    {0, Integrator::splitting, {6.4e-2, 2.3e-2, 2.3e-4, 2.3e-6}},
    {0, Integrator::rk4, {7.4e-6, 8.9e-7, 5.4e-11, 0}},
    {1, Integrator::midpoint, {2.0, 2.7, 3.9e-4, 1.6e-6}},
    {1, Integrator::splitting, {3.4e-3, 1.2e-3, 1.2e-5, 1.2e-7}},
    {1, Integrator::rk4, {1.0e-4, 1.2e-5, 9.2e-10, 1.4e-12}},
    {2, Integrator::semi_implicit, {1.9, 1.4, 0.18, 0.018}},
    {2, Integrator::euler, {1.1, 2.5, 0.19, 0.018}},
    {2, Integrator::midpoint, {1.1e-2, 3.9e-3, 3.8e-5, 3.8e-7}},
    {2, Integrator::splitting, {3.0e-3, 1.1e-3, 1.1e-5, 1.1e-7}},
    {2, Integrator::rk4, {1.4e-6, 1.7e-7, 1.5e-11, 1.4e-13}},
    // By default it goes as by splitting.
    {0, Integrator::auto_, {6.4e-2, 2.3e-2, 2.3e-4, 2.3e-6}},
    {1, Integrator::auto_, {3.4e-3, 1.2e-3, 1.2e-5, 1.2e-7}},
    {2, Integrator::auto_, {3.0e-3, 1.1e-3, 1.1e-5, 1.1e-7}},
};

// Orders are fitted where errors are as small as theory has them and greater than rounding.
std::vector<double> steps_to_fit(int order)
{
    if (order == 1) return {5e-4, 2e-4, 1e-4};
    if (order == 2) return {5e-3, 2e-3, 1e-3, 1e-4};
    return {5e-3, 2e-3, 1e-3, 5e-4};
}

struct Flight {
    Quat orientation = Quat::Identity();
    double loss = 0, gain = 0;  // greatest, of the energy
};

// Where it is after a time, with the greatest errors of what should be kept.
Flight fly(CaseBench& bench,
           const Top& top,
           const MotionChoice& choice,
           double time,
           Gyroscopic gyroscopic = Gyroscopic::implicit)
{
    Scene scene = motion_scene(bench, choice);
    scene.settings.gyroscopic = gyroscopic;
    add_free_body(scene, 10, top.moments, top.spin);
    const double energy = 0.5 * top.moments.dot(top.spin.cwiseAbs2());
    Flight flight;
    const int steps = static_cast<int>(std::llround(time / choice.dt));
    int step = 0;
    bench.run(scene, time, [&](World& world, double) {
        ++step;
        if (step % 64 != 0 && step != steps) return true;
        const Measures now = world.measure();
        flight.loss = std::max(flight.loss, 1 - now.kinetic_energy / energy);
        flight.gain = std::max(flight.gain, now.kinetic_energy / energy - 1);
        flight.orientation = world.pose(world.bodies()[0]).orientation;
        return true;
    });
    return flight;
}

double error_at(CaseBench& bench, const Top& top, MotionChoice choice, double dt)
{
    choice.dt = dt;
    return angle_between(fly(bench, top, choice, 10).orientation, top.after);
}

void hold_to_known(CaseBench& bench, const KnownErrors& known, Rotation rotation)
{
    const Top& top = tops()[known.top];
    const MotionChoice choice{known.integrator, rotation};
    for (std::size_t i = 0; i < kSteps.size(); ++i) {
        if (known.error[i] == 0 || (bench.brief() && kSteps[i] < 1e-3)) continue;
        const double error = error_at(bench, top, choice, kSteps[i]);
        const char* const step[] = {"1/60", "1e-2", "1e-3", "1e-4"};
        bench.report(
            std::string(top.name) + ", " + name_of(choice.integrator, rotation) + ", dt=" + step[i],
            "angle from the answer", error, std::max(2 * known.error[i], kRounding), "rad");
    }
}

void fit_order(CaseBench& bench, const Top& top, Integrator integrator, Rotation rotation)
{
    const int order = order_of(integrator);
    if (order == 1 && &top == &tops()[1]) return;  // far off at every step that can be afforded
    const std::vector<double> steps = steps_to_fit(order);
    std::vector<double> errors;
    errors.reserve(steps.size());
    for (const double dt : steps)
        errors.push_back(error_at(bench, top, {integrator, rotation}, dt));
    bench.report(std::string(top.name) + ", " + name_of(integrator, rotation),
                 "fitted order from " + std::to_string(order),
                 std::abs(fitted_order(steps, errors, kRounding, 0.1) - order), 0.15, "1");
}

// No step is timed where figures are compared.
void time_step(CaseBench& bench, Integrator integrator, Rotation rotation)
{
    if (bench.brief()) return;
    constexpr int kManyBodies = 1000, kManySteps = 100;
    Scene scene = motion_scene(bench, {integrator, rotation, 1e-3});
    for (int i = 0; i < kManyBodies; ++i)
        add_free_body(scene, 10, tops()[2].moments, tops()[2].spin);
    bench.run(scene, kManySteps * 1e-3, [](World&, double) { return true; });
    bench.report_time(name_of(integrator, rotation), "time a step of a body",
                      bench.time_a_step() / kManyBodies);
}

// Without the gyroscopic torque there is no answer at any step, and the case has to show it.
void miss_without_torque(CaseBench& bench)
{
    const Top& top = tops()[2];
    const Flight flight =
        fly(bench, top, {Integrator::rk4, Rotation::quaternion, 1e-2}, 10, Gyroscopic::off);
    bench.report("P3, rk4, gyroscopic=off", "angle from the answer, from 2.7",
                 std::abs(angle_between(flight.orientation, top.after) - 2.7), 0.1, "rad");
}

// The rate at which the middle axis spins, seen along the flight: how often it changes sign.
void flip_for_long(
    CaseBench& bench, Integrator integrator, double dt, double energy, double momentum)
{
    const Top& top = tops()[1];
    const double time = 391.0573419727;  // s, 100 periods
    Scene scene = motion_scene(bench, {integrator, Rotation::quaternion, dt});
    add_free_body(scene, 10, top.moments, top.spin);
    const double energy0 = 0.5 * top.moments.dot(top.spin.cwiseAbs2());
    const double momentum0 = top.moments.cwiseProduct(top.spin).norm();
    double last = top.spin.y(), early = 0, late = 0, momentum_error = 0;
    int flips = 0;
    bench.run(scene, time, [&](World& world, double now) {
        const BodyId body = world.bodies()[0];
        const Vec3 spin = world.pose(body).orientation.conjugate() * world.angular_velocity(body);
        if (spin.y() * last < 0) ++flips;
        last = spin.y();
        const double error = std::abs(0.5 * top.moments.dot(spin.cwiseAbs2()) / energy0 - 1);
        (now < 0.1 * time ? early : late) = std::max(now < 0.1 * time ? early : late, error);
        momentum_error = std::max(momentum_error,
                                  std::abs(top.moments.cwiseProduct(spin).norm() / momentum0 - 1));
        return true;
    });
    const std::string setting =
        name_of(integrator, Rotation::quaternion) + (dt > 5e-3 ? ", dt=1e-2" : ", dt=1e-3");
    bench.report(setting, "flips off 200", std::abs(flips - 200), 0, "1");
    bench.report(setting, "energy error", std::max(early, late), energy, "1");
    if (momentum == 0) return;
    bench.report(setting, "angular momentum error", momentum_error, momentum, "1");
    bench.report(setting, "energy error, all over the first tenth", std::max(early, late) / early,
                 1.1, "1");
}

void only_loses(CaseBench& bench, double dt, const char* step, double loss)
{
    const Flight flight =
        fly(bench, tops()[2], {Integrator::semi_implicit, Rotation::quaternion, dt}, 10);
    const std::string setting = std::string("P3, semi_implicit, dt=") + step;
    bench.report(setting, "energy gained", flight.gain, 1e-12, "1");
    bench.report(setting, "energy lost", flight.loss, loss, "1");
}

// What a body turns by in one step at a constant spin, against the law of its rotation.
void turn_once(CaseBench& bench, Rotation rotation, double turn)
{
    const Vec3 axis = Vec3(1, 2, 3) / std::sqrt(14.0);
    const double dt = 1e-2;
    Scene scene = motion_scene(bench, {Integrator::semi_implicit, rotation, dt});
    add_free_body(scene, 1, Vec3(1, 1, 1), axis * (turn / dt));
    double angle = 0;
    bench.run(scene, dt, [&](World& world, double) {
        angle = angle_between(Quat::Identity(), world.pose(world.bodies()[0]).orientation);
        return true;
    });
    const bool adds_rates = rotation == Rotation::quaternion_euler
        || rotation == Rotation::matrix_euler || rotation == Rotation::matrix_euler_repaired;
    const double law = !adds_rates               ? turn
        : rotation == Rotation::quaternion_euler ? 2 * std::atan(0.5 * turn)
                                                 : std::atan(turn);
    bench.report("one turn of " + std::string(turn < 0.5 ? "0.1" : "1") + " rad, "
                     + name_of(Integrator::semi_implicit, rotation),
                 "angle from its law", std::abs(angle - law), 1e-12, "rad");
}

void spin_fast(CaseBench& bench, Integrator integrator, Rotation rotation)
{
    const Vec3 axis = Vec3(1, 2, 3) / std::sqrt(14.0);
    const double spin = 1000, dt = 1.0 / 60, time = 10;
    Scene scene = motion_scene(bench, {integrator, rotation, dt});
    add_free_body(scene, 1, Vec3(1, 1, 1), axis * spin);
    Quat end;
    bench.run(scene, time, [&](World& world, double) {
        end = world.pose(world.bodies()[0]).orientation;
        return true;
    });
    const Quat wanted = exponential(axis * std::remainder(spin * time, 4 * 3.14159265358979323846));
    bench.report("1000 rad/s, " + name_of(integrator, rotation), "angle from the answer",
                 angle_between(end, wanted), 1e-9, "rad");
}

// A body about its stiffest axis, a little off it: how far it strays from there.
void spin_off_axis(CaseBench& bench, Integrator integrator)
{
    const Vec3 moments = Vec3(1, 1.2, 1.5) * 1e-3, spin(1, 1, 1000);
    Scene scene = motion_scene(bench, {integrator, Rotation::quaternion, 1e-4});
    add_free_body(scene, 1, moments, spin);
    const double energy = moments.dot(spin.cwiseAbs2());
    double energy_error = 0, strayed = 0;
    bench.run(scene, bench.brief() ? 1 : 10, [&](World& world, double) {
        const BodyId body = world.bodies()[0];
        const Vec3 now = world.pose(body).orientation.conjugate() * world.angular_velocity(body);
        energy_error = std::max(energy_error, std::abs(moments.dot(now.cwiseAbs2()) / energy - 1));
        strayed = std::max(strayed, std::hypot(now.x(), now.y()) / now.norm());
        return energy_error < 1;
    });
    const std::string setting = "off axis, " + name_of(integrator, Rotation::quaternion);
    // Euler's has to fail: the line is of how little it would have to.
    if (integrator == Integrator::euler)
        return bench.report(setting, "1e-6 less energy error", 1e-6 - energy_error, 0, "1");
    bench.report(setting, "energy error", energy_error, 1e-6, "1");
    bench.report(setting, "way off the greatest axis", strayed, 1e-2, "rad");
}

// Largest element of R^T R - 1.
double strays(const Mat3& m)
{
    return (m.transpose() * m - Mat3::Identity()).cwiseAbs().maxCoeff();
}

void stay_on_group(CaseBench& bench, Rotation rotation, Precision precision)
{
    const int steps = bench.brief() ? 100 : 10000;
    Scene scene = motion_scene(bench, {Integrator::semi_implicit, rotation, 1000.0 / 60, 1000});
    scene.settings.precision = precision;
    add_free_body(scene, 1, Vec3(1, 1, 1), Vec3(1, 2, 3) / std::sqrt(14.0) * 1000);
    double worst = 0;
    bench.run(scene, steps * scene.settings.dt, [&](World& world, double) {
        worst = std::max(worst, strays(world.rotation_matrix(world.bodies()[0])));
        return true;
    });
    const bool exact = precision == Precision::double_;
    bench.report(std::to_string(steps) + "000 steps, "
                     + name_of(Integrator::semi_implicit, rotation)
                     + (exact ? ", double" : ", float"),
                 "greatest element of R'R - 1", worst, exact ? 1e-14 : 1e-6, "1");
}

// A matrix that is not repaired grows by sqrt(1 + (w h)^2) a step, across the axis.
void grow_without_repair(CaseBench& bench, double spin, double dt)
{
    const int steps = static_cast<int>(std::llround(1 / dt));
    Scene scene = motion_scene(bench, {Integrator::euler, Rotation::matrix_euler, dt});
    add_free_body(scene, 1, Vec3(1, 1, 1), Vec3(1, 2, 3) / std::sqrt(14.0) * spin);
    double squares = 0;
    bench.run(scene, 1, [&](World& world, double) {
        squares = world.rotation_matrix(world.bodies()[0]).squaredNorm();
        return true;
    });
    const double grown = std::sqrt((squares - 1) / 2);
    const double law = std::pow(1 + spin * dt * spin * dt, 0.5 * steps);
    bench.report(std::to_string(static_cast<int>(spin)) + " rad/s, "
                     + name_of(Integrator::euler, Rotation::matrix_euler),
                 "growth in 1 s, from its law", std::abs(grown / law - 1), 1e-9, "1");
}

}  // namespace

void case_free_top(CaseBench& bench)
{
    for (const Rotation rotation : kExponentialRotations) {
        for (const KnownErrors& known : kKnown) hold_to_known(bench, known, rotation);
        if (bench.brief()) break;
    }
    miss_without_torque(bench);
    if (bench.brief()) return;
    for (std::size_t rotation = 0; rotation < 6; ++rotation)
        for (const KnownOrder& row : kIntegrators) {
            for (const Top& top : tops())
                fit_order(bench, top, row.which, static_cast<Rotation>(rotation));
            time_step(bench, row.which, static_cast<Rotation>(rotation));
        }
}

void case_long_flight(CaseBench& bench)
{
    // Twice what a plain program of each was off by; to kick and to swerve loses energy only.
    flip_for_long(bench, Integrator::rk4, 1e-2, 8.6e-6, 0);
    flip_for_long(bench, Integrator::splitting, 1e-2, 1.38e-4, 1e-12);
    // The wide kernel tells spins in world axes from step to step.
    flip_for_long(bench, Integrator::auto_, 1e-2, 1.38e-4, 1e-11);
    only_loses(bench, 1.0 / 60, "1/60", 0.34);
    if (bench.brief()) return;
    flip_for_long(bench, Integrator::rk4, 1e-3, 9.8e-11, 0);
    flip_for_long(bench, Integrator::splitting, 1e-3, 1.38e-6, 1e-12);
    only_loses(bench, 1e-4, "1e-4", 0.004);
}

void case_high_spin(CaseBench& bench)
{
    for (const double turn : {0.1, 1.0})
        for (std::size_t rotation = 0; rotation < 6; ++rotation)
            turn_once(bench, static_cast<Rotation>(rotation), turn);
    for (const Rotation rotation : kExponentialRotations)
        for (const KnownOrder& row : kIntegrators) spin_fast(bench, row.which, rotation);
    for (const KnownOrder& row : kIntegrators) spin_off_axis(bench, row.which);
    spin_off_axis(bench, Integrator::auto_);
}

void case_rotation_drift(CaseBench& bench)
{
    for (const Rotation rotation : kExponentialRotations) {
        stay_on_group(bench, rotation, Precision::double_);
        stay_on_group(bench, rotation, Precision::float_);
    }
    grow_without_repair(bench, 100, 1e-3);
    grow_without_repair(bench, 1000, 1e-4);
}

}  // namespace throng
