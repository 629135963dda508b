// Level: a room of a game, as a program of a user's own drives it.
//
// A lift takes crates up to a ledge, and a sensor there tells which have arrived; crates are
// dropped and cleared away as the game goes on; each frame a guard looks along some rays for
// whatever hides him from the door; and who hits the ground hard is heard. Ends with 1 where
// anything is amiss.
#include <algorithm>
#include <cstdio>
#include <set>
#include <throng/throng.hpp>

using throng::BodyDescription;
using throng::BodyId;
using throng::Motion;
using throng::Vec3;

namespace {

constexpr double kFrame = 1.0 / 60, kHeight = 3, kRide = 4;  // s; m, of the ledge; s, up or down

// Names of shapes, by their places in the scene.
enum : std::uint32_t { kFloor, kCrate, kPlatform, kLedge, kGate };

BodyDescription body(std::uint32_t shape, const Vec3& position, Motion motion = Motion::static_)
{
    BodyDescription made;
    made.shape = shape;
    made.position = position;
    made.motion = motion;
    return made;
}

std::vector<throng::ShapeDescription> shapes()
{
    return {{"floor", throng::PlaneShape{}},
            {"crate", throng::BoxShape{Vec3(0.3, 0.3, 0.3)}},
            {"platform", throng::BoxShape{Vec3(1, 1, 0.1)}},
            {"ledge", throng::BoxShape{Vec3(2, 2, 0.1)}},
            {"gate", throng::BoxShape{Vec3(1, 1, 1)}}};
}

// Crates that fall from the ceiling, each with a number of the game's own.
throng::Scene crates(int first, int count)
{
    throng::Scene scene;
    scene.shapes = shapes();
    for (int i = 0; i < count; ++i) {
        scene.bodies.push_back(body(kCrate, Vec3(6 + i % 3, i / 3, 5), Motion::dynamic));
        scene.bodies.back().user_data = static_cast<std::uint64_t>(first + i);
    }
    return scene;
}

// Where the lift is at a time: it waits a second at either end.
double lift_height(double time)
{
    const double t = time / (kRide + 1),
                 ride = std::min(1.0, (t - std::floor(t)) * (kRide + 1) / kRide);
    const double up = static_cast<long>(t) % 2 == 0 ? ride : 1 - ride;
    return 0.1 + (kHeight - 0.1) * up;
}

}  // namespace

int main()
{
    throng::Scene room;
    room.shapes = shapes();
    room.bodies = {body(kFloor, Vec3(0, 0, 0)), body(kPlatform, Vec3(0, 0, 0.1), Motion::kinematic),
                   body(kLedge, Vec3(-3.05, 0, kHeight)), body(kGate, Vec3(0, 0, kHeight + 1.2)),
                   body(kCrate, Vec3(0, 0, 0.5), Motion::dynamic)};
    room.bodies[3].sensor = true;

    throng::World world(room, 0);
    const std::vector<BodyId> ids = world.bodies();
    const BodyId lift = ids[1], gate = ids[3], rider = ids[4];
    world.listen({.touches = false, .hit_speed = 5, .sensors = true});
    throng::Queries queries(world);

    int arrived = 0, left = 0, heard = 0, hidden = 0, dropped = 0, cleared = 0;
    double off = 0;  // m, that the lift was from where it was sent, at most
    std::vector<BodyId> fallen;
    for (int frame = 0; frame < 20 * 60; ++frame) {
        // Six more crates each second; those of three seconds ago are cleared away.
        if (frame % 60 == 0) {
            const std::vector<BodyId> more = world.add(crates(dropped, 6));
            fallen.insert(fallen.end(), more.begin(), more.end());
            dropped += 6;
            if (fallen.size() > 18) {
                world.remove(std::span(fallen).first(6));
                fallen.erase(fallen.begin(), fallen.begin() + 6);
                cleared += 6;
            }
        }
        throng::Pose to;
        to.position = Vec3(0, 0, lift_height((frame + 1) * kFrame));
        world.move_to(lift, to, kFrame);
        world.step();
        off = std::max(off, (world.pose(lift).position - to.position).norm());

        const throng::Events& events = world.events();
        arrived +=
            static_cast<int>(std::ranges::count(events.sensed, rider, &throng::TouchEvent::b));
        left += static_cast<int>(std::ranges::count(events.left, rider, &throng::TouchEvent::b));
        heard += static_cast<int>(events.hits.size());

        // What stands between the guard's eyes and the door.
        const Vec3 eyes(6.5, -4, 0.3);
        for (int k = -2; k <= 2; ++k)
            hidden += queries.blocked({eyes, Vec3(0.3 * k, 10, 0), 10}) ? 1 : 0;
    }
    // The youngest are still there, each with its number.
    const bool known = std::ranges::all_of(fallen, [&](BodyId id) {
        return world.user_data(id) >= static_cast<std::uint64_t>(cleared);
    });

    std::printf("the rider came up %d times and went down %d times\n", arrived, left);
    std::printf("%d crates dropped, %d cleared away, %d hits heard, %d looks hidden\n", dropped,
                cleared, heard, hidden);
    std::printf("the lift was never more than %.1e m from where it was sent\n", off);
    const bool up_and_down = arrived == 2 && left == 2 && world.sensed(gate).empty();
    return up_and_down && known && heard >= dropped - 6 && hidden > 0 && off < 1e-9 ? 0 : 1;
}
