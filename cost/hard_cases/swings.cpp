// Swings: H98, what swings on a contact goes on as it began.
//
// Answer: nothing turns its energy into anything else while it rolls to and fro: energy of motion
// and height together stay what they were. Where it is stopped by an edge it loses some.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kRadius = 0.3, kBelow = 0.1;  // m, of what is round; its center below the middle

enum class Swinger : std::uint8_t { ball, capsule, cylinder, ring, frame, board };
constexpr Swinger kSwingers[] = {Swinger::ball, Swinger::capsule, Swinger::cylinder,
                                 Swinger::ring, Swinger::frame,   Swinger::board};

const char* name_of(Swinger swinger)
{
    constexpr const char* kNames[] = {"weighted ball", "weighted capsule", "weighted cylinder",
                                      "ring on a peg", "frame on a peg",   "board on a cylinder"};
    return kNames[static_cast<int>(swinger)];
}

struct Setting {
    const char* name;
    Pose frame = {};
    bool backwards = false;  // what it swings on is made last
    void (*choose)(Settings&) = [](Settings&) {};
};

Quat about_x(double angle) { return exponential(Vec3(angle, 0, 0)); }
Quat about_y(double angle) { return exponential(Vec3(0, angle, 0)); }

// Sixteen rods in a circle about y.
CompoundShape ring(std::uint32_t rod, double radius)
{
    CompoundShape shape;
    for (int i = 0; i < 16; ++i) {
        const double angle = kPi * i / 8;
        shape.parts.push_back(
            {rod, {radius * Vec3(std::sin(angle), 0, std::cos(angle)), about_y(angle + kPi / 2)}});
    }
    return shape;
}

// Four bars in a square about y.
CompoundShape square(std::uint32_t level, std::uint32_t upright, double half)
{
    CompoundShape shape;
    for (const double sign : {1.0, -1.0}) {
        shape.parts.push_back({level, {Vec3(0, 0, sign * half), Quat::Identity()}});
        shape.parts.push_back({upright, {Vec3(sign * half, 0, 0), Quat::Identity()}});
    }
    return shape;
}

class Stage {
public:
    Stage(const CaseBench& bench, const Setting& setting)
        : setting_(setting), parts_(bench.scene()), material_(parts_.material(0.8))
    {
        parts_.scene().settings.sleep = false;
        setting.choose(parts_.scene().settings);
        parts_.scene().gravity = setting.frame.orientation * Vec3(0, 0, -kGravity);
    }

    Scene scene_of(Swinger swinger)
    {
        if (!setting_.backwards) put_below(swinger);
        put(swinger);
        if (setting_.backwards) put_below(swinger);
        return parts_.scene();
    }

private:
    std::uint32_t shape(decltype(ShapeDescription::shape) kind)
    {
        Scene& scene = parts_.scene();
        return add_shape(scene, "shape" + std::to_string(scene.shapes.size()), std::move(kind));
    }

    BodyDescription& body(decltype(ShapeDescription::shape) kind, const Pose& at)
    {
        const Pose placed = setting_.frame * at;
        BodyDescription body;
        body.shape = shape(std::move(kind));
        body.material = material_;
        body.position = placed.position;
        body.orientation = placed.orientation;
        parts_.scene().bodies.push_back(body);
        return parts_.scene().bodies.back();
    }

    // A floor, or what it hangs or lies on, whose top is at the origin.
    void put_below(Swinger swinger)
    {
        if (swinger < Swinger::ring) {
            const Vec3 up = setting_.frame.orientation * Vec3::UnitZ();
            parts_.plane(material_, up, up.dot(setting_.frame.position));
            return;
        }
        const double radius = swinger == Swinger::board ? 0.2
            : swinger == Swinger::ring                  ? 0.05
                                                        : 0.03;
        body(CylinderShape{radius, kRadius}, {Vec3(0, 0, -radius), about_x(kPi / 2)}).motion =
            Motion::static_;
    }

    void put(Swinger swinger)
    {
        const double leans = 0.5, rod = 0.03;
        const Quat lies = about_y(leans) * about_x(kPi / 2);
        const auto moves = [&](BodyDescription& body, double speed, double arm) {
            body.velocity = setting_.frame.orientation * Vec3(speed, 0, 0);
            body.angular_velocity =
                setting_.frame.orientation * Vec3(0, arm > 0 ? -speed / arm : 0.3, 0);
        };
        switch (swinger) {
        case Swinger::ball:
            body(SphereShape{kRadius}, {Vec3(0, 0, kRadius), about_y(leans)}).center =
                Vec3(0, 0, -kBelow);
            return;
        case Swinger::capsule:
            body(CapsuleShape{kRadius, 0.5}, {Vec3(0, 0, kRadius), lies}).center =
                Vec3(0, -kBelow, 0);
            return;
        case Swinger::cylinder:
            body(CylinderShape{kRadius, 0.1}, {Vec3(0, 0, kRadius), lies}).center =
                Vec3(0, -kBelow, 0);
            return;
        case Swinger::ring: {
            const std::uint32_t part = shape(CapsuleShape{rod, kPi * kRadius / 16});
            return moves(body(ring(part, kRadius), {Vec3(0, 0, rod - kRadius), Quat::Identity()}),
                         1, kRadius - rod);
        }
        case Swinger::frame: {
            const std::uint32_t level = shape(BoxShape{Vec3(0.3, rod, rod)}),
                                upright = shape(BoxShape{Vec3(rod, rod, 0.27)});
            return moves(
                body(square(level, upright, 0.27), {Vec3(0, 0, rod - 0.27), Quat::Identity()}), 0.8,
                0.27);
        }
        case Swinger::board:
            return moves(body(BoxShape{Vec3(1, 0.1, rod)}, {Vec3(0, 0, rod), Quat::Identity()}), 0,
                         0);
        }
    }

    const Setting& setting_;
    SceneParts parts_;
    std::uint32_t material_;
};

void swing(CaseBench& bench, const Setting& setting, Swinger swinger)
{
    EnergyLedger ledger;
    bench.run(
        Stage(bench, setting).scene_of(swinger), bench.brief() ? 3 : 20,
        [](World&, double) { return true; }, &ledger);
    const std::string which = std::string(name_of(swinger)) + ", " + setting.name;
    const double most = ledger.greatest_kinetic(), net = ledger.net();
    bench.report(which, "energy won over the greatest of motion", std::max(0.0, net) / most, 0.01,
                 "1");
    // A ring of rods and a frame strike their peg with an edge now and then.
    const bool has_edges = swinger == Swinger::ring || swinger == Swinger::frame;
    bench.report(which, "energy lost over the greatest of motion", std::max(0.0, -net) / most,
                 has_edges ? 0.3 : 0.15, "1");
}

}  // namespace

void case_swings(CaseBench& bench)
{
    const Quat turned = exponential(Vec3(0.3, -0.5, 0.7));
    const Setting all[] = {
        {.name = "default"},
        {.name = "dt 1/30", .choose = [](Settings& s) { s.dt = 1.0 / 30; }},
        {.name = "dt 1/240", .choose = [](Settings& s) { s.dt = 1.0 / 240; }},
        {.name = "dt 1e-3", .choose = [](Settings& s) { s.dt = 1e-3; }},
        {.name = "16 substeps", .choose = [](Settings& s) { s.substeps = 16; }},
        {.name = "double", .choose = [](Settings& s) { s.precision = Precision::double_; }},
        {.name = "friction at points",
         .choose = [](Settings& s) { s.friction_at = FrictionAt::points; }},
        {.name = "pgs", .choose = [](Settings& s) { s.solver = Solver::pgs; }},
        {.name = "direct", .choose = [](Settings& s) { s.solver = Solver::direct; }},
        {.name = "turned", .frame = {Vec3::Zero(), turned}},
        {.name = "far off", .frame = {Vec3(3e4, -1e4, 2e4), turned}},
        {.name = "made last", .backwards = true},
    };
    for (const Setting& setting : all) {
        for (const Swinger swinger : kSwingers) swing(bench, setting, swinger);
        if (bench.brief()) return;
    }
}

}  // namespace throng
