// Box pairs: what pairs of boxes take one by one, and many at once, by how they meet.
#include "narrowphase/convex/wide/box_pairs.hpp"

#include "narrowphase/dispatch.hpp"
#include "perf/support.hpp"
#include "scene/catalog/random.hpp"

#include <numbers>
#include <string>

namespace throng::perf {
namespace {

constexpr double kOverlap = 0.005, kReach = 0.02;  // m, as in a pile of bodies of 1 m

Vec3 random_direction(Random& random)
{
    Vec3 direction = Vec3::Zero();
    while (direction.squaredNorm() > 1 || direction.squaredNorm() < 0.01)
        direction = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    return direction.normalized();
}

// Some pose of box 1 in the frame of box 0 where they overlap a little.
Pose touching_pose(const Shapes& shapes, Random& random)
{
    Pose pose;
    const Vec3 from = random_direction(random);
    pose.orientation =
        Eigen::AngleAxisd(random.uniform(0, 2 * std::numbers::pi), random_direction(random));
    double touching = 0, apart = 4;
    for (int i = 0; i < 30; ++i) {
        const double middle = (touching + apart) / 2;
        pose.position = middle * from;
        PairCache cache;
        LocalManifold<double> found;
        collide<double>({shapes, {ShapeKind::box, 0}, {ShapeKind::box, 1}, pose, 0}, cache, found);
        (found.count > 0 ? touching : apart) = middle;
    }
    pose.position = (touching - kOverlap) * from;
    return pose;
}

// Of a pile's pairs whose bounds overlap three in four are apart.
enum class Lot { apart, touching, lying, stacked, pile };

struct BoxCase {
    const char* name;
    Lot lot;
};

// clang-format off
constexpr BoxCase kBoxCases[] = {
    {"boxes_apart",    Lot::apart},
    {"boxes_touching", Lot::touching},
    {"boxes_lying",    Lot::lying},
    {"boxes_stacked",  Lot::stacked},
    {"boxes_pile",     Lot::pile},
};
// clang-format on

// More than the nearest caches hold.
constexpr std::size_t kManyPairs = 16384;

struct ManyBoxes {
    Shapes shapes;  // boxes of pair i: 2 i, 2 i + 1
    std::vector<PoseT<float>> poses;
    std::vector<BoxPair> pairs;
};

// No two pairs are alike.
ManyBoxes make_boxes(Lot lot)
{
    Random random(2);
    ManyBoxes made;
    for (std::size_t i = 0; i < kManyPairs; ++i) {
        Shapes two;
        for (int k = 0; k < 2; ++k)
            two.boxes.push_back(
                {{random.uniform(0.3, 0.5), random.uniform(0.3, 0.5), random.uniform(0.3, 0.5)}});
        if (lot == Lot::stacked) two.boxes[1] = two.boxes[0];
        const Vec3 half_a = two.boxes[0].half_extents, half_b = two.boxes[1].half_extents;
        Pose pose;
        if (lot == Lot::stacked || lot == Lot::lying) {
            const double spread = lot == Lot::lying ? 0.3 : 0.001;
            pose.position = {random.uniform(-spread, spread), random.uniform(-spread, spread),
                             half_a.z() + half_b.z() - kOverlap};
            if (lot == Lot::lying)
                pose.orientation = Eigen::AngleAxisd(random.uniform(-3, 3), Vec3::UnitZ());
        } else {
            pose = touching_pose(two, random);
            const bool apart =
                lot == Lot::apart || (lot == Lot::pile && random.uniform(0, 1) < 0.75);
            if (apart) pose.position += pose.position.normalized() * random.uniform(0.05, 0.2);
        }
        made.shapes.boxes.insert(made.shapes.boxes.end(), two.boxes.begin(), two.boxes.end());
        made.poses.push_back({pose.position.cast<float>(), pose.orientation.cast<float>()});
        made.pairs.push_back(box_pair(made.poses.back(), half_a.cast<float>(), half_b.cast<float>(),
                                      static_cast<float>(kReach)));
    }
    return made;
}

void time_box_box(benchmark::State& state, const BoxCase& boxes)
{
    const ManyBoxes made = make_boxes(boxes.lot);
    std::vector<PairCache> caches(kManyPairs);
    std::vector<LocalManifold<float>> found(kManyPairs);
    for ([[maybe_unused]] auto iteration : state) {
        for (std::uint32_t i = 0; i < kManyPairs; ++i)
            collide<float>({made.shapes,
                            {ShapeKind::box, 2 * i},
                            {ShapeKind::box, 2 * i + 1},
                            made.poses[i],
                            static_cast<float>(kReach)},
                           caches[i], found[i]);
        benchmark::ClobberMemory();
    }
    state.counters["a_pair"] = time_of_one(kManyPairs);
}

void time_collide_boxes(benchmark::State& state, const BoxCase& boxes, const BoxKernels& kernels)
{
    const ManyBoxes made = make_boxes(boxes.lot);
    std::vector<LocalManifold<float>> found(kManyPairs);
    for ([[maybe_unused]] auto iteration : state) {
        collide_boxes(kernels, made.pairs, found);
        benchmark::ClobberMemory();
    }
    state.counters["a_pair"] = time_of_one(kManyPairs);
}

}  // namespace

void register_benchmarks()
{
    for (const BoxCase& boxes : kBoxCases) {
        const std::string name = boxes.name;
        benchmark::RegisterBenchmark((name + "/one_by_one").c_str(), time_box_box, boxes)
            ->Unit(benchmark::kMicrosecond);
        for (const char* width : {"scalar", "avx2", "avx512"})
            if (const BoxKernels* const kernels = box_kernels_of(width))
                benchmark::RegisterBenchmark((name + "/" + width).c_str(), time_collide_boxes,
                                             boxes, *kernels)
                    ->Unit(benchmark::kMicrosecond);
    }
}

}  // namespace throng::perf
