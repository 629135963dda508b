// Stages: what each stage of a step takes, with its data in the caches and without.
//
// `warm` is the stage within an ordinary step. `cold` is the same after walking through twice as
// much memory as the last cache holds, so that every byte comes from afar: the bound for a world
// that shares its machine. A stage changes what it works on, so it cannot be run again on the same
// data; all stages of some steps are timed together, and each benchmark tells of one of them.
#include "kernels/parallel/blocks.hpp"
#include "perf/support.hpp"
#include "pipeline/world/world_state.hpp"
#include "throng/catalog.hpp"

#include <map>
#include <string>
#include <tuple>

namespace throng::perf {
namespace {

constexpr int kTimed = 20;  // steps

struct Warmed {
    const char* scene;
    int size, steps;  // those that pass before: what falls has landed
};
constexpr Warmed kScenes[] = {
    {"pile", 10'000, 160},  {"spheres", 10'000, 160}, {"hulls", 10'000, 160}, {"wall", 10'000, 40},
    {"stacks", 10'000, 40}, {"crowd", 10'000, 100},   {"sparse", 10'000, 20},
};

/// Empties the caches before every stage.
class Emptier final : public StepWatch {
public:
    void run_stage(std::string_view, const std::function<void()>& stage) override
    {
        // In blocks, so that every thread walks its share and empties its own caches, too.
        for_each_block(kBlocks, 1, [&](std::size_t, std::size_t, std::size_t block) {
            const std::size_t share = memory_.size() / kBlocks;
            for (std::size_t i = block * share; i < (block + 1) * share; i += kLine) ++memory_[i];
        });
        stage();
    }

private:
    static constexpr std::size_t kBlocks = 8, kLine = 64;
    std::vector<unsigned char> memory_ = std::vector<unsigned char>(std::size_t{64} << 20);
};

/// Times of every stage, ms by step.
using StageSamples = std::map<std::string, std::vector<double>, std::less<>>;

void keep(const World& world, StageSamples& samples)
{
    for (const StageReport& stage : world.stages())
        samples[std::string(stage.name)].push_back(stage.time_ms);
}

/// Both kinds of samples, taken at the first call for a scene and a number of threads.
const StageSamples& samples_of(const Warmed& warmed, int threads, bool cold)
{
    static std::map<std::tuple<std::string_view, int, bool>, StageSamples> known;
    const auto found = known.find({warmed.scene, threads, cold});
    if (found != known.end()) return found->second;
    Scene scene = make_scene(warmed.scene, warmed.size);
    scene.settings.sleep = false;
    World world(scene, threads);
    world.step(warmed.steps);
    Emptier emptier;
    // Turn and turn about, so that whatever else the machine does meets both.
    for (int i = 0; i < kTimed; ++i) {
        state_of(world).watch = &emptier;
        world.step();
        keep(world, known[{warmed.scene, threads, true}]);
        state_of(world).watch = nullptr;
        world.step();  // fills the caches again
        world.step();
        keep(world, known[{warmed.scene, threads, false}]);
    }
    return known[{warmed.scene, threads, cold}];
}

void time_stage(
    benchmark::State& state, const Warmed& warmed, int threads, bool cold, const std::string& stage)
{
    const StageSamples& samples = samples_of(warmed, threads, cold);
    const auto found = samples.find(stage);
    std::size_t step = 0;
    for ([[maybe_unused]] auto iteration : state) {
        const double ms = found == samples.end() ? 0 : found->second[step % kTimed];
        state.SetIterationTime(ms / 1e3);
        ++step;
    }
}

}  // namespace

void register_benchmarks()
{
    for (const Warmed& warmed : kScenes) {
        // A small one has the same stages, for their names.
        Scene scene = make_scene(warmed.scene, 20);
        scene.settings.sleep = false;
        World named(scene);
        for (const World::StageInfo& stage : named.step_stages())
            for (const int threads : {1, 2})
                for (const bool cold : {false, true}) {
                    const std::string name = std::string(warmed.scene) + ':'
                        + std::to_string(warmed.size) + '/' + std::string(stage.name)
                        + "/threads:" + std::to_string(threads) + (cold ? "/cold" : "/warm");
                    benchmark::RegisterBenchmark(name.c_str(), time_stage, warmed, threads, cold,
                                                 std::string(stage.name))
                        ->Iterations(kTimed)
                        ->UseManualTime()
                        ->Unit(benchmark::kMillisecond);
                }
    }
}

}  // namespace throng::perf
