// Thrown rods: H111, thin bodies that are thrown on a floor and bounce make no energy, by any
// solver.
//
// Answer: a floor takes energy of motion, or keeps it.
//
// A rod struck at its end is set spinning about itself by friction, at hundreds of radians a
// second, and how it turns after the hit is another matter than how it turned before.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/random.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

namespace throng {

namespace {

constexpr double kBound = 1e-3;  // of the greatest energy of motion

constexpr char kMetBy[] = "dt=1/240 by solver=soft_step or direct";

struct How {
    const char* setting;
    double dt = 1.0 / 60;
    void (*set)(Settings&) = [](Settings&) {};
    Quat turn = Quat::Identity();
    const char* met_by = "";
};

struct Thrown {
    const char* name;
    decltype(ShapeDescription::shape) shape;
};

double made(CaseBench& bench, const How& how, const Thrown& thrown, std::uint64_t seed)
{
    Random random(seed);
    constexpr double kFrictions[] = {0, 0.2, 0.7, 1.1}, kRestitutions[] = {1, 1, 0.5, 0.8},
                     kHeights[] = {1, 3, 9};
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    scene.settings.dt = how.dt;
    how.set(scene.settings);
    scene.gravity = how.turn * Vec3(0, 0, -kGravity);
    const std::uint32_t material =
        parts.material(kFrictions[random.below(4)], kRestitutions[random.below(4)]);
    parts.plane(material, how.turn * Vec3::UnitZ(), 0);
    BodyDescription body;
    body.material = material;
    body.mass = 1;
    body.position = how.turn * Vec3(0, 0, kHeights[random.below(3)]);
    body.orientation = how.turn * random_turn(random, kPi);
    const Vec3 velocity = random_vector(random, -5, 5);
    body.velocity = how.turn * Vec3(velocity.x(), velocity.y(), 0);
    body.angular_velocity = how.turn * random_vector(random, -5, 5);
    parts.add(thrown.shape, body);
    EnergyLedger ledger;
    bench.run(
        scene, 5, [](World&, double) { return true; }, &ledger);
    bench.forgive_residual();
    return ledger.gained() / ledger.greatest_kinetic();
}

}  // namespace

void case_thrown_rods(CaseBench& bench)
{
    const Thrown all[] = {
        {"rods", BoxShape{Vec3(0.2, 0.006, 0.006)}}, {"needles", CapsuleShape{0.006, 0.2}},
        {"plates", BoxShape{Vec3(0.2, 0.2, 0.004)}}, {"tubes", CylinderShape{0.01, 0.3}},
        {"discs", CylinderShape{0.2, 0.005}},        {"bars", BoxShape{Vec3(0.3, 0.05, 0.02)}},
    };
    const auto direct = [](Settings& s) { s.solver = Solver::direct; };
    const auto pgs = [](Settings& s) { s.solver = Solver::pgs; };
    const Quat turned = Quat(0.8, 0.2, -0.4, 0.4).normalized();
    const How hows[] = {
        {.setting = "direct, dt 1/1000", .dt = 1e-3, .set = direct},
        {.setting = "direct, dt 1/240", .dt = 1.0 / 240, .set = direct},
        {.setting = "direct", .set = direct, .met_by = kMetBy},
        {.setting = "direct, double", .set = ask_exactly, .met_by = kMetBy},
        {.setting = "default", .met_by = kMetBy},
        {.setting = "default, turned", .turn = turned, .met_by = kMetBy},
        {.setting = "default, dt 1/240", .dt = 1.0 / 240},
        {.setting = "default, dt 1/1000", .dt = 1e-3},
        {.setting = "16 substeps", .set = [](Settings& s) { s.substeps = 16; }, .met_by = kMetBy},
        {.setting = "pgs", .set = pgs, .met_by = kMetBy},
        {.setting = "pgs, dt 1/1000", .dt = 1e-3, .set = pgs, .met_by = kMetBy},
        {.setting = "rk4",
         .set = [](Settings& s) { s.integrator = Integrator::rk4; },
         .met_by = kMetBy},
        {.setting = "penalty, dt 1/1000",
         .dt = 1e-3,
         .set = [](Settings& s) { s.response = Response::penalty; },
         .met_by = kMetBy},
    };
    for (const How& how : hows) {
        for (const Thrown& thrown : all) {
            double most = 0;
            for (std::uint64_t seed = 1; seed <= (bench.brief() ? 4 : 40); ++seed)
                most = std::max(most, made(bench, how, thrown, seed));
            const std::string quantity =
                std::string("energy that ") + thrown.name + " make, over the greatest of motion";
            bench.report_default(how.setting, quantity, most, kBound, "1", how.met_by);
        }
        if (bench.brief()) return;
    }
}

}  // namespace throng
