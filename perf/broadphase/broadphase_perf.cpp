// Broad phase: what a question to each finder takes, when all boxes moved and when few did.
#include "broadphase/broadphase.hpp"

#include "kernels/parallel/blocks.hpp"
#include "perf/support.hpp"
#include "tests/broadphase/random_boxes.hpp"

#include <array>
#include <string>

namespace throng::perf {
namespace {

constexpr std::size_t kBoxes = 10'000;

// As crowded as a pile: each box overlaps five others.
const test::BoxKind kPile{.name = "pile", .half_world = 12.5};

// How far a box moves between two questions, m: a fast body in a step.
constexpr double kMoved = 0.05;

struct Finder {
    const char* name;
    FinderKind kind;
};
constexpr Finder kFinders[] = {
    {"embree", FinderKind::embree},
    {"grid", FinderKind::grid},
    {"sweep", FinderKind::sweep},
    {"all_pairs", FinderKind::all_pairs},
};

// Boxes move to and fro, so that each question finds some that changed and all are alike.
void time_finder(benchmark::State& state, FinderKind kind, std::size_t one_in)
{
    test::Dice dice(1);
    const test::BoxScene scene = test::random_scene(dice, kPile, kBoxes, 0);
    std::array<std::vector<Box3>, 2> boxes{scene.boxes, scene.boxes};
    std::vector<std::uint32_t> asked;
    for (std::size_t i = 0; i < kBoxes; i += one_in) {
        const Vec3 moved = dice.point(kMoved);
        boxes[1][i].lower += moved;
        boxes[1][i].upper += moved;
        asked.push_back(static_cast<std::uint32_t>(i));
    }

    AnyPairFinder finder = make_finder(kind);
    std::vector<PairKey> pairs;
    ThreadPool pool(1);
    pool.run([&](std::size_t, std::size_t, std::size_t) {
        find_overlaps(scene.query(), finder, pairs);
        const auto ask = [&](std::size_t at) {
            find_overlaps({boxes[at], scene.moving, asked, false, nullptr}, finder, pairs);
        };
        // There and back once, so that buffers have grown and all count the same pairs.
        ask(1);
        ask(0);
        state.counters["pairs"] = static_cast<double>(pairs.size());
        std::size_t at = 0;
        for ([[maybe_unused]] auto iteration : state) ask(at = 1 - at);
    });
    state.counters["a_box"] = time_of_one(asked.size());
}

}  // namespace

void register_benchmarks()
{
    for (const Finder& finder : kFinders) {
        for (const std::size_t one_in : {1, 20}) {
            const std::string name =
                std::string(finder.name) + (one_in == 1 ? "/all_asked" : "/5_percent_asked");
            benchmark::RegisterBenchmark(name.c_str(), time_finder, finder.kind, one_in)
                ->UseRealTime()
                ->Unit(benchmark::kMillisecond);
        }
    }
}

}  // namespace throng::perf
