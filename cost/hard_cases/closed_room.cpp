// Closed room: H73. Spheres and boxes that lose nothing fly about a closed room for ten seconds:
// what they have at the end is what they had.
//
// Each strikes another a hundred times, fast enough to pass through a wall in a step, so that what
// a single impact makes or loses adds up.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kSpeed = 20, kRadius = 0.35, kMass = 100;  // m/s, m, kg

enum class Kind : std::uint8_t { spheres, boxes, both };

struct Room {
    const char* setting;
    Kind kind = Kind::both;
    double restitution = 1, friction = 0, gravity = 0;
    double dt = 1.0 / 60, time = 10;  // s
    Vec3 off = Vec3::Zero();          // m, where the room is
    Quat turn = Quat::Identity();
    bool backwards = false;  // in the order of their creation
    void (*choose)(Settings&) = [](Settings&) {};
};

// Six walls, solid outside.
void add_walls(SceneParts& parts, std::uint32_t material, double half, const Room& room)
{
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3 extents = Vec3::Constant(half + 4), at = Vec3::Zero();
            extents[axis] = 2;
            at[axis] = side * (half + 2);
            const std::uint32_t wall =
                parts.box(material, 1, extents, {room.off + room.turn * at, room.turn});
            parts.hold(wall);
        }
}

// A direction of its own for each place, in whatever order they come: turned about two axes by
// angles of which no two are alike.
Vec3 way_from(int place)
{
    const double golden = 2 * kPi * 0.6180339887498949;
    return exponential(Vec3(0, 0, golden * place))
        * (exponential(Vec3(0, 0.75 * golden * place * place, 0)) * Vec3::UnitX());
}

Scene make_room(const CaseBench& bench, const Room& room, int count)
{
    SceneParts parts(bench.scene());
    Settings& settings = parts.scene().settings;
    settings.dt = room.dt;
    settings.sleep = false;
    room.choose(settings);
    parts.scene().gravity = room.turn * Vec3(0, 0, -room.gravity);
    const std::uint32_t material = parts.material(room.friction, room.restitution);
    const int side = static_cast<int>(std::ceil(std::cbrt(count)));
    const double apart = 1.5, half = side * apart / 2;
    add_walls(parts, material, half, room);
    for (int i = 0; i < count; ++i) {
        const int place = room.backwards ? count - 1 - i : i;
        const Vec3 cell(place % side, place / side % side, place / (side * side));
        const Vec3 at = room.off
            + room.turn * Vec3((cell + Vec3::Constant(0.5)) * apart - Vec3::Constant(half));
        const bool ball = room.kind == Kind::spheres || (room.kind == Kind::both && place % 2 == 1);
        const std::uint32_t body = ball
            ? parts.ball(material, kMass, kRadius, at)
            : parts.box(material, kMass, Vec3::Constant(0.7 * kRadius), {at, room.turn});
        parts.body(body).velocity = room.turn * Vec3(way_from(place) * kSpeed);
    }
    return parts.scene();
}

void fly(CaseBench& bench, const Room& room, int count)
{
    const double start = count * kMass * kSpeed * kSpeed / 2;
    double reference = 0, least = start, most = start, now = 0;
    const Scene scene = make_room(bench, room, count);
    bench.inspect(scene, [&](const World& world) { reference = world.measure().potential_energy; });
    bench.run(scene, room.time, [&](World& world, double) {
        const Measures measures = world.measure();
        now = measures.kinetic_energy + measures.potential_energy - reference;
        least = std::min(least, now);
        most = std::max(most, now);
        return std::isfinite(now);
    });
    if (room.restitution == 1) {
        bench.report(room.setting, "energy off what it was, at worst",
                     std::max(most - start, start - least) / start, 0.02, "1");
        return;
    }
    bench.report(room.setting, "energy gained at any time", (most - start) / start, 1e-3, "1");
    bench.report(room.setting, "energy left", now / start, 0.5, "1");
}

}  // namespace

void case_closed_room(CaseBench& bench)
{
    const auto finely = [](Settings& settings) { settings.precision = Precision::double_; };
    const auto plainly = [](Settings& settings) { settings.solver = Solver::pgs; };
    const auto by_substeps = [](Settings& settings) { settings.substeps = 16; };
    const Vec3 far(1e5, -2e5, 3e5);
    const Quat tilt = exponential(Vec3(0.3, -0.5, 0.7));
    Room rooms[] = {
        {.setting = "spheres", .kind = Kind::spheres},
        {.setting = "boxes", .kind = Kind::boxes},
        {.setting = "spheres and boxes"},
        {.setting = "both, friction 0.5, e 0.9", .restitution = 0.9, .friction = 0.5},
        {.setting = "both, gravity", .gravity = kGravity},
        {.setting = "both, far off and turned", .off = far, .turn = tilt},
        {.setting = "both, made backwards", .backwards = true},
        {.setting = "both, dt=1/240", .dt = 1.0 / 240},
        {.setting = "both, dt=1e-3", .dt = 1e-3, .time = 2},
        {.setting = "both, 16 substeps", .choose = by_substeps},
        {.setting = "both, double", .choose = finely},
        {.setting = "both, pgs", .choose = plainly},
    };
    for (Room& room : rooms) {
        if (bench.brief()) room.time = 2;
        fly(bench, room, bench.brief() ? 27 : 500);
    }
}

}  // namespace throng
