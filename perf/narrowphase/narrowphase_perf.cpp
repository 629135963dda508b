// Narrow phase: what a pair of touching shapes takes, by kind of pair and of number.
//
// Caches are warm, as for a pair that touched in the last step and hardly moved since.
#include "cooking/hulls/hull.hpp"
#include "narrowphase/dispatch.hpp"
#include "perf/support.hpp"
#include "scene/catalog/random.hpp"

#include <array>
#include <numbers>
#include <string>

namespace throng::perf {
namespace {

// Enough that the processor cannot learn by heart which way each pair branches.
constexpr std::size_t kPairs = 1024;
constexpr double kOverlap = 0.005, kReach = 0.02;  // m, as in a pile of bodies of 1 m

// How a pair meets: turned any way, as in a heap just dropped; end on end or face on face, as in a
// stack; a's side along b's upper face; or as in a heap, but just beyond the margin.
enum class PairCase { anyhow, standing, lying, apart };

struct Case {
    const char* name;
    ShapeKind a, b;
    PairCase pair_case = PairCase::anyhow;
};

// clang-format off
constexpr Case kCases[] = {
    {"sphere_sphere",           ShapeKind::sphere,   ShapeKind::sphere},
    {"sphere_capsule",          ShapeKind::sphere,   ShapeKind::capsule},
    {"sphere_box",              ShapeKind::sphere,   ShapeKind::box},
    {"sphere_box_apart",        ShapeKind::sphere,   ShapeKind::box,      PairCase::apart},
    {"sphere_hull",             ShapeKind::sphere,   ShapeKind::hull},
    {"capsule_capsule",         ShapeKind::capsule,  ShapeKind::capsule},
    {"capsule_capsule_lying",   ShapeKind::capsule,  ShapeKind::capsule,  PairCase::lying},
    {"capsule_capsule_apart",   ShapeKind::capsule,  ShapeKind::capsule,  PairCase::apart},
    {"capsule_box",             ShapeKind::capsule,  ShapeKind::box},
    {"capsule_box_standing",    ShapeKind::capsule,  ShapeKind::box,      PairCase::standing},
    {"capsule_box_lying",       ShapeKind::capsule,  ShapeKind::box,      PairCase::lying},
    {"capsule_box_apart",       ShapeKind::capsule,  ShapeKind::box,      PairCase::apart},
    {"capsule_hull",            ShapeKind::capsule,  ShapeKind::hull},
    {"capsule_hull_apart",      ShapeKind::capsule,  ShapeKind::hull,     PairCase::apart},
    {"box_box",                 ShapeKind::box,      ShapeKind::box},
    {"box_box_lying",           ShapeKind::box,      ShapeKind::box,      PairCase::standing},
    {"hull_hull",               ShapeKind::hull,     ShapeKind::hull},
    {"cylinder_box",            ShapeKind::cylinder, ShapeKind::box},
    {"cylinder_box_standing",   ShapeKind::cylinder, ShapeKind::box,      PairCase::standing},
    {"cylinder_box_lying",      ShapeKind::cylinder, ShapeKind::box,      PairCase::lying},
    {"cylinder_cylinder",       ShapeKind::cylinder, ShapeKind::cylinder},
    {"cylinder_cylinder_lying", ShapeKind::cylinder, ShapeKind::cylinder, PairCase::standing},
    {"sphere_plane",            ShapeKind::sphere,   ShapeKind::plane},
    {"capsule_plane",           ShapeKind::capsule,  ShapeKind::plane},
    {"cylinder_plane",          ShapeKind::cylinder, ShapeKind::plane},
    {"box_plane",               ShapeKind::box,      ShapeKind::plane},
    {"box_plane_lying",         ShapeKind::box,      ShapeKind::plane,    PairCase::standing},
};
// clang-format on

Vec3 random_direction(Random& random)
{
    Vec3 direction = Vec3::Zero();
    while (direction.squaredNorm() > 1 || direction.squaredNorm() < 0.01)
        direction = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    return direction.normalized();
}

// One shape of each kind, about 1 m across.
Shapes make_shapes(Random& random)
{
    Shapes shapes;
    shapes.spheres = {{0.5}};
    shapes.capsules = {{0.3, 0.4}};
    shapes.cylinders = {{0.5, 0.4}};
    shapes.boxes = {{{0.5, 0.4, 0.3}}};
    shapes.planes = {{}};
    std::array<Vec3, 24> corners;
    for (Vec3& corner : corners) corner = random_direction(random) / 2;
    shapes.hulls = {build_hull(corners).hull};
    return shapes;
}

// Some pose of b in a's frame where they overlap a little: b comes nearer from afar until they do.
Pose touching_pose(const Shapes& shapes, const Case& pair, Random& random)
{
    Pose pose;
    Vec3 from = random_direction(random);
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const bool standing = pair.pair_case == PairCase::standing;
    if (standing) {
        pose.orientation = Eigen::AngleAxisd(angle, Vec3::UnitZ())
            * Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX());
    } else if (pair.pair_case == PairCase::lying) {
        // Their axes side by side for rods, a's axis along the face of a box.
        const bool rods = pair.a == pair.b;
        pose.orientation = Eigen::AngleAxisd(angle, Vec3::UnitZ())
            * Eigen::AngleAxisd(rods ? 0 : std::numbers::pi / 2, Vec3::UnitX());
        from = pose.orientation * (rods ? Vec3::UnitX() : Vec3(-Vec3::UnitZ()));
    } else {
        pose.orientation = Eigen::AngleAxisd(angle, random_direction(random));
    }
    // A plane faces what it touches.
    if (standing || pair.b == ShapeKind::plane) from = -(pose.orientation * Vec3::UnitZ());

    double touching = 0, apart = 4;
    for (int i = 0; i < 30; ++i) {
        const double middle = (touching + apart) / 2;
        pose.position = middle * from;
        PairCache cache;
        LocalManifold<double> found;
        collide<double>({shapes, {pair.a, 0}, {pair.b, 0}, pose, 0}, cache, found);
        (found.count > 0 ? touching : apart) = middle;
    }
    const bool apart_for_good = pair.pair_case == PairCase::apart;
    pose.position = (apart_for_good ? touching + 3 * kReach : touching - kOverlap) * from;
    return pose;
}

template <class Real>
void time_pairs(benchmark::State& state, const Case& pair)
{
    Random random(1);
    const Shapes shapes = make_shapes(random);
    std::vector<PoseT<Real>> poses;
    for (std::size_t i = 0; i < kPairs; ++i) {
        const Pose pose = touching_pose(shapes, pair, random);
        poses.push_back({pose.position.cast<Real>(), pose.orientation.cast<Real>()});
    }

    std::vector<PairCache> caches(kPairs);
    LocalManifold<Real> found;
    std::size_t points = 0;
    const auto collide_all = [&] {
        for (std::size_t i = 0; i < kPairs; ++i) {
            collide<Real>({shapes, {pair.a, 0}, {pair.b, 0}, poses[i], static_cast<Real>(kReach)},
                          caches[i], found);
            points += static_cast<std::size_t>(found.count);
        }
    };
    collide_all();
    state.counters["points"] = static_cast<double>(points) / static_cast<double>(kPairs);
    for ([[maybe_unused]] auto iteration : state) {
        collide_all();
        benchmark::DoNotOptimize(points);
    }
    state.counters["a_pair"] = time_of_one(kPairs);
}

}  // namespace

void register_benchmarks()
{
    for (const Case& pair : kCases) {
        const std::string name = pair.name;
        for (auto* const made :
             {benchmark::RegisterBenchmark((name + "/float").c_str(), time_pairs<float>, pair),
              benchmark::RegisterBenchmark((name + "/double").c_str(), time_pairs<double>, pair)})
            made->Unit(benchmark::kMicrosecond);
    }
}

}  // namespace throng::perf
