// Voxel bricks at many points, written once over the width of the machine's registers; its plain
// twin is sample_bricks(), whose arithmetic this is, operation by operation.
#include "kernels/geometry/voxel_kernels.hpp"
#include "kernels/simd/lanes.hpp"

namespace throng::THRONG_LANES {

namespace {

using L = Lanes<float>;
constexpr int kWidth = L::kWidth;
using I = Wide<std::int32_t, kWidth>;

// As VoxelBricks has them: values along an edge of a brick, and in all of it.
constexpr std::int32_t kSide = 9, kValues = 729;

L mix(L a, L b, L t) { return a + (b - a) * t; }

// The cell that a place is in along one axis, and how far along it; the mask says whether it is in
// the grid at all. Places outside are given the first cell.
struct Along {
    I cell;
    L part;
};

auto in_grid(L at, std::int32_t bricks)
{
    const L last = static_cast<float>(bricks * 8);
    // Both false for what is not a number.
    return (at.v >= L(0.0F).v) & (at.v <= last.v);
}

template <class Mask>
Along along(L at, std::int32_t bricks, Mask inside)
{
    const L held = select(inside, at, L(0.0F));
    const I cell = truncated(min(held, L(static_cast<float>(bricks * 8 - 1))));
    return {cell, held - whole(cell)};
}

// The eight values about each lane's cell: trilinear, the slopes likewise.
struct Corners {
    L low[4], high[4];  // along x, at y0 z0, y1 z0, y0 z1, y1 z1
};

void sample_some(const BrickView& view, const SampleArrays& to, L x, L y, L z)
{
    const L inverse = view.inverse;
    const L at[3] = {(x - L(view.origin[0])) * inverse, (y - L(view.origin[1])) * inverse,
                     (z - L(view.origin[2])) * inverse};
    const auto inside = in_grid(at[0], view.bricks[0]) & in_grid(at[1], view.bricks[1])
        & in_grid(at[2], view.bricks[2]);
    const Along ax = along(at[0], view.bricks[0], inside);
    const Along ay = along(at[1], view.bricks[1], inside);
    const Along az = along(at[2], view.bricks[2], inside);

    const I row = (az.cell.v >> 3) * view.bricks[1] + (ay.cell.v >> 3);
    const I stored = gather(view.brick_of, I(row.v * view.bricks[0] + (ax.cell.v >> 3)));
    const auto known = inside & (stored.v >= 0);
    const I first = select(known, stored, I(I::V{}));
    const I corner =
        first.v * kValues + (((az.cell.v & 7) * kSide + (ay.cell.v & 7)) * kSide + (ax.cell.v & 7));
    Corners c;
    constexpr std::int32_t kOver[4] = {0, kSide, kSide * kSide, kSide * kSide + kSide};
    for (int k = 0; k < 4; ++k) gather_pair(view.values + kOver[k], corner, c.low[k], c.high[k]);

    L on_x[4], slope_x[4];
    for (int k = 0; k < 4; ++k) {
        on_x[k] = mix(c.low[k], c.high[k], ax.part);
        slope_x[k] = c.high[k] - c.low[k];
    }
    const L y0 = mix(on_x[0], on_x[1], ay.part), y1 = mix(on_x[2], on_x[3], ay.part);
    const L slope[3] = {
        mix(mix(slope_x[0], slope_x[1], ay.part), mix(slope_x[2], slope_x[3], ay.part), az.part),
        mix(on_x[1] - on_x[0], on_x[3] - on_x[2], az.part), y1 - y0};
    select(known, mix(y0, y1, az.part), L(view.band)).store(to.distance);
    select(known, slope[0] * inverse, L(0.0F)).store(to.gx);
    select(known, slope[1] * inverse, L(0.0F)).store(to.gy);
    select(known, slope[2] * inverse, L(0.0F)).store(to.gz);
}

// Clears the upper halves of the registers, which GCC 12 forgets here with 512 bits: else all plain
// arithmetic after this takes two to three times as long until somebody does.
struct LeavesWide {
#if THRONG_LANE_BYTES > 0
    ~LeavesWide() { _mm256_zeroupper(); }
#else
    ~LeavesWide() = default;
#endif
};

void sample(const BrickView& view, const SampleArrays& arrays, std::size_t count)
{
    [[maybe_unused]] const LeavesWide leaves_wide;
    std::size_t at = 0;
    for (; at + kWidth <= count; at += kWidth)
        sample_some(view,
                    {nullptr, nullptr, nullptr, arrays.distance + at, arrays.gx + at,
                     arrays.gy + at, arrays.gz + at},
                    L::load(arrays.x + at), L::load(arrays.y + at), L::load(arrays.z + at));
    if (at == count) return;

    // Idle lanes repeat the last point, and are not written.
    float in[3][kWidth], out[4][kWidth];
    for (std::size_t i = 0; i < kWidth; ++i) {
        const std::size_t from = at + i < count ? at + i : count - 1;
        in[0][i] = arrays.x[from];
        in[1][i] = arrays.y[from];
        in[2][i] = arrays.z[from];
    }
    sample_some(view, {nullptr, nullptr, nullptr, out[0], out[1], out[2], out[3]}, L::load(in[0]),
                L::load(in[1]), L::load(in[2]));
    for (std::size_t i = 0; at + i < count; ++i) {
        arrays.distance[at + i] = out[0][i];
        arrays.gx[at + i] = out[1][i];
        arrays.gy[at + i] = out[2][i];
        arrays.gz[at + i] = out[3][i];
    }
}

}  // namespace

extern const SampleKernel kSample;
const SampleKernel kSample = sample;

}  // namespace throng::THRONG_LANES
