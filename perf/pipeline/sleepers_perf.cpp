// Sleepers: what a step, an edit and a question take in a world of which nearly all sleeps.
//
// What is called for is to cost, and nothing else: the times of a world of 100,000 are to be those
// of one of 1,000.
#include "perf/support.hpp"
#include "throng/throng.hpp"

#include <array>
#include <cmath>
#include <string>

namespace throng::perf {
namespace {

using benchmark::State;

// Boxes that stand apart on a floor, and a ball beside them. Of every so many bodies one is a ball
// high above, which goes on falling; 0: none.
class Sleepers {
public:
    explicit Sleepers(std::size_t count, std::size_t one_falls_in = 0)
        : world_(scene(count, one_falls_in), 1), ids_(world_.bodies())
    {
        const std::size_t falling = one_falls_in == 0 ? 0 : (count - 1) / one_falls_in + 1;
        while (world_.report().step < 2 || world_.report().bodies_awake > falling) world_.step();
        roll();
        world_.step();  // in which the pairs of those that fell asleep last are put away
    }

    World& world() { return world_; }
    BodyId ball() const { return ids_.back(); }
    BodyId box() const { return ids_[ids_.size() / 2]; }
    void roll() { world_.set_velocity(ball(), Vec3(-1, 0, 0), Vec3(0, -4, 0)); }

    static Scene ball_at(const Vec3& position)
    {
        Scene scene;
        scene.materials.push_back({});
        scene.shapes.push_back({"ball", SphereShape{0.25}});
        BodyDescription body;
        body.shape = body.material = 0;
        body.position = position;
        scene.bodies.push_back(body);
        return scene;
    }

private:
    static Scene scene(std::size_t count, std::size_t one_falls_in)
    {
        Scene scene = ball_at(Vec3(-5, -5, 0.25));
        scene.shapes.push_back({"box", BoxShape{Vec3(0.25, 0.25, 0.25)}});
        scene.shapes.push_back({"floor", PlaneShape{}});
        const BodyDescription ball = scene.bodies.front();
        BodyDescription body = ball;
        body.shape = 2;
        body.motion = Motion::static_;
        body.position = Vec3::Zero();
        scene.bodies.assign(1, body);
        const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(count)));
        for (std::size_t i = 0; i < count; ++i) {
            const bool falls = one_falls_in > 0 && i % one_falls_in == 0;
            body = ball;
            body.shape = falls ? 0 : 1;
            body.position = Vec3(static_cast<double>(i % side), static_cast<double>(i / side),
                                 falls ? 2000 : 0.25);
            scene.bodies.push_back(body);
        }
        scene.bodies.push_back(ball);
        return scene;
    }

    World world_;
    std::vector<BodyId> ids_;
};

void step_one_awake(State& state, std::size_t count)
{
    Sleepers asleep(count);
    for ([[maybe_unused]] auto iteration : state) asleep.world().step();
}

void step_one_driven(State& state, std::size_t count)
{
    Sleepers asleep(count);
    for ([[maybe_unused]] auto iteration : state) {
        asleep.roll();
        asleep.world().step();
    }
}

void step_none_awake(State& state, std::size_t count)
{
    Sleepers asleep(count);
    asleep.world().remove(std::array{asleep.ball()});
    asleep.world().step(2);
    for ([[maybe_unused]] auto iteration : state) asleep.world().step();
}

void set_pose_and_step(State& state, std::size_t count)
{
    Sleepers asleep(count);
    const Pose pose = asleep.world().pose(asleep.box());
    for ([[maybe_unused]] auto iteration : state) {
        asleep.world().set_pose(asleep.box(), pose);
        asleep.world().step();
    }
}

void add_remove_and_step(State& state, std::size_t count)
{
    Sleepers asleep(count);
    const Scene ball = Sleepers::ball_at(Vec3(-9, -9, 0.25));
    for ([[maybe_unused]] auto iteration : state) {
        const BodyId added = asleep.world().add(ball).front();
        asleep.world().step();
        asleep.world().remove({&added, 1});
        asleep.world().step();
    }
}

RayQuery down(std::size_t k)
{
    RayQuery ray;
    ray.origin = Vec3(3 + 0.01 * static_cast<double>(k % 1000), 4, 50);
    ray.direction = Vec3(0.1, 0.05, -1);
    return ray;
}

// The first after a step, of which the time is not counted.
void first_ray(State& state, std::size_t count)
{
    Sleepers asleep(count, 10);
    Queries queries(asleep.world());
    queries.cast_ray(down(0));
    std::size_t k = 0;
    for ([[maybe_unused]] auto iteration : state) {
        state.PauseTiming();
        asleep.world().step();
        state.ResumeTiming();
        benchmark::DoNotOptimize(queries.cast_ray(down(++k)));
    }
}

void further_ray(State& state, std::size_t count)
{
    Sleepers asleep(count, 10);
    Queries queries(asleep.world());
    std::size_t k = 0;
    for ([[maybe_unused]] auto iteration : state)
        benchmark::DoNotOptimize(queries.cast_ray(down(++k)));
}

struct Timed {
    const char* name;
    void (*time)(State&, std::size_t);
    int iterations;
};
constexpr Timed kTimed[] = {
    {"step, none awake", step_none_awake, 1000},
    {"step, one awake", step_one_awake, 300},
    {"set_velocity and step, one awake", step_one_driven, 300},
    {"set_pose of a sleeper and step", set_pose_and_step, 300},
    {"add, step, remove, step", add_remove_and_step, 3000},
    {"first ray after a step, a tenth awake", first_ray, 110},
    {"further ray", further_ray, 10'000},
};

}  // namespace

void register_benchmarks()
{
    for (const Timed& timed : kTimed)
        for (const std::size_t count : {1000u, 10'000u, 100'000u})
            benchmark::RegisterBenchmark(
                (std::string(timed.name) + ", " + std::to_string(count)).c_str(), timed.time, count)
                ->Iterations(timed.iterations)
                ->Unit(benchmark::kMicrosecond);
}

}  // namespace throng::perf
