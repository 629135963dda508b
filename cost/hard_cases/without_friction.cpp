// Motion without friction: H23, a block on a wedge and a rod that tips, both on a smooth floor.
//
// A block of mass m on a wedge of mass M and angle s drives it back with m g sin s cos s / (M + m
// sin^2 s), and goes down it with (M + m) g sin s / (M + m sin^2 s). A rod of length L that tips
// from upright turns at w with w^2 = 12 g (1 - cos t) / (L (1 + 3 sin^2 t)), t its angle from
// upright; nothing moves its center sideways.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kBound = 1e-3, kStep = 1e-3;
const std::string kDirect = ", direct, dt 1e-3";

void by_default(CaseBench& bench, const std::string& name, const char* quantity, double figure)
{
    bench.report_default(name + ", default", quantity, figure, kBound, "1",
                         "solver=direct, dt 1e-3");
}

// A prism of which +x is the high end.
HullShape wedge(double length, double angle)
{
    HullShape shape;
    for (const double y : {-1.0, 1.0}) {
        shape.points.emplace_back(0, y, 0);
        shape.points.emplace_back(length, y, 0);
        shape.points.emplace_back(length, y, length * std::tan(angle));
    }
    return shape;
}

Scene block_on_wedge(const CaseBench& bench)
{
    const double angle = kPi / 6, length = 4, half = 0.1;
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0);
    parts.plane(material, Vec3::UnitZ(), 0);
    parts.hull(material, 3, wedge(length, angle), {Vec3::Zero(), Quat::Identity()});
    const Quat turn = exponential(Vec3(0, -angle, 0));
    const Vec3 foot(0.6 * length, 0, 0.6 * length * std::tan(angle));
    parts.box(material, 1, Vec3::Constant(half), {foot + turn * Vec3(0, 0, half), turn});
    return parts.scene();
}

// Errors of the two accelerations, as shares.
std::pair<double, double> slide_down(CaseBench& bench, const Scene& scene)
{
    const double time = 0.5, wedge_wanted = 1.30703219, block_wanted = 6.03692308;
    std::pair<double, double> error;
    bench.run(scene, time, [&](World& world, double now) {
        const std::vector<BodyId> ids = world.bodies();
        const Vec3 wedge = world.velocity(ids[1]), block = world.velocity(ids[2]);
        error = {std::abs(wedge.x() / (now * wedge_wanted) - 1),
                 std::abs((block - wedge).norm() / (now * block_wanted) - 1)};
        return true;
    });
    return error;
}

// As it tips, not only where it comes down.
double spin_at(double angle, double length)
{
    const double sine = std::sin(angle);
    return std::sqrt(12 * kGravity * (1 - std::cos(angle)) / (length * (1 + 3 * sine * sine)));
}

// A rod with pointed ends, of which only the ends touch until it is all but flat.
Scene tipping_rod(const CaseBench& bench, double angle)
{
    const double length = 2, thin = 0.02;
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(0);
    parts.plane(material, Vec3::UnitZ(), 0);
    HullShape shape;
    for (const double side : {-1.0, 1.0}) {
        shape.points.emplace_back(0, 0, side * length / 2);
        shape.points.emplace_back(side * thin, 0, 0);
        shape.points.emplace_back(0, side * thin, 0);
    }
    const double high = length / 2 * std::cos(angle), spin = spin_at(angle, length);
    const std::uint32_t rod = parts.hull(material, 1, std::move(shape),
                                         {Vec3(0, 0, high), exponential(Vec3(0, angle, 0))});
    const double inertia = length * length / 12;
    parts.body(rod).inertia = Sym3{inertia, inertia, 1e-3 * inertia, 0, 0, 0};
    parts.body(rod).angular_velocity = Vec3(0, spin, 0);
    parts.body(rod).velocity = Vec3(0, 0, -length / 2 * std::sin(angle) * spin);
    return parts.scene();
}

struct Tipped {
    double angle = 0;     // rad, the last one looked at
    double spin = 0;      // worst error, as a share of what it is when flat
    double sideways = 0;  // m
};

Tipped tip(CaseBench& bench, const Scene& scene)
{
    const double length = 2, flat = spin_at(kPi / 2, length);
    Tipped tipped;
    bench.run(scene, 2, [&](World& world, double) {
        const BodyId rod = world.bodies().back();
        const Vec3 axis = world.pose(rod).orientation * Vec3::UnitZ();
        const double angle = std::atan2(axis.x(), axis.z());
        if (angle > kPi / 2 - 0.025) return false;
        tipped.angle = angle;
        const double error = world.angular_velocity(rod).y() - spin_at(angle, length);
        tipped.spin = std::max(tipped.spin, std::abs(error) / flat);
        tipped.sideways = std::max(tipped.sideways, std::abs(world.center_of_mass(rod).x()));
        return true;
    });
    return tipped;
}

void on_the_wedge(CaseBench& bench)
{
    Scene scene = block_on_wedge(bench);
    const char *const name = "block of 1 kg on a wedge of 3 kg",
                      *const wedge = "error of the wedge's acceleration",
                      *const block = "error of the block's against it";
    const auto soft = slide_down(bench, scene);
    by_default(bench, name, wedge, soft.first);
    by_default(bench, name, block, soft.second);
    ask_exactly(scene.settings);
    scene.settings.dt = kStep;
    const auto exact = slide_down(bench, scene);
    bench.report(name + kDirect, wedge, exact.first, kBound, "1");
    bench.report(name + kDirect, block, exact.second, kBound, "1");
}

void rod_that_tips(CaseBench& bench)
{
    Scene scene = tipping_rod(bench, 0.1);
    const char *const name = "rod of 2 m that tips", *const spin = "error of the spin",
                      *const sideways = "way of its center sideways";
    const Tipped soft = tip(bench, scene);
    by_default(bench, name, spin, soft.spin);
    by_default(bench, name, sideways, soft.sideways);
    ask_exactly(scene.settings);
    scene.settings.dt = kStep;
    const Tipped exact = tip(bench, scene);
    bench.report(name + kDirect, spin, exact.spin, kBound, "1");
    bench.report(name + kDirect, sideways, exact.sideways, kBound, "m");
    bench.report(name + kDirect, "angle it was not watched to", std::max(0.0, 1.5 - exact.angle), 0,
                 "rad");
}

}  // namespace

void motion_without_friction(CaseBench& bench)
{
    on_the_wedge(bench);
    rod_that_tips(bench);
}

}  // namespace throng
