#include "cost/hard_cases/free_bodies.hpp"

#include "throng/dials.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace throng {

int order_of(Integrator integrator)
{
    for (const KnownOrder& known : kIntegrators)
        if (known.which == integrator) return known.order;
    throw std::logic_error("an integrator without an order");
}

std::string name_of(Integrator integrator, Rotation rotation)
{
    Settings settings;
    settings.integrator = integrator;
    settings.rotation = rotation;
    return dial_value(settings, "integrator") + ", " + dial_value(settings, "rotation");
}

Scene motion_scene(const CaseBench& bench, const MotionChoice& choice)
{
    Scene scene = bench.scene();
    scene.gravity = Vec3::Zero();
    scene.settings.precision = Precision::double_;
    scene.settings.integrator = choice.integrator;
    scene.settings.rotation = choice.rotation;
    scene.settings.dt = choice.dt;
    scene.settings.substeps = choice.substeps;
    return scene;
}

BodyDescription& add_free_body(Scene& scene, double mass, const Vec3& moments, const Vec3& spin)
{
    BodyDescription body;
    body.mass = mass;
    body.inertia = Sym3{moments.x(), moments.y(), moments.z()};
    body.angular_velocity = spin;
    scene.bodies.push_back(body);
    return scene.bodies.back();
}

double angle_between(const Quat& a, const Quat& b)
{
    const Quat between = a.conjugate() * b;
    return 2 * std::atan2(between.vec().norm(), std::abs(between.w()));
}

double fitted_order(std::span<const double> steps,
                    std::span<const double> errors,
                    double least,
                    double greatest)
{
    double count = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (!(errors[i] > least && errors[i] < greatest)) continue;
        const double log_step = std::log(steps[i]), log_error = std::log(errors[i]);
        count += 1;
        x += log_step;
        y += log_error;
        xx += log_step * log_step;
        xy += log_step * log_error;
    }
    if (count < 2) return std::numeric_limits<double>::quiet_NaN();
    return (count * xy - x * y) / (count * xx - x * x);
}

}  // namespace throng
