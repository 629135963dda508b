// Solids: what a pair of bodies that are not convex takes, by the way they are taken, and what it
// takes to make each way's data and to read them back.
//
// Noisy lumps about 1 m across. `near` overlaps by 5 mm somewhere, `apart` is twice the speculative
// margin from touching, with bounds that mostly overlap still. `cold` finds the touches; `warm` is
// what a step does about a pair that it knows: solids that have hardly moved since move their
// manifolds, hulls begin with what they remember. Level sets are in voxel_perf.cpp.
#include "cooking/decomposition/parts_cache.hpp"
#include "cooking/repair/mesh_health.hpp"
#include "cooking/sphere_trees/spheres_cache.hpp"
#include "kernels/geometry/image_views.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/dispatch.hpp"
#include "narrowphase/manifold/recycling.hpp"
#include "narrowphase/solid/solid_pairs.hpp"
#include "perf/support.hpp"
#include "scene/catalog/noisy_balls.hpp"
#include "scene/catalog/random.hpp"
#include "scene/shapes/solid_maker.hpp"
#include "throng/dials.hpp"

#include <filesystem>
#include <map>
#include <numbers>
#include <string>

namespace throng::perf {
namespace {

constexpr std::size_t kPairs = 64;
constexpr double kRadius = 0.5, kRoughness = 0.3;  // of the lumps, which are as knobby as a scan
constexpr double kOverlap = 0.005, kReach = 0.02;  // m, as in narrowphase_perf.cpp
constexpr double kMoved = 1e-4;                    // m and radians: little enough to be recycled
constexpr std::uint32_t kPairTriangles = 2000, kManyTriangles = 70000;

TriangleSoup lump(std::uint32_t triangles, std::uint64_t seed)
{
    return noisy_ball(kRadius, kRoughness, triangles, seed);
}

// Two lumps, taken one way: two solids, or the convex parts of both.
struct Lumps {
    Shapes shapes;
    std::array<std::vector<ShapeRef>, 2> of;
};

Lumps make_lumps(const std::string& way)
{
    Lumps lumps;
    Settings settings;
    set_dial(settings, "nonconvex", way);
    for (std::size_t side = 0; side < 2; ++side) {
        MeshShape stated;
        TriangleSoup soup = lump(kPairTriangles, side + 1);
        stated.vertices = std::move(soup.vertices);
        stated.triangles = std::move(soup.triangles);
        MadeSolid made = make_solid(stated, settings, "");
        if (auto* const solid = std::get_if<Solid>(&made.shape)) {
            lumps.of[side] = {{ShapeKind::solid, static_cast<std::uint32_t>(side)}};
            lumps.shapes.solids.push_back(std::move(*solid));
            continue;
        }
        for (Hull& hull : std::get<std::vector<Hull>>(made.shape)) {
            lumps.of[side].push_back(
                {ShapeKind::hull, static_cast<std::uint32_t>(lumps.shapes.hulls.size())});
            lumps.shapes.hulls.push_back(std::move(hull));
        }
    }
    return lumps;
}

const Lumps& lumps_by(const std::string& way)
{
    static std::map<std::string, Lumps> made;
    const auto found = made.find(way);
    return found != made.end() ? found->second : made.emplace(way, make_lumps(way)).first->second;
}

Vec3 random_direction(Random& random)
{
    Vec3 direction = Vec3::Zero();
    while (direction.squaredNorm() > 1 || direction.squaredNorm() < 0.01)
        direction = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    return direction.normalized();
}

// Poses of the second lump in the first's frame, the same for all ways: nearer and nearer until
// their level sets overlap as deep as wanted.
std::vector<Pose> make_poses(bool apart)
{
    const Lumps& lumps = lumps_by("voxels");
    Random random(1);
    std::vector<Pose> poses(kPairs);
    std::vector<PartManifold> patches;
    for (Pose& pose : poses) {
        const Vec3 from = random_direction(random);
        pose.orientation =
            Eigen::AngleAxisd(random.uniform(0, 2 * std::numbers::pi), random_direction(random));
        double touching = 0, parted = 4 * kRadius;
        for (int i = 0; i < 30; ++i) {
            const double middle = (touching + parted) / 2;
            pose.position = middle * from;
            patches.clear();
            collide_solid({lumps.shapes, lumps.of[0][0], lumps.of[1][0], pose, 0}, patches);
            (patches.empty() ? parted : touching) = middle;
        }
        pose.position = (apart ? touching + 2 * kReach : touching - kOverlap) * from;
    }
    return poses;
}

const std::vector<Pose>& poses_of(bool apart)
{
    static const std::array<std::vector<Pose>, 2> poses = {make_poses(false), make_poses(true)};
    return poses[apart ? 1 : 0];
}

void tell(benchmark::State& state, std::size_t manifolds, std::size_t points)
{
    state.counters["a_pair"] = time_of_one(kPairs);
    state.counters["manifolds"] = static_cast<double>(manifolds) / static_cast<double>(kPairs);
    state.counters["points"] = static_cast<double>(points) / static_cast<double>(kPairs);
}

void find_touches(benchmark::State& state, const std::string& way, bool apart)
{
    const Lumps& lumps = lumps_by(way);
    const std::vector<Pose>& poses = poses_of(apart);
    std::vector<PartManifold> patches;
    for ([[maybe_unused]] auto iteration : state) {
        patches.clear();
        for (const Pose& pose : poses)
            collide_solid({lumps.shapes, lumps.of[0][0], lumps.of[1][0], pose, kReach}, patches);
        benchmark::DoNotOptimize(patches.data());
    }
    std::size_t points = 0;
    for (const PartManifold& patch : patches)
        points += static_cast<std::size_t>(patch.manifold.count);
    tell(state, patches.size(), points);
}

// What was found of a pair, and where it is a moment later.
struct Known {
    Pose then, now;
    std::vector<PartManifold> patches;
};

std::vector<Known> make_known(const Lumps& lumps, bool apart)
{
    std::vector<Known> known;
    const Eigen::AngleAxisd turned(kMoved, Vec3(1, 2, 2) / 3);
    for (const Pose& pose : poses_of(apart)) {
        Known& pair = known.emplace_back();
        pair.then = pose;
        pair.now = {pose.position + Vec3(0, 0, kMoved), pose.orientation * Quat(turned)};
        collide_solid({lumps.shapes, lumps.of[0][0], lumps.of[1][0], pose, kReach}, pair.patches);
    }
    return known;
}

void move_touches(benchmark::State& state, const std::string& way, bool apart)
{
    const Lumps& lumps = lumps_by(way);
    const std::vector<Known> known = make_known(lumps, apart);
    const double radius_a = outer_radius(lumps.shapes, lumps.of[0][0]);
    const double radius_b = outer_radius(lumps.shapes, lumps.of[1][0]);
    std::size_t manifolds = 0, points = 0;
    for ([[maybe_unused]] auto iteration : state) {
        manifolds = points = 0;
        for (const Known& pair : known) {
            benchmark::DoNotOptimize(
                furthest_moved_near(pair.then, pair.now, radius_a + kReach, radius_b));
            CachedManifold<double> found{{}, pair.then, kReach};
            LocalManifold<double> moved;
            for (const PartManifold& patch : pair.patches) {
                found.manifold = patch.manifold;
                move_manifold(found, pair.now, kReach, moved);
                manifolds += moved.count > 0 ? 1 : 0;
                points += static_cast<std::size_t>(moved.count);
            }
        }
        benchmark::DoNotOptimize(points);
    }
    tell(state, manifolds, points);
}

// Hulls of the two whose boxes are within the margin of one another: what the broad phase hands on.
struct HullPairPlace {
    ShapeRef a, b;
    PoseT<float> b_in_a;
    PairCache cache;
};

std::vector<HullPairPlace> hull_pairs(const Lumps& lumps, bool apart)
{
    std::vector<HullPairPlace> pairs;
    for (const Pose& pose : poses_of(apart))
        for (const ShapeRef a : lumps.of[0])
            for (const ShapeRef b : lumps.of[1]) {
                Box3 box = shape_bounds(lumps.shapes, a, Pose{});
                box.lower.array() -= kReach;
                box.upper.array() += kReach;
                if (box.overlaps(shape_bounds(lumps.shapes, b, pose)))
                    pairs.push_back(
                        {a, b, {pose.position.cast<float>(), pose.orientation.cast<float>()}, {}});
            }
    return pairs;
}

void collide_parts(benchmark::State& state, bool apart, bool warm)
{
    const Lumps& lumps = lumps_by("parts");
    std::vector<HullPairPlace> pairs = hull_pairs(lumps, apart);
    LocalManifold<float> found;
    std::size_t manifolds = 0, points = 0;
    const auto collide_all = [&] {
        manifolds = points = 0;
        for (HullPairPlace& pair : pairs) {
            if (!warm) pair.cache = {};
            collide<float>({lumps.shapes, pair.a, pair.b, pair.b_in_a, static_cast<float>(kReach)},
                           pair.cache, found);
            manifolds += found.count > 0 ? 1 : 0;
            points += static_cast<std::size_t>(found.count);
        }
    };
    collide_all();
    for ([[maybe_unused]] auto iteration : state) {
        collide_all();
        benchmark::DoNotOptimize(points);
    }
    tell(state, manifolds, points);
    state.counters["hull_pairs"] = static_cast<double>(pairs.size()) / static_cast<double>(kPairs);
}

const Mesh& mesh_of_many(std::uint32_t triangles)
{
    static std::map<std::uint32_t, Mesh> made;
    Mesh& mesh = made[triangles];
    if (mesh.triangles.empty()) {
        TriangleSoup soup = lump(triangles, 1);
        mesh = repair(soup.vertices, std::move(soup.triangles)).mesh;
    }
    return mesh;
}

void make_healthy(benchmark::State& state, std::uint32_t triangles)
{
    const TriangleSoup soup = lump(triangles, 1);
    for ([[maybe_unused]] auto iteration : state)
        benchmark::DoNotOptimize(repair(soup.vertices, soup.triangles));
}

void make_parts(benchmark::State& state, std::uint32_t triangles)
{
    const Mesh& mesh = mesh_of_many(triangles);
    std::size_t parts = 0;
    for ([[maybe_unused]] auto iteration : state) parts = split_into_parts(mesh, {}).hulls.size();
    state.counters["parts"] = static_cast<double>(parts);
}

void make_spheres(benchmark::State& state, std::uint32_t triangles)
{
    const Mesh& mesh = mesh_of_many(triangles);
    std::size_t spheres = 0;
    for ([[maybe_unused]] auto iteration : state)
        spheres = build_sphere_tree(mesh).levels.back().nodes.size();
    state.counters["spheres"] = static_cast<double>(spheres);
}

void make_layers(benchmark::State& state, std::uint32_t triangles)
{
    Solid solid;
    solid.representation = SolidRepresentation::depth_image;
    solid.mesh = mesh_of_many(triangles);
    solid.rays = kAutoRays;
    for ([[maybe_unused]] auto iteration : state) benchmark::DoNotOptimize(layers_of(solid));
}

// `read` is called with the mesh and the folder: once to fill it, and then timed.
template <class Read>
void read_back(benchmark::State& state, std::uint32_t triangles, const Read& read)
{
    const auto folder = std::filesystem::temp_directory_path() / "throng_solids_perf";
    const Mesh& mesh = mesh_of_many(triangles);
    read(mesh, folder);
    for ([[maybe_unused]] auto iteration : state) benchmark::DoNotOptimize(read(mesh, folder));
    std::filesystem::remove_all(folder);
}

void read_parts(benchmark::State& state, std::uint32_t triangles)
{
    read_back(state, triangles, [](const Mesh& mesh, const std::filesystem::path& folder) {
        return cached_parts(mesh, {}, folder);
    });
}

void read_spheres(benchmark::State& state, std::uint32_t triangles)
{
    read_back(state, triangles, [](const Mesh& mesh, const std::filesystem::path& folder) {
        return cached_spheres(mesh, {}, folder);
    });
}

void register_pairs(bool apart)
{
    const std::string pair_case = apart ? "apart/" : "near/";
    const auto add = [](const std::string& name, auto&&... all) {
        benchmark::RegisterBenchmark(name.c_str(), all...)->Unit(benchmark::kMicrosecond);
    };
    for (const std::string way : {"voxels", "spheres", "depth_image"}) {
        add("pair/" + way + "/" + pair_case + "cold", find_touches, way, apart);
        add("pair/" + way + "/" + pair_case + "warm", move_touches, way, apart);
    }
    add("pair/parts/" + pair_case + "cold", collide_parts, apart, false);
    add("pair/parts/" + pair_case + "warm", collide_parts, apart, true);
}

void register_makers(std::uint32_t triangles)
{
    const std::string size = "/" + std::to_string(triangles);
    const auto add = [&](const char* name, auto function, int iterations) {
        auto* const made = benchmark::RegisterBenchmark((name + size).c_str(), function, triangles);
        made->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
        if (iterations > 0) made->Iterations(iterations);
    };
    // Seconds each: once will do.
    add("mend", make_healthy, 0);
    add("parts/cold", make_parts, 1);
    add("parts/cached", read_parts, 0);
    add("spheres/cold", make_spheres, 1);
    add("spheres/cached", read_spheres, 0);
    add("layers", make_layers, 0);
}

}  // namespace

void register_benchmarks()
{
    for (const bool apart : {false, true}) register_pairs(apart);
    for (const std::uint32_t triangles : {kPairTriangles, kManyTriangles})
        register_makers(triangles);
}

}  // namespace throng::perf
