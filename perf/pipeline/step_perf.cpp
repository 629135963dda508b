// Step: what a step of a warmed-up world takes, by scene, size and threads.
//
// Each run makes its world anew and lets it go as far as every other: all runs time the same steps.
#include "perf/support.hpp"
#include "throng/catalog.hpp"
#include "throng/throng.hpp"

#include <string>

namespace throng::perf {
namespace {

constexpr int kTimed = 60;  // steps, a second

// How many steps pass before the clock starts: those that fall have landed, and most of them lie.
struct Warmed {
    const char* scene;
    int steps;
};
constexpr Warmed kScenes[] = {{"pile", 240}, {"spheres", 240}, {"stacks", 60}, {"crowd", 120}};

void time_steps(benchmark::State& state, const Warmed& warmed, int size, int threads)
{
    Scene scene = make_scene(warmed.scene, size);
    scene.settings.sleep = false;  // what has come to rest is to be timed, too
    World world(scene, threads);
    world.step(warmed.steps);

    std::size_t contacts = 0;
    for ([[maybe_unused]] auto iteration : state) {
        world.step();
        contacts += world.report().contacts;
    }
    using benchmark::Counter;
    const auto all = static_cast<double>(contacts);
    state.counters["contacts"] = Counter(all, Counter::kAvgIterations);
    state.counters["a_contact"] = Counter(all, Counter::kIsRate | Counter::kInvert);
}

}  // namespace

void register_benchmarks()
{
    for (const Warmed& warmed : kScenes) {
        for (const int size : {1000, 10'000}) {
            for (const int threads : {1, 2}) {
                const std::string name = std::string(warmed.scene) + ':' + std::to_string(size)
                    + "/threads:" + std::to_string(threads);
                // A set number of iterations is what makes each run one world and no more.
                benchmark::RegisterBenchmark(name.c_str(), time_steps, warmed, size, threads)
                    ->Iterations(kTimed)
                    ->UseRealTime()
                    ->Unit(benchmark::kMillisecond);
            }
        }
    }
}

}  // namespace throng::perf
