// GJK: what it takes to ask about two hulls, by how many vertices they have and how they meet, by
// GJK and by SAT, beside other libraries.
//
// All take turns over the same pairs in the same poses, so that ratios hold on a busy machine. The
// poses are steps of a slow motion, to and fro; placing a pair is not counted.
#include "cooking/hulls/hull.hpp"
#include "narrowphase/alternatives/convex_methods.hpp"
#include "perf/narrowphase/hull_peers.hpp"
#include "perf/support.hpp"
#include "scene/catalog/parts.hpp"

#include <chrono>
#include <string>

namespace throng::perf {
namespace {

constexpr std::size_t kPairs = 64, kSteps = 8;
constexpr double kReach = 0.02;  // m, as in a pile of bodies of 1 m

struct Case {
    const char* name;
    double clearance;           // m
    double speculative_margin;  // m
    Question question;
};
// clang-format off
constexpr Case kCases[] = {
    {"far",       2,     kReach, Question::whether},
    {"apart",     0.1,   0,      Question::whether},
    {"near",      0.1,   1e9,    Question::distance},
    {"touching", -0.005, kReach, Question::depth},
    {"deep",     -0.2,   kReach, Question::depth},
};
// clang-format on

// As many vertices, exactly: all of a ball's points are corners.
Hull round_hull(Random& random, std::size_t vertices)
{
    std::vector<Vec3> points(vertices);
    for (Vec3& point : points) point = random_direction(random) / 2;
    return build_hull(points).hull;
}

MethodAnswer ask(const char* method, const ConvexPair& pair)
{
    MethodMemory memory;
    return find_convex_method(method)->ask(pair, 1e9, MethodStart::cold, memory);
}

// b moved along the way it lies until the gap is the one wanted.
Pose meeting_pose(const Shapes& shapes, ShapeRef a, ShapeRef b, double clearance, Random& random)
{
    Pose pose{Vec3::Zero(), random_turn(random, 3)};
    const Vec3 from = random_direction(random);
    double near = 0, far = 4;
    for (int i = 0; i < 40; ++i) {
        const double middle = (near + far) / 2;
        pose.position = middle * from;
        const ConvexPair pair(shapes, a, b, pose);
        (ask("gjk", pair).separation < clearance ? near : far) = middle;
    }
    return pose;
}

struct Scene {
    Shapes shapes;
    std::vector<HullsMoving> moving;
    std::vector<std::unique_ptr<ConvexPair>> pairs;  // step by step

    Scene(std::size_t vertices, double clearance)
    {
        Random random(1);
        constexpr std::uint32_t kHulls = 16;
        for (std::uint32_t i = 0; i < kHulls; ++i)
            shapes.hulls.push_back(round_hull(random, vertices));
        std::vector<std::array<ShapeRef, 2>> refs;
        for (std::size_t i = 0; i < kPairs; ++i) {
            const ShapeRef a{ShapeKind::hull, random.below(kHulls)};
            const ShapeRef b{ShapeKind::hull, random.below(kHulls)};
            HullsMoving one{&shapes.hulls[a.index], &shapes.hulls[b.index], {}};
            Pose pose = meeting_pose(shapes, a, b, clearance, random);
            const Vec3 drift = random_direction(random) * 0.001;
            const Quat turn = random_turn(random, 0.005);
            for (std::size_t step = 0; step < kSteps; ++step) {
                one.b_in_a.push_back(pose);
                pose.position += drift;
                pose.orientation = (turn * pose.orientation).normalized();
            }
            moving.push_back(std::move(one));
            refs.push_back({a, b});
        }
        for (std::size_t step = 0; step < kSteps; ++step)
            for (std::size_t i = 0; i < kPairs; ++i)
                pairs.push_back(std::make_unique<ConvexPair>(shapes, refs[i][0], refs[i][1],
                                                             moving[i].b_in_a[step]));
    }
};

// Times one of those that take turns.
class Turn {
public:
    explicit Turn(std::string of) : name(std::move(of)) { }

    template <class Ask>
    void run(Ask ask)
    {
        const auto begin = std::chrono::steady_clock::now();
        double sum = 0;
        for (std::size_t step = 0; step < 2 * kSteps - 2; ++step)
            for (std::size_t i = 0; i < kPairs; ++i)
                sum += ask(i, step < kSteps ? step : 2 * kSteps - 2 - step);
        benchmark::DoNotOptimize(sum);
        const std::chrono::duration<double, std::nano> took =
            std::chrono::steady_clock::now() - begin;
        best = std::min(best, took.count() / static_cast<double>(kPairs * (2 * kSteps - 2)));
    }

    std::string name;
    double best = 1e300;  // ns, of one question
};

void time_pairs(benchmark::State& state, std::size_t vertices, const Case& pair_case, bool warm)
{
    const Scene scene(vertices, pair_case.clearance);
    const MethodStart start = warm ? MethodStart::cached : MethodStart::cold;
    std::vector<Turn> ours{Turn("gjk"), Turn("sat")}, theirs;
    const auto peers = make_hull_peers(scene.moving, pair_case.question);
    for (const auto& peer : peers) theirs.emplace_back(peer->name);
    std::vector<std::vector<MethodMemory>> memory(ours.size(), std::vector<MethodMemory>(kPairs));

    for ([[maybe_unused]] auto iteration : state) {
        for (std::size_t i = 0; i < ours.size(); ++i) {
            const auto method = find_convex_method(ours[i].name)->ask;
            ours[i].run([&](std::size_t pair, std::size_t step) {
                const ConvexPair& asked = *scene.pairs[step * kPairs + pair];
                return method(asked, pair_case.speculative_margin, start, memory[i][pair])
                    .separation;
            });
        }
        for (std::size_t i = 0; i < theirs.size(); ++i)
            theirs[i].run([&](std::size_t pair, std::size_t step) {
                return peers[i]->ask(pair, step, pair_case.speculative_margin, warm);
            });
    }
    double off = 0;
    if (pair_case.question != Question::whether && !peers.empty())
        for (std::size_t i = 0; i < kPairs; ++i) {
            MethodMemory fresh;
            const ConvexPair& asked = *scene.pairs[i];
            const double truth =
                find_convex_method("gjk")
                    ->ask(asked, pair_case.speculative_margin, MethodStart::cold, fresh)
                    .separation;
            for (const auto& peer : peers)
                off = std::max(
                    off, std::abs(peer->ask(i, 0, pair_case.speculative_margin, false) - truth));
        }
    state.counters["off"] = off;
    for (const Turn& turn : ours) state.counters[turn.name + "_ns"] = turn.best;
    for (const Turn& turn : theirs) {
        state.counters[turn.name + "_ns"] = turn.best;
        state.counters["x_" + turn.name] = ours[0].best / turn.best;
    }
}

}  // namespace

void register_benchmarks()
{
    for (const std::size_t vertices : {8, 32, 128, 1000})
        for (const Case& pair_case : kCases)
            for (const bool warm : {false, true}) {
                const std::string name =
                    std::to_string(vertices) + "/" + pair_case.name + (warm ? "/warm" : "/cold");
                benchmark::RegisterBenchmark(name.c_str(), time_pairs, vertices, pair_case, warm)
                    ->Iterations(30)
                    ->Unit(benchmark::kMillisecond);
            }
}

}  // namespace throng::perf
