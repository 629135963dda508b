#include "cooking/fields/field_values.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "kernels/parallel/blocks.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

constexpr int kCells = VoxelBricks::kCells, kSide = VoxelBricks::kSide;
constexpr std::size_t kBlockValues = 512;  // 8^3
constexpr std::size_t kGrain = 256;        // values: some hundred microseconds
// What neighbors tell is never a quarter of a voxel too much where they have been searched for.
constexpr double kTriedVoxels = kSearchedVoxels + 0.25;

enum class State : std::uint8_t { unknown, waiting, known };

struct Place {
    std::array<std::int32_t, 3> at;
    std::size_t value_index;
};

// The values of a grid in blocks of 8^3, made as they are needed: value, nearest triangle, state.
class Blocks {
public:
    explicit Blocks(const VoxelBricks& laid) : laid_(laid)
    {
        // One more along each axis than there are bricks, for the last layer of values.
        for (std::size_t k = 0; k < 3; ++k) count_[k] = laid.bricks[k] + 1;
        block_of_.assign(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1])
                             * static_cast<std::size_t>(count_[2]),
                         -1);
    }

    bool holds(const std::array<std::int32_t, 3>& at) const
    {
        for (std::size_t k = 0; k < 3; ++k)
            if (at[k] < 0 || at[k] > laid_.bricks[k] * kCells) return false;
        return true;
    }
    std::int32_t block(int x, int y, int z) const { return block_of_[row(x, y, z)]; }
    // The slot of a place on the grid, or -1 where there is none yet.
    std::ptrdiff_t find(const std::array<std::int32_t, 3>& at) const
    {
        const std::int32_t block = block_of_[row(at[0] >> 3, at[1] >> 3, at[2] >> 3)];
        if (block < 0) return -1;
        return static_cast<std::ptrdiff_t>(static_cast<std::size_t>(block) * kBlockValues
                                           + within(at));
    }
    std::size_t make(const std::array<std::int32_t, 3>& at)
    {
        std::int32_t& block = block_of_[row(at[0] >> 3, at[1] >> 3, at[2] >> 3)];
        if (block < 0) {
            block = static_cast<std::int32_t>(values.size() / kBlockValues);
            values.resize(values.size() + kBlockValues, static_cast<float>(laid_.band));
            triangles.resize(values.size(), 0);
            states.resize(values.size(), State::unknown);
        }
        return static_cast<std::size_t>(block) * kBlockValues + within(at);
    }
    Vec3 position(const std::array<std::int32_t, 3>& at) const
    {
        return laid_.origin + laid_.voxel * Vec3(at[0], at[1], at[2]);
    }

    std::vector<float> values;
    std::vector<std::uint32_t> triangles;
    std::vector<State> states;

private:
    static std::size_t within(const std::array<std::int32_t, 3>& at)
    {
        return static_cast<std::size_t>(((at[2] & 7) * kCells + (at[1] & 7)) * kCells
                                        + (at[0] & 7));
    }
    std::size_t row(int x, int y, int z) const
    {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1])
                + static_cast<std::size_t>(y))
            * static_cast<std::size_t>(count_[0])
            + static_cast<std::size_t>(x);
    }

    const VoxelBricks& laid_;
    std::array<std::int32_t, 3> count_{};
    std::vector<std::int32_t> block_of_;
};

double to_triangle(const Mesh& mesh, std::uint32_t triangle, const Vec3& point)
{
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Vec3 nearest =
        closest_on_triangle<double>(point, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])
            .point;
    return (nearest - point).norm();
}

class Filler {
public:
    Filler(const Mesh& mesh, const VoxelBricks& laid) : mesh_(mesh), laid_(laid), blocks_(laid) { }

    void plant(std::span<const FieldSeed> seeds, SeedRule rule)
    {
        for (const FieldSeed& seed : seeds) {
            THRONG_CHECK(blocks_.holds(seed.at), "a seed lies on the grid");
            layer_.push_back({seed.at, blocks_.make(seed.at)});
        }
        for_each_block(seeds.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i) settle(seeds[i], layer_[i].value_index, rule);
        });
    }

    // Layer by layer: whatever has a neighbor that is known, until all is known that is wanted.
    void spread(SeedRule rule)
    {
        while (!layer_.empty()) {
            const std::vector<Place> next = next_layer(rule);
            for_each_block(next.size(), kGrain,
                           [&](std::size_t begin, std::size_t end, std::size_t) {
                               for (std::size_t i = begin; i < end; ++i) spread_to(next[i]);
                           });
            for (const Place& place : next) blocks_.states[place.value_index] = State::known;
            layer_ = next;
        }
    }

    VoxelBricks bake() const
    {
        VoxelBricks baked = laid_;
        const auto& [nx, ny, nz] = laid_.bricks;
        baked.brick_of.assign(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny)
                                  * static_cast<std::size_t>(nz),
                              -1);
        std::vector<float> copied(VoxelBricks::kValues);
        std::size_t row = 0;
        for (int z = 0; z < nz; ++z)
            for (int y = 0; y < ny; ++y)
                for (int x = 0; x < nx; ++x, ++row) {
                    if (!copy({x, y, z}, copied)) continue;
                    baked.brick_of[row] =
                        static_cast<std::int32_t>(baked.values.size() / VoxelBricks::kValues);
                    baked.values.insert(baked.values.end(), copied.begin(), copied.end());
                }
        return baked;
    }

private:
    void settle(const FieldSeed& seed, std::size_t value_index, SeedRule rule)
    {
        const Vec3 at = blocks_.position(seed.at);
        // A guess has been rounded, and may be of another's nearest triangle.
        const double limit = std::abs(static_cast<double>(seed.guess)) + 0.01 * laid_.voxel;
        MeshPoint nearest = nearest_on_mesh(mesh_, at, rule == SeedRule::value ? kFar : limit);
        if (!(nearest.distance < kFar)) nearest = nearest_on_mesh(mesh_, at);
        auto value = static_cast<double>(seed.guess);
        if (rule == SeedRule::distance) value = signed_distance(mesh_, at, nearest);
        if (rule == SeedRule::sign)
            value = std::signbit(seed.guess) ? -nearest.distance : nearest.distance;
        if (rule == SeedRule::sheet) value = nearest.distance;
        blocks_.values[value_index] = static_cast<float>(value);
        blocks_.triangles[value_index] = nearest.triangle;
        blocks_.states[value_index] = State::known;
    }

    // What is unknown next to the last layer, on the side of whoever comes upon it first. Values
    // of opposite sign next to each other are seeds, both of them.
    std::vector<Place> next_layer(SeedRule rule)
    {
        std::vector<Place> next;
        const auto last = static_cast<float>(laid_.band + 0.5 * laid_.voxel);
        for (const Place& from : layer_) {
            const float value = blocks_.values[from.value_index];
            const bool inside = std::signbit(value);
            if (!inside && (value > last || rule == SeedRule::value)) continue;
            for (std::size_t k = 0; k < 6; ++k) {
                std::array<std::int32_t, 3> at = from.at;
                at[k / 2] += k % 2 == 0 ? 1 : -1;
                if (!blocks_.holds(at)) continue;
                const std::size_t value_index = blocks_.make(at);
                if (blocks_.states[value_index] != State::unknown) continue;
                blocks_.states[value_index] = State::waiting;
                blocks_.values[value_index] = inside ? -0.0F : 0.0F;
                next.push_back({at, value_index});
            }
        }
        return next;
    }

    // The nearest of its neighbors' triangles, and where that will not do, the nearest of all.
    void spread_to(const Place& place)
    {
        const Vec3 at = blocks_.position(place.at);
        const bool inside = std::signbit(blocks_.values[place.value_index]);
        auto [distance, triangle] = nearest_of_neighbors(place, at);
        if (!inside || distance <= kTriedVoxels * laid_.voxel) {
            const double limit = distance * (1 + 1e-9);
            const MeshPoint found =
                nearest_on_mesh(mesh_, at, inside ? limit : std::min(limit, laid_.band));
            if (found.distance < kFar) {
                distance = found.distance;
                triangle = found.triangle;
            }
        }
        blocks_.values[place.value_index] = static_cast<float>(inside ? -distance : distance);
        blocks_.triangles[place.value_index] = triangle;
    }

    // Where the value of a place stands, or -1 where it is not known.
    std::ptrdiff_t find_known(const std::array<std::int32_t, 3>& at) const
    {
        const std::ptrdiff_t value_index = blocks_.holds(at) ? blocks_.find(at) : -1;
        if (value_index < 0) return -1;
        return blocks_.states[static_cast<std::size_t>(value_index)] == State::known ? value_index
                                                                                     : -1;
    }

    std::pair<double, std::uint32_t> nearest_of_neighbors(const Place& place, const Vec3& at) const
    {
        std::array<std::uint32_t, 26> seen;
        std::size_t count = 0;
        std::pair<double, std::uint32_t> best{kFar, 0};
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    const std::array<std::int32_t, 3> beside{place.at[0] + x, place.at[1] + y,
                                                             place.at[2] + z};
                    const std::ptrdiff_t value_index = find_known(beside);
                    if (value_index < 0) continue;
                    const std::uint32_t triangle =
                        blocks_.triangles[static_cast<std::size_t>(value_index)];
                    const auto last = seen.begin() + static_cast<std::ptrdiff_t>(count);
                    if (std::find(seen.begin(), last, triangle) != last) continue;
                    seen[count++] = triangle;
                    const double distance = to_triangle(mesh_, triangle, at);
                    if (distance < best.first) best = {distance, triangle};
                }
        return best;
    }

    // The 9^3 values of a brick; false where all of them are far outside.
    bool copy(const std::array<std::int32_t, 3>& brick, std::vector<float>& copied) const
    {
        const auto band = static_cast<float>(laid_.band);
        bool any = false;
        for (int corner = 0; corner < 8 && !any; ++corner)
            any = blocks_.block(brick[0] + (corner & 1), brick[1] + (corner >> 1 & 1),
                                brick[2] + (corner >> 2))
                >= 0;
        if (!any) return false;
        bool near = false;
        std::size_t i = 0;
        for (int z = 0; z < kSide; ++z)
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x, ++i) {
                    const std::ptrdiff_t value_index = blocks_.find(
                        {brick[0] * kCells + x, brick[1] * kCells + y, brick[2] * kCells + z});
                    const float value = value_index < 0
                        ? band
                        : blocks_.values[static_cast<std::size_t>(value_index)];
                    copied[i] = std::min(value, band);
                    near |= value < band;
                }
        return near;
    }

    static constexpr double kFar = std::numeric_limits<double>::infinity();

    const Mesh& mesh_;
    const VoxelBricks& laid_;
    Blocks blocks_;
    std::vector<Place> layer_;
};

// Of one brick, from each value to the next along each axis.
float separation_within(const float* values)
{
    constexpr std::array<std::size_t, 3> kSteps{1, kSide, kSide * kSide};
    float widest = 0;
    std::size_t i = 0;
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x, ++i) {
                const std::array<int, 3> at{x, y, z};
                for (std::size_t k = 0; k < 3; ++k) {
                    if (at[k] + 1 == kSide) continue;
                    const float a = values[i], b = values[i + kSteps[k]];
                    if ((a < 0) != (b < 0)) widest = std::max(widest, std::abs(a - b));
                }
            }
    return widest;
}

// Whether the inside reaches a face of the grid that the brick has.
bool reaches_end(const VoxelBricks& bricks, const std::array<int, 3>& brick, const float* values)
{
    bool reaches = false;
    std::size_t i = 0;
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x, ++i) {
                const std::array<int, 3> at{x, y, z};
                for (std::size_t k = 0; k < 3; ++k) {
                    const int place = brick[k] * kCells + at[k];
                    reaches |= values[i] < 0 && (place == 0 || place == bricks.bricks[k] * kCells);
                }
            }
    return reaches;
}

}  // namespace

VoxelBricks fill_bricks(const Mesh& mesh,
                        const VoxelBricks& laid,
                        std::span<const FieldSeed> seeds,
                        SeedRule rule)
{
    Filler filler(mesh, laid);
    filler.plant(seeds, rule);
    filler.spread(rule);
    return filler.bake();
}

std::size_t count_inside(const VoxelBricks& bricks)
{
    return static_cast<std::size_t>(std::count_if(bricks.values.begin(), bricks.values.end(),
                                                  [](float value) { return value < 0; }));
}

double widest_separation(const VoxelBricks& bricks)
{
    float widest = 0;
    std::size_t row = 0;
    for (int z = 0; z < bricks.bricks[2]; ++z)
        for (int y = 0; y < bricks.bricks[1]; ++y)
            for (int x = 0; x < bricks.bricks[0]; ++x, ++row) {
                if (bricks.brick_of[row] < 0) continue;
                const float* const values = bricks.values.data()
                    + static_cast<std::size_t>(bricks.brick_of[row]) * VoxelBricks::kValues;
                if (reaches_end(bricks, {x, y, z}, values))
                    return std::numeric_limits<double>::infinity();
                widest = std::max(widest, separation_within(values));
            }
    return static_cast<double>(widest);
}

}  // namespace throng
