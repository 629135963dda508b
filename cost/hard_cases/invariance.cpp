// Invariance: H26, the same scene told in another way moves in the same way.
//
// Needs no reference: bodies in another order, the world turned, mirrored, moved by a power of two
// or twice as large (and sqrt(2) times as slow), by any number of threads, once more.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace throng {

namespace {

// A way to tell a scene: places are turned, mirrored (x becomes -x, before all else), grown and
// moved.
struct Telling {
    const char* name = "";
    Quat turn = Quat::Identity();
    Vec3 off = Vec3::Zero();
    bool mirrored = false, backwards = false;
    double grown = 1;
    // Sweeps over contacts in their order, and frames of friction, leave what they have not solved.
    bool by_residual = false;

    Vec3 vector(const Vec3& v) const { return turn * (mirrored ? Vec3(-v.x(), v.y(), v.z()) : v); }
    Vec3 place(const Vec3& p) const { return off + grown * vector(p); }
    // Spins do not change sign along the mirror's normal, and do across it.
    Vec3 spin(const Vec3& w) const { return turn * (mirrored ? Vec3(w.x(), -w.y(), -w.z()) : w); }
    Quat rotation(const Quat& q) const
    {
        return turn * (mirrored ? Quat(q.w(), q.x(), -q.y(), -q.z()) : q);
    }
    double slower() const { return std::sqrt(grown); }
};

// What is told: boxes and balls of 1 kg above a floor.
struct Actor {
    bool ball = false;
    Pose pose;
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
};

constexpr double kEdge = 1;  // m, and twice a ball's radius

std::vector<Actor> stacked()
{
    std::vector<Actor> actors;
    for (int k = 0; k < 10; ++k) {
        Actor& actor = actors.emplace_back();
        actor.pose.position = Vec3(0, 0, kEdge * (k + 0.5));
    }
    return actors;
}

// A box that slides and turns, one that is dropped on its edge, a ball that slips and rolls.
std::vector<Actor> scattered()
{
    std::vector<Actor> actors(3);
    actors[0].pose.position = Vec3(0, 0, 0.5);
    actors[0].velocity = Vec3(2, 1, 0);
    actors[0].spin = Vec3(0, 0, 1);
    actors[1].pose = {Vec3(5, 1, 0.9), exponential(Vec3(0.3, 0.5, 0.2))};
    actors[1].spin = Vec3(0.4, 0, 0.3);
    actors[2].ball = true;
    actors[2].pose.position = Vec3(-4, 2, 0.5);
    actors[2].velocity = Vec3(1, -2, 0);
    actors[2].spin = Vec3(0, 0, 3);
    return actors;
}

Scene scene_told(const CaseBench& bench,
                 const std::vector<Actor>& actors,
                 const Telling& telling,
                 bool exactly)
{
    SceneParts parts(bench.scene());
    Scene& scene = parts.scene();
    if (exactly) ask_exactly(scene.settings);
    scene.settings.sleep = false;
    scene.settings.dt *= telling.slower();
    scene.gravity = telling.turn * Vec3(0, 0, -kGravity);
    const std::uint32_t material = parts.material(0.5);
    const Vec3 up = telling.turn * Vec3::UnitZ();
    parts.plane(material, up, up.dot(telling.off));
    const double half = telling.grown * kEdge / 2;
    for (std::size_t i = 0; i < actors.size(); ++i) {
        const Actor& actor = actors[telling.backwards ? actors.size() - 1 - i : i];
        const Pose pose{telling.place(actor.pose.position),
                        telling.rotation(actor.pose.orientation)};
        const std::uint32_t id = actor.ball ? parts.ball(material, 1, half, pose.position)
                                            : parts.box(material, 1, Vec3::Constant(half), pose);
        parts.body(id).orientation = pose.orientation;
        parts.body(id).velocity = telling.slower() * telling.vector(actor.velocity);
        parts.body(id).angular_velocity = telling.spin(actor.spin) / telling.slower();
    }
    return scene;
}

// Where all are after every step, as told plainly, and how they are turned.
struct Motions {
    std::vector<std::vector<Pose>> steps;
    std::string end;
};

Motions watch_told(CaseBench& bench, const Scene& scene, const Telling& telling, double time)
{
    Motions motions;
    bench.run(scene, time * telling.slower(), [&](World& world, double) {
        std::vector<BodyId> ids = world.bodies();
        ids.erase(ids.begin());
        if (telling.backwards) std::reverse(ids.begin(), ids.end());
        std::vector<Pose>& poses = motions.steps.emplace_back();
        for (const BodyId id : ids) poses.push_back(world.pose(id));
        motions.end = world.state_hash();
        return true;
    });
    return motions;
}

// m, of all corners that a box of that size would have.
double furthest_off(const Motions& plain, const Motions& told, const Telling& telling)
{
    double off = plain.steps.size() == told.steps.size() ? 0 : 1e30;
    for (std::size_t step = 0; step < std::min(plain.steps.size(), told.steps.size()); ++step)
        for (std::size_t i = 0; i < plain.steps[step].size(); ++i) {
            const Pose &a = plain.steps[step][i], &b = told.steps[step][i];
            for (const Vec3& corner :
                 {Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3(0, 0.5, 0), Vec3(0, 0, 0.5)}) {
                const Vec3 mirrored =
                    telling.mirrored ? Vec3(-corner.x(), corner.y(), corner.z()) : corner;
                const Vec3 wanted = telling.place(a.position + a.orientation * corner);
                const Vec3 there = b.position + b.orientation * Vec3(telling.grown * mirrored);
                off = std::max(off, (there - wanted).norm() / telling.grown);
            }
        }
    return off;
}

const Telling kTellings[] = {
    {.name = "turned by 90 deg about the vertical",
     .turn = Quat(std::sqrt(0.5), 0, 0, std::sqrt(0.5))},
    {.name = "turned by 90 deg, up along x", .turn = Quat(std::sqrt(0.5), 0, std::sqrt(0.5), 0)},
    {.name = "mirrored", .mirrored = true},
    {.name = "moved by (2^17, 0, -2^16) m", .off = Vec3(131072, 0, -65536)},
    {.name = "twice as large", .grown = 2},
    {.name = "in reversed order", .backwards = true, .by_residual = true},
    {.name = "turned anyhow", .turn = exponential(Vec3(0.3, -0.5, 0.7)), .by_residual = true},
};

constexpr double kToldTime = 1;  // s, as the catalogue has it
constexpr double kSame = 1e-9;   // m

// Told once more, and on any number of threads, not a bit is another.
void judge_threads(CaseBench& bench, const std::string& name, const Scene& scene)
{
    const Motions first = watch_told(bench, scene, {}, kToldTime);
    const int threads = bench.threads();
    for (const int count : {1, 2, 3}) {
        bench.use_threads(count);
        const Motions again = watch_told(bench, scene, {}, kToldTime);
        bench.report(name + ", once more, threads " + std::to_string(count),
                     "ends in another state, by its hash", again.end == first.end ? 0 : 1, 0, "1");
    }
    bench.use_threads(threads);
}

void judge_tellings(CaseBench& bench,
                    const std::vector<Actor>& actors,
                    std::string name,
                    bool exactly,
                    bool at_rest)
{
    const Telling plainly;
    name += exactly ? ", direct" : ", default";
    judge_threads(bench, name, scene_told(bench, actors, plainly, exactly));
    const Motions first =
        watch_told(bench, scene_told(bench, actors, plainly, exactly), plainly, kToldTime);
    for (const Telling& telling : kTellings) {
        const Motions told =
            watch_told(bench, scene_told(bench, actors, telling, exactly), telling, kToldTime);
        const double off = furthest_off(first, told, telling);
        const std::string setting = name + ", " + telling.name;
        const char* const quantity = "off where it is as told plainly, at worst";
        // Impacts of corners differ by rounding in when they come, and then by more.
        if (telling.by_residual && !(exactly && (at_rest || telling.backwards)))
            bench.show(setting, quantity, off, "m");
        else if (exactly)
            bench.report(setting, quantity, off, kSame, "m");
        else
            bench.report_default(setting, quantity, off, kSame, "m",
                                 "solver=direct precision=double substeps=1");
    }
}

}  // namespace

void case_invariance(CaseBench& bench)
{
    for (const bool exactly : {false, true}) {
        judge_tellings(bench, stacked(), "stack of 10", exactly, true);
        judge_tellings(bench, scattered(), "box, dropped box and ball", exactly, false);
    }
}

}  // namespace throng
