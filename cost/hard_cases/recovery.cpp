// Recovery: H47, bodies that are made inside one another.
//
// Without gravity and at rest they part no faster than push_limit, so that their energy never comes
// to that of all of them at that speed; they push one another, so momentum stays 0; and they come
// to rest, apart.
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

struct Heap {
    std::string name;
    Scene scene;
    double size = 1;  // m
};

SceneParts in_space(const CaseBench& bench, Response response)
{
    SceneParts parts(bench.scene());
    parts.scene().gravity = Vec3::Zero();
    parts.scene().settings.sleep = false;
    parts.scene().settings.response = response;
    return parts;
}

// Four boxes in the lowest row, each a quarter inside its neighbors.
Heap pyramid(SceneParts parts)
{
    const std::uint32_t material = parts.material(0.6);
    constexpr int kBase = 4;
    const double apart = 0.75;
    for (int row = 0; row < kBase; ++row)
        for (int i = 0; i < kBase - row; ++i)
            parts.box(material, 1, Vec3::Constant(0.5),
                      {Vec3(apart * (i + 0.5 * row), 0, apart * row), Quat::Identity()});
    return {"pyramid of base 4, overlaps of a quarter", parts.scene(), 1};
}

Heap two_balls(SceneParts parts, const Vec3& at, const char* name)
{
    const std::uint32_t material = parts.material(0.6);
    for (int i = 0; i < 2; ++i) parts.ball(material, 1, 1, at);
    return {name, parts.scene(), 2};
}

Heap boxes_at_one_point(SceneParts parts, bool few)
{
    const std::uint32_t material = parts.material(0.6);
    const int count = few ? 50 : 1000;
    for (int i = 0; i < count; ++i)
        parts.box(material, 1, Vec3::Constant(0.5), {Vec3::Zero(), Quat::Identity()});
    return {std::to_string(count) + " boxes at one point", parts.scene(), 1};
}

struct Parted {
    double apart = 0;  // m/s, the fastest that the greatest overlap grew less
    double energy = 0, momentum = 0, speed = 0, overlap = 0;
};

// The overlaps of a thousand boxes are not looked at after every step.
Parted part(CaseBench& bench, const Heap& heap)
{
    const double limit = heap.scene.settings.push_limit, dt = heap.scene.settings.dt;
    const int every = heap.scene.bodies.size() > 100 ? 20 : 1;
    Parted parted;
    bench.inspect(heap.scene,
                  [&](const World& world) { parted.overlap = world.measure().greatest_overlap; });
    int step = 0;
    bench.run(heap.scene, 10, [&](World& world, double) {
        double energy = 0, moves = 0, mass = 0;
        Vec3 momentum = Vec3::Zero();
        parted.speed = 0;
        for (const BodyId body : world.bodies()) {
            const Vec3 velocity = world.velocity(body);
            const double fast = velocity.norm();
            parted.speed = std::max(parted.speed, fast);
            mass += world.mass(body);
            moves += world.mass(body) * fast;
            energy += 0.5 * world.mass(body) * fast * fast;
            momentum += world.mass(body) * velocity;
        }
        parted.energy = std::max(parted.energy, energy / (0.5 * mass * limit * limit));
        parted.momentum =
            std::max(parted.momentum, momentum.norm() / std::max(moves, mass * limit));
        if (++step % every != 0) return true;
        const double overlap = world.measure().greatest_overlap;
        parted.apart = std::max(parted.apart, (parted.overlap - overlap) / (every * dt));
        parted.overlap = overlap;
        return true;
    });
    return parted;
}

void recover(CaseBench& bench, const Heap& heap, const std::string& how)
{
    const Parted parted = part(bench, heap);
    const std::string name = heap.name + how;
    // Places are kept to 1e-9 m at 1e7 m from the origin.
    bench.report(name, "fastest that overlap shrank, of the push limit",
                 parted.apart / heap.scene.settings.push_limit, 1 + 1e-6, "1");
    bench.report(name, "greatest energy, of all at that speed", parted.energy, 1, "1");
    bench.report(name, "greatest momentum, of all at that speed", parted.momentum, 1e-6, "1");
    bench.report(name, "speed after 10 s", parted.speed, 1e-3, "m/s");
    bench.report(name, "overlap after 10 s over the size", parted.overlap / heap.size, 1e-3, "1");
}

// Springs give back what overlap stored in them.
void compare(CaseBench& bench, const Heap& heap)
{
    const Parted parted = part(bench, heap);
    bench.skip(heap.name + ", penalty", "greatest energy, of all at that speed",
               "penalty forces know no push limit: " + std::to_string(parted.energy));
}

}  // namespace

void case_recovery(CaseBench& bench)
{
    const auto ask_all = [&](const SceneParts& space, const std::string& how) {
        recover(bench, pyramid(space), how);
        recover(bench, two_balls(space, Vec3::Zero(), "two balls at one point"), how);
        // Where places kept in float would be a metre apart.
        recover(bench, two_balls(space, Vec3::Constant(1e7), "two balls at one point far away"),
                how);
    };
    const SceneParts space = in_space(bench, Response::impulse);
    ask_all(space, "");
    recover(bench, boxes_at_one_point(space, bench.brief()), "");
    SceneParts exact = space;
    ask_exactly(exact.scene().settings);
    ask_all(exact, ", direct");
    const SceneParts pushed = in_space(bench, Response::kinematic);
    ask_all(pushed, ", kinematic");
    recover(bench, boxes_at_one_point(pushed, bench.brief()), ", kinematic");
    const SceneParts sprung = in_space(bench, Response::penalty);
    compare(bench, pyramid(sprung));
    compare(bench, two_balls(sprung, Vec3::Zero(), "two balls at one point"));
}

}  // namespace throng
