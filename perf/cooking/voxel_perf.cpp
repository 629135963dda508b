// Voxel: what a level set takes to make and to read back, and a sample of it.
//
// A bumpy ball of 70,000 triangles. `patch`: 256 points side by side within 1.4 voxels of the
// surface at a time, as in a contact; `random`: anywhere about it. `tree`: the same in OpenVDB's
// tree.
#include "cooking/fields/field_cache.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "kernels/geometry/voxel_bricks.hpp"
#include "kernels/geometry/voxel_kernels.hpp"
#include "perf/cooking/tree_samples.hpp"
#include "perf/support.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "scene/catalog/random.hpp"

#include <cmath>
#include <filesystem>
#include <map>
#include <string>

namespace throng::perf {
namespace {

constexpr std::size_t kPoints = 1 << 18, kPatch = 256;
constexpr double kNear = 1.4;  // voxels

const Mesh& bumpy_ball()
{
    static const Mesh mesh = [] {
        TriangleSoup soup = ball_mesh(1, 264, 134);
        for (Vec3& at : soup.vertices)
            at *=
                1 + 0.05 * std::sin(9 * at.x() + 2) * std::sin(11 * at.y()) * std::cos(10 * at.z());
        MeshResult made = build_mesh(soup.vertices, soup.triangles);
        find_vertex_normals(made.mesh);
        return made.mesh;
    }();
    return mesh;
}

FieldSettings across(int voxels)
{
    FieldSettings settings;
    const Mesh::Node& root = bumpy_ball().tree.front();
    settings.voxel = (root.upper - root.lower).maxCoeff() / voxels;
    return settings;
}

const VoxelBricks& field_of(int voxels)
{
    static std::map<int, VoxelBricks> made;
    VoxelBricks& bricks = made[voxels];
    if (bricks.empty()) bricks = build_field(bumpy_ball(), across(voxels)).bricks;
    return bricks;
}

void make_cold(benchmark::State& state, int voxels)
{
    for ([[maybe_unused]] auto iteration : state)
        benchmark::DoNotOptimize(build_field(bumpy_ball(), across(voxels)));
    state.counters["MB"] = static_cast<double>(4 * field_of(voxels).values.size()) * 1e-6;
}

void make_cached(benchmark::State& state, int voxels)
{
    const auto folder = std::filesystem::temp_directory_path() / "throng_voxel_perf";
    cached_field(bumpy_ball(), across(voxels), folder);
    for ([[maybe_unused]] auto iteration : state)
        benchmark::DoNotOptimize(cached_field(bumpy_ball(), across(voxels), folder));
    std::filesystem::remove_all(folder);
}

struct Points {
    std::vector<float> x, y, z;
};

// Patches lie on a grid of 16 by 16 points half a voxel apart about a place of the surface.
Points make_points(const VoxelBricks& bricks, bool patches)
{
    Random random(1);
    const Mesh& mesh = bumpy_ball();
    const double h = bricks.voxel;
    Points points;
    for (std::size_t i = 0; i < kPoints;) {
        const auto t = random.below(static_cast<std::uint32_t>(mesh.triangles.size()));
        const Vec3 middle = mesh.vertices[mesh.triangles[t][0]];
        const Vec3 along = (mesh.vertices[mesh.triangles[t][1]] - middle).normalized();
        const Vec3 beside = mesh.normals[t].cross(along);
        for (std::size_t k = 0; k < (patches ? kPatch : 1); ++k, ++i) {
            const Vec3 at = middle + h * 0.5 * (static_cast<double>(k % 16) - 8) * along
                + h * 0.5 * (static_cast<double>(k / 16) - 8) * beside
                + random.uniform(-kNear, kNear) * h * mesh.normals[t];
            points.x.push_back(static_cast<float>(at.x()));
            points.y.push_back(static_cast<float>(at.y()));
            points.z.push_back(static_cast<float>(at.z()));
        }
    }
    return points;
}

// `sample_patch` is called with the arrays of a patch at a time.
template <class Sample>
void sample_all(benchmark::State& state, int voxels, bool patches, const Sample& sample_patch)
{
    const Points points = make_points(field_of(voxels), patches);
    std::vector<float> distance(kPatch), gx(kPatch), gy(kPatch), gz(kPatch);
    for ([[maybe_unused]] auto iteration : state)
        for (std::size_t i = 0; i < kPoints; i += kPatch) {
            sample_patch({points.x.data() + i, points.y.data() + i, points.z.data() + i,
                          distance.data(), gx.data(), gy.data(), gz.data()});
            benchmark::DoNotOptimize(distance.data());
            benchmark::ClobberMemory();
        }
    state.counters["a_sample"] = time_of_one(kPoints);
}

void sample(benchmark::State& state, int voxels, bool patches, const char* width)
{
    const SampleKernel* const kernel = sample_kernel_of(width);
    if (kernel == nullptr) return state.SkipWithError("this machine has not got that width");
    const BrickView view = view_of(field_of(voxels));
    sample_all(state, voxels, patches,
               [&](const SampleArrays& arrays) { (*kernel)(view, arrays, kPatch); });
}

void sample_tree(benchmark::State& state, int voxels, bool patches)
{
    const FieldTree tree(field_of(voxels));
    sample_all(state, voxels, patches,
               [&](const SampleArrays& arrays) { tree.sample(arrays, kPatch); });
}

}  // namespace

void register_benchmarks()
{
    for (const int voxels : {64, 128, 256}) {
        const std::string size = std::to_string(voxels);
        benchmark::RegisterBenchmark(("level_set/cold/" + size).c_str(), make_cold, voxels)
            ->Unit(benchmark::kMillisecond)
            ->MeasureProcessCPUTime()
            ->UseRealTime()
            ->Iterations(1);
        benchmark::RegisterBenchmark(("level_set/cached/" + size).c_str(), make_cached, voxels)
            ->Unit(benchmark::kMillisecond)
            ->MeasureProcessCPUTime()
            ->UseRealTime();
        for (const bool patches : {true, false}) {
            const std::string name =
                std::string("sample/") + (patches ? "patch/" : "random/") + size + "/";
            for (const char* width : {"scalar", "avx2", "avx512"})
                benchmark::RegisterBenchmark((name + width).c_str(), sample, voxels, patches, width)
                    ->Unit(benchmark::kMillisecond);
            benchmark::RegisterBenchmark((name + "tree").c_str(), sample_tree, voxels, patches)
                ->Unit(benchmark::kMillisecond);
        }
    }
}

}  // namespace throng::perf
