#include "kernels/geometry/voxel_bricks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace throng {
namespace {

constexpr int kCells = VoxelBricks::kCells, kSide = VoxelBricks::kSide;

std::size_t value_at(int x, int y, int z)
{
    return static_cast<std::size_t>((z * kSide + y) * kSide + x);
}

// The values of the brick whose first one is `first`, as the numbers of the grid go.
void bake_values(const VoxelBricks& bricks,
                 const std::array<int, 3>& first,
                 const std::function<double(const Vec3&)>& distance,
                 std::vector<float>& values)
{
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const Vec3 at =
                    bricks.origin + bricks.voxel * Vec3(first[0] + x, first[1] + y, first[2] + z);
                values[value_at(x, y, z)] = static_cast<float>(std::min(distance(at), bricks.band));
            }
}

}  // namespace

VoxelBricks lay_bricks(const Box3& box, double voxel, double band)
{
    VoxelBricks bricks;
    bricks.voxel = voxel;
    bricks.band = band;
    bricks.origin = box.lower - Vec3::Constant(band);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<Eigen::Index>(axis);
        const double length = box.upper[k] + band - bricks.origin[k];
        bricks.bricks[axis] = static_cast<std::int32_t>(std::ceil(length / (kCells * voxel)));
    }
    return bricks;
}

VoxelBricks bake_bricks(const Box3& box,
                        double voxel,
                        double band,
                        const std::function<double(const Vec3&)>& distance)
{
    VoxelBricks bricks = lay_bricks(box, voxel, band);
    std::vector<float> values(VoxelBricks::kValues);
    for (int bz = 0; bz < bricks.bricks[2]; ++bz)
        for (int by = 0; by < bricks.bricks[1]; ++by)
            for (int bx = 0; bx < bricks.bricks[0]; ++bx) {
                bake_values(bricks, {bx * kCells, by * kCells, bz * kCells}, distance, values);
                const bool far =
                    *std::min_element(values.begin(), values.end()) >= static_cast<float>(band);
                const std::size_t stored = bricks.values.size() / VoxelBricks::kValues;
                bricks.brick_of.push_back(far ? -1 : static_cast<std::int32_t>(stored));
                if (!far) bricks.values.insert(bricks.values.end(), values.begin(), values.end());
            }
    return bricks;
}

template <class Real>
FieldSample<Real> sample_bricks(const VoxelBricks& bricks, const Vec3T<Real>& point)
{
    const FieldSample<Real> far{static_cast<Real>(bricks.band), Vec3T<Real>::Zero()};
    const Vec3T<Real> at =
        (point - bricks.origin.cast<Real>()) * static_cast<Real>(1 / bricks.voxel);
    int cell[3];
    Real part[3];
    for (int k = 0; k < 3; ++k) {
        const auto last = static_cast<Real>(bricks.bricks[static_cast<std::size_t>(k)] * kCells);
        if (!(at[k] >= 0 && at[k] <= last)) return far;
        cell[k] = static_cast<int>(std::min(at[k], last - 1));
        part[k] = at[k] - static_cast<Real>(cell[k]);
    }
    const int row = (cell[2] / kCells) * bricks.bricks[1] + cell[1] / kCells;
    const auto brick = static_cast<std::size_t>(row * bricks.bricks[0] + cell[0] / kCells);
    const std::int32_t stored = bricks.brick_of[brick];
    if (stored < 0) return far;
    const float* const corner = bricks.values.data()
        + static_cast<std::size_t>(stored) * VoxelBricks::kValues
        + value_at(cell[0] % kCells, cell[1] % kCells, cell[2] % kCells);
    const auto value = [&](int x, int y, int z) {
        return static_cast<Real>(corner[value_at(x, y, z)]);
    };
    const auto mix = [](Real a, Real b, Real t) { return a + (b - a) * t; };
    // Along x for each of the four edges, then along y, then along z; the slopes likewise.
    Real on_x[2][2], slope_x[2][2];
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 2; ++y) {
            const Real low = value(0, y, z), high = value(1, y, z);
            on_x[z][y] = mix(low, high, part[0]);
            slope_x[z][y] = high - low;
        }
    const Real y0 = mix(on_x[0][0], on_x[0][1], part[1]);
    const Real y1 = mix(on_x[1][0], on_x[1][1], part[1]);
    const Vec3T<Real> slope(mix(mix(slope_x[0][0], slope_x[0][1], part[1]),
                                mix(slope_x[1][0], slope_x[1][1], part[1]), part[2]),
                            mix(on_x[0][1] - on_x[0][0], on_x[1][1] - on_x[1][0], part[2]),
                            y1 - y0);
    return {mix(y0, y1, part[2]), slope * static_cast<Real>(1 / bricks.voxel)};
}

template FieldSample<float> sample_bricks<float>(const VoxelBricks&, const Vec3T<float>&);
template FieldSample<double> sample_bricks<double>(const VoxelBricks&, const Vec3T<double>&);

}  // namespace throng
