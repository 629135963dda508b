// Thin falls: H74, thin bodies that tip over from standing, in steps in which they go many times
// their thickness.
//
// Answer: nothing puts energy in. Of what it falls by, motion and height never win back more than
// a hundredth from one time to any later one.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kSize = 2;        // m
constexpr double kLean = 0.05;     // rad, as it is let go
constexpr double kMostWon = 0.01;  // of its fall

enum class Thin : std::uint8_t { rod, bar, beam, card, coin };
constexpr Thin kThins[] = {Thin::rod, Thin::bar, Thin::beam, Thin::card, Thin::coin};
constexpr const char* kThinNames[] = {"rod", "cylinder", "beam", "card", "coin"};
enum class Ground : std::uint8_t { plane, box, mesh };
constexpr const char* kGroundNames[] = {"plane", "box", "mesh"};

struct Tipping {
    Thin thin = Thin::rod;
    Ground ground = Ground::plane;
    double half = 1e-3;  // of the size: half its thickness
    double friction = 0;
    double size = kSize;  // m
    double turned = 0;    // rad, about the upright
    bool far = false, last = false;

    Vec3 at() const { return far ? Vec3(3e6, -1e6, 2e6) : Vec3(Vec3::Zero()); }
};

void put_ground(SceneParts& parts, std::uint32_t material, const Tipping& tipping)
{
    if (tipping.ground == Ground::plane) {
        parts.plane(material, Vec3::UnitZ(), tipping.at().z());
        return;
    }
    const double wide = 3 * tipping.size;
    const Pose pose = {tipping.at() - wide * Vec3::UnitZ(), Quat::Identity()};
    const std::uint32_t id = parts.box(material, 1, Vec3::Constant(wide), pose);
    parts.hold(id);
    if (tipping.ground == Ground::box) return;
    MeshShape mesh;
    mesh.vertices = {
        {-wide, -wide, wide}, {wide, -wide, wide}, {wide, wide, wide}, {-wide, wide, wide}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    parts.scene().shapes[parts.body(id).shape].shape = mesh;
}

// Its longest extent along z, its thickness along x.
decltype(ShapeDescription::shape) shape_of(const Tipping& tipping)
{
    const double half = tipping.size / 2, thin = tipping.half * tipping.size;
    switch (tipping.thin) {
    case Thin::rod:
        return CapsuleShape{thin, half};
    case Thin::bar:
        return CylinderShape{thin, half};
    case Thin::beam:
        return BoxShape{Vec3(thin, thin, half)};
    case Thin::card:
        return BoxShape{Vec3(thin, half / 2, half)};
    case Thin::coin:
        break;
    }
    return CylinderShape{half, thin};
}

void put_thin(SceneParts& parts, std::uint32_t material, const Tipping& tipping)
{
    const double half = tipping.size / 2, thin = tipping.half * tipping.size;
    Quat upright = exponential(Vec3(0, kLean, 0));
    double high = half * std::cos(kLean) + (tipping.thin == Thin::rod ? thin : 0);
    if (tipping.thin != Thin::rod) high += thin * std::sin(kLean);
    if (tipping.thin == Thin::coin) upright = upright * exponential(Vec3(0, kPi / 2, 0));
    const Pose pose = {tipping.at() + high * Vec3::UnitZ(),
                       exponential(Vec3(0, 0, tipping.turned)) * upright};
    const std::uint32_t id = parts.box(material, 1, Vec3::Ones(), pose);
    parts.scene().shapes[parts.body(id).shape].shape = shape_of(tipping);
}

// What it wins back at most, over its fall.
double won(CaseBench& bench, const Tipping& tipping, const Settings& settings)
{
    SceneParts parts(bench.scene());
    parts.scene().settings = settings;
    parts.scene().settings.sleep = false;
    const std::uint32_t material = parts.material(tipping.friction);
    if (!tipping.last) put_ground(parts, material, tipping);
    put_thin(parts, material, tipping);
    if (tipping.last) put_ground(parts, material, tipping);
    const double fall = kGravity * tipping.size / 2;
    double least = std::numeric_limits<double>::infinity(), most = 0;
    const double time = 2 * std::sqrt(tipping.size / kSize);
    bench.run(parts.scene(), time, [&](World& world, double) {
        const Measures measures = world.measure();
        const double energy = measures.kinetic_energy + measures.potential_energy;
        least = std::min(least, energy);
        most = std::max(most, energy - least);
        return std::isfinite(energy);
    });
    return most / fall;
}

void judge(CaseBench& bench,
           const Tipping& tipping,
           const std::string& how,
           const Settings& settings)
{
    const std::string friction = std::to_string(tipping.friction).substr(0, 3);
    bench.report(std::string(kThinNames[static_cast<int>(tipping.thin)])
                     + " 1:" + std::to_string(std::lround(1 / tipping.half)) + " on a "
                     + kGroundNames[static_cast<int>(tipping.ground)] + ", mu " + friction + how,
                 "energy won over its fall", won(bench, tipping, settings), kMostWon, "1");
}

void tip_all(CaseBench& bench, const std::string& how, const Settings& settings)
{
    for (const Thin thin : kThins)
        for (const double friction : {0.0, 0.5})
            for (const double half : {1e-2, 1e-3, 1e-4}) {
                if (bench.brief() && half != 1e-3) continue;
                judge(bench, {.thin = thin, .half = half, .friction = friction}, how, settings);
            }
}

}  // namespace

void case_thin_falls(CaseBench& bench)
{
    const Settings usual = bench.settings();
    tip_all(bench, "", usual);
    for (const Ground ground : {Ground::box, Ground::mesh})
        for (const double friction : {0.0, 0.5})
            for (const Thin thin : {Thin::rod, Thin::card})
                judge(bench, {.thin = thin, .ground = ground, .friction = friction}, "", usual);
    judge(bench, {.turned = 1}, ", turned", usual);
    judge(bench, {.far = true}, ", far off", usual);
    judge(bench, {.last = true}, ", made last", usual);
    judge(bench, {.size = 5e-3}, ", of 5 mm", usual);
    judge(bench, {.size = 50}, ", of 50 m", usual);
    if (bench.brief()) return;
    for (const double rate : {240.0, 1000.0}) {
        Settings settings = usual;
        settings.dt = 1 / rate;
        tip_all(bench, ", dt 1/" + std::to_string(std::lround(rate)), settings);
    }
    Settings exact = usual;
    ask_exactly(exact);
    tip_all(bench, ", direct", exact);
}

}  // namespace throng
