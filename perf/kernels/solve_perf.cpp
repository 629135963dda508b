// Solve: what one iteration of the solver to a manifold takes, with its rows in a core's own cache
// and in scenes that are larger than any cache.
//
// Rows are those of a scene in contact, so the mixture of points, bodies and colors is that of a
// step; those in cache are a sample of the same rows with their bodies put side by side. Both are
// timed in turn, and `of_cache` is what a manifold of the whole costs beside one of the sample:
// memory's share, whatever else the machine does.
#include "kernels/solver/solve_kernels.hpp"
#include "perf/support.hpp"
#include "pipeline/world/world_state.hpp"
#include "throng/catalog.hpp"

#include <algorithm>
#include <ctime>
#include <map>
#include <memory>
#include <string>

namespace throng::perf {
namespace {

// Iterations between two restores. A step of four substeps makes twelve; left to themselves the
// rows would come to rest and work on numbers that no longer change.
constexpr int kVisits = 12;

// Half of a core's second cache: blocks, points and bodies together.
constexpr std::size_t kCacheBytes = 512 << 10;

enum class Kernel : std::uint8_t { solve_biased, relax, warm_start };
constexpr const char* kKernelNames[] = {"push", "relax", "warm_start"};

/// Rows with the runs of blocks to iteration, in order: slice by slice.
template <class Real>
struct Visited {
    ContactConstraints<Real> constraints;
    std::vector<std::vector<Color>> slices;
    std::size_t manifolds = 0;

    /// What an iteration has to bring in.
    std::size_t bytes() const
    {
        return constraints.blocks.size() * sizeof(constraints.blocks[0])
            + constraints.points.size() * sizeof(constraints.points[0])
            + constraints.bodies.size() * sizeof(constraints.bodies[0]);
    }
};

template <class Real>
struct Sampled {
    Visited<Real> whole, sample;
};

std::size_t manifolds_of(const Layout& layout, std::size_t block)
{
    std::size_t count = 0;
    for (std::size_t lane = 0; lane < kBlock; ++lane)
        count += layout.lanes[block * kBlock + lane].entry != LaneSource{}.entry ? 1 : 0;
    return count;
}

// Every so many blocks, so that all colors are in the sample, with what belongs to them.
template <class Real>
Visited<Real> sample_of(const ContactConstraints<Real>& constraints, const Layout& layout)
{
    Visited<Real> sample;
    sample.slices.resize(1);
    std::map<std::int32_t, std::int32_t> places;
    const auto solver_index_of = [&](std::int32_t body) {
        const auto [at, fresh] =
            places.try_emplace(body, static_cast<std::int32_t>(sample.constraints.bodies.size()));
        if (fresh)
            sample.constraints.bodies.push_back(constraints.bodies[static_cast<std::size_t>(body)]);
        return at->second;
    };
    const std::size_t a_block = sizeof(ContactConstraintWide<Real>)
        + 4 * sizeof(ContactPointWide<Real>) + 2 * kBlock * sizeof(SolverBody<Real>);
    const std::size_t stride =
        std::max<std::size_t>(1, constraints.blocks.size() * a_block / kCacheBytes);
    for (std::size_t place = 0; place < constraints.blocks.size(); place += stride) {
        ContactConstraintWide<Real> block = constraints.blocks[place];
        const auto points = constraints.points.begin() + block.first_point;
        block.first_point = static_cast<std::uint32_t>(sample.constraints.points.size());
        sample.constraints.points.insert(sample.constraints.points.end(), points,
                                         points + block.points);
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            block.a[lane] = solver_index_of(block.a[lane]);
            block.b[lane] = solver_index_of(block.b[lane]);
        }
        sample.constraints.blocks.push_back(block);
        sample.manifolds += manifolds_of(layout, place);
        sample.slices[0].push_back(
            {static_cast<std::uint32_t>(sample.constraints.blocks.size() - 1), 1});
    }
    return sample;
}

struct SceneSize {
    const char* scene;
    int size, steps;   // those that pass before
    int together = 4;  // iterations to a slice, where an island is cut: those of two substeps
};

/// The rows of a scene after some steps, made at the first call.
template <class Real>
const Sampled<Real>& rows_of(const SceneSize& asked)
{
    static std::map<std::string, std::unique_ptr<Sampled<Real>>> known;
    std::unique_ptr<Sampled<Real>>& made =
        known[std::string(asked.scene) + std::to_string(asked.size)];
    if (made) return *made;
    Scene scene = make_scene(asked.scene, asked.size);
    scene.settings.sleep = false;
    scene.settings.precision = std::is_same_v<Real, float> ? Precision::float_ : Precision::double_;
    World world(scene);
    world.step(asked.steps);

    made = std::make_unique<Sampled<Real>>();
    const auto& data = std::get<Step<Real>>(state_of(world).step).data;
    const auto& layout = std::get<Layout>(data);
    made->whole.constraints = std::get<ContactConstraints<Real>>(data);
    for (const Slice& slice : layout.slices) {
        const auto first = layout.colors.begin() + slice.first_color;
        made->whole.slices.emplace_back(first, first + slice.colors);
    }
    for (std::size_t block = 0; block < made->whole.constraints.blocks.size(); ++block)
        made->whole.manifolds += manifolds_of(layout, block);
    made->sample = sample_of(made->whole.constraints, layout);
    return *made;
}

// Of this thread alone, s: what others take of the machine's time is not counted.
double thread_seconds()
{
    timespec now = {};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) / 1e9;
}

/// Time of an iteration to all rows, s, on the mean over kVisits from the given start; so many
/// together as in a step: walls have three a substep and go there and back, heaps two.
template <class Real>
double time_visits(const SolveKernels<Real>& kernels,
                   Kernel kernel,
                   const Visited<Real>& start,
                   int together,
                   ContactConstraints<Real>& constraints)
{
    constraints.blocks = start.constraints.blocks;
    constraints.points = start.constraints.points;
    constraints.bodies = start.constraints.bodies;
    const ContactConstraintsView<Real> view = ContactConstraintsView<Real>::of(constraints);
    SolverIteration<Real> iteration;
    iteration.inverse_substep = 240;
    iteration.push_limit = 3;
    iteration.use_bias = kernel == Kernel::solve_biased;
    iteration.normal_iterations = iteration.use_bias ? 2 : 1;
    const auto visit_slice = [&](std::size_t, std::size_t slice) {
        for (const Color& color : start.slices[slice]) {
            const std::size_t first = color.first, end = first + color.count;
            if (kernel == Kernel::warm_start)
                kernels.warm_start(view, first, end, iteration);
            else
                kernels.solve(view, first, end, iteration);
        }
    };
    const double begin = thread_seconds();
    for (int i = 0; i < kVisits; i += together)
        constraints.scratch.wave.run(static_cast<std::size_t>(together), start.slices.size(),
                                     visit_slice);
    return (thread_seconds() - begin) / kVisits;
}

template <class Real>
void time_in_cache(benchmark::State& state,
                   const SolveKernels<Real>& kernels,
                   const SceneSize& scene,
                   Kernel kernel)
{
    const Visited<Real>& sample = rows_of<Real>(scene).sample;
    ContactConstraints<Real> constraints;
    for ([[maybe_unused]] auto iteration : state)
        state.SetIterationTime(time_visits(kernels, kernel, sample, kVisits, constraints));
    state.counters["a_manifold"] = time_of_one(sample.manifolds);
    state.counters["KiB"] = static_cast<double>(sample.bytes()) / 1024;
}

// The whole and the sample in turn, the best of each compared. `bound` is what of_cache is not to
// exceed.
void time_scene(benchmark::State& state, const SceneSize& scene, Kernel kernel, double bound)
{
    const SolveKernels<float>& kernels = solve_kernels<float>();
    const Sampled<float>& sampled = rows_of<float>(scene);
    ContactConstraints<float> whole, sample;
    double of_whole = 1e30, of_sample = 1e30;
    for ([[maybe_unused]] auto iteration : state) {
        const double in_cache =
            time_visits(kernels, kernel, sampled.sample, scene.together, sample);
        const double taken = time_visits(kernels, kernel, sampled.whole, scene.together, whole);
        of_sample = std::min(of_sample, in_cache / static_cast<double>(sampled.sample.manifolds));
        of_whole = std::min(of_whole, taken / static_cast<double>(sampled.whole.manifolds));
        state.SetIterationTime(taken);
    }
    state.counters["a_manifold"] = time_of_one(sampled.whole.manifolds);
    state.counters["best_ns"] = of_whole * 1e9;
    state.counters["cache_ns"] = of_sample * 1e9;
    state.counters["of_cache"] = of_whole / of_sample;
    state.counters["bound"] = bound;
    state.counters["GB/s"] = benchmark::Counter(static_cast<double>(sampled.whole.bytes()) / 1e9,
                                                benchmark::Counter::kIsIterationInvariantRate);
}

// One point a manifold, four, and every number.
constexpr SceneSize kSmall[] = {{"spheres", 1000, 60}, {"wall", 1000, 5}, {"pile", 1000, 60}};

struct Bounded {
    SceneSize scene;
    double bound;
};
constexpr Bounded kLarge[] = {{{"pile", 10'000, 60}, 1.3},
                              {{"wall", 10'000, 5}, 1.3},
                              {{"pile", 100'000, 40}, 1.6},
                              {{"wall", 100'000, 2, 3}, 1.6}};
constexpr Kernel kKernels[] = {Kernel::solve_biased, Kernel::relax, Kernel::warm_start};

template <class Real>
void register_in_cache(const std::string& number)
{
    for (const char* width : {"scalar", "avx2", "avx512"}) {
        const SolveKernels<Real>* const kernels = solve_kernels_of<Real>(width);
        if (kernels == nullptr) continue;
        for (const SceneSize& scene : kSmall)
            for (const Kernel kernel : kKernels) {
                const std::string name = "in_cache/" + number + '/' + width + '/' + scene.scene
                    + '/' + kKernelNames[static_cast<int>(kernel)];
                benchmark::RegisterBenchmark(name.c_str(), time_in_cache<Real>, *kernels, scene,
                                             kernel)
                    ->UseManualTime()
                    ->Unit(benchmark::kMicrosecond);
            }
    }
}

}  // namespace

void register_benchmarks()
{
    register_in_cache<float>("float");
    register_in_cache<double>("double");
    for (const auto& [scene, bound] : kLarge)
        for (const Kernel kernel : kKernels) {
            const std::string name = std::string(scene.scene) + ':' + std::to_string(scene.size)
                + '/' + kKernelNames[static_cast<int>(kernel)];
            benchmark::RegisterBenchmark(name.c_str(), time_scene, scene, kernel, bound)
                ->UseManualTime()
                ->Unit(benchmark::kMicrosecond);
        }
}

}  // namespace throng::perf
