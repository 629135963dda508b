// Squeezed: H106, who is caught between what moves by itself and what stands still is not thrown.
//
// Answer: there may be no way out, and then no force is right; contacts push apart no faster than
// the dial push_limit says. Two that all but face one another push what is between them out faster
// than each by one over the sine of the angle that is left of their normals: ten times at six
// degrees each.
//
// A paddle sweeps over a floor that balls of two sizes and 1:10 in mass lie on, so low that it
// catches them under its edge, or below their middles.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace throng {

namespace {

constexpr double kPaddle = 0.2;                  // m/s
constexpr double kGreat = 0.01, kSmall = 0.008;  // m, radii

Scene swept(const CaseBench& bench, double friction, double height, int seed)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(friction);
    parts.hold(parts.box(material, 1, Vec3(2, 2, 0.01), {Vec3(0, 0, -0.01), Quat::Identity()}));
    Random random(static_cast<std::uint64_t>(seed));
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 5; ++k) {
            const double radius = (i + k) % 2 == 0 ? kGreat : kSmall;
            const Vec3 off = random_vector(random, -1, 1);
            parts.ball(
                material, 1e-3 * std::pow(10, (1 + off.z()) / 2), radius,
                Vec3(-0.0205 * i + 1e-3 * off.x(), 0.0205 * (k - 2) + 5e-4 * off.y(), radius));
        }
    const Vec3 half(0.02, 0.1, 0.0066);
    const auto paddle =
        parts.box(material, 1, half, {Vec3(0.05, 0, height + half.z()), Quat::Identity()});
    parts.body(paddle).motion = Motion::kinematic;
    parts.body(paddle).velocity = Vec3(-kPaddle, 0, 0);
    return parts.scene();
}

}  // namespace

void case_squeezed(CaseBench& bench)
{
    struct How {
        const char* setting;
        double dt = 1.0 / 60;
        Precision precision = Precision::float_;
    };
    for (const How& how : {How{"default"}, How{"default, dt 1/240", 1.0 / 240},
                           How{"default, double", 1.0 / 60, Precision::double_}})
        for (const double friction : {0.3, 0.6, 0.95}) {
            double fastest = 0;
            for (const double height : {0.0095, 0.012, 0.0133, 0.016})
                for (int seed = 1; seed <= (bench.brief() ? 1 : 6); ++seed) {
                    Scene scene = swept(bench, friction, height, seed);
                    scene.settings.dt = how.dt;
                    scene.settings.precision = how.precision;
                    bench.run(scene, 3, [&](World& world, double) {
                        for (const BodyId body : world.bodies())
                            fastest = std::max(fastest, world.velocity(body).norm());
                        return true;
                    });
                }
            bench.report(std::string(how.setting) + ", friction "
                             + std::to_string(friction).substr(0, 4),
                         "fastest ball", fastest, 10 * bench.settings().push_limit, "m/s");
        }
}

}  // namespace throng
