// Many points in bricks: the wide kernel where it can, one after another where it cannot.
#include "kernels/geometry/voxel_kernels.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/voxel_bricks.hpp"

#include <limits>

namespace throng {

BrickView view_of(const VoxelBricks& bricks)
{
    BrickView view{};
    for (int k = 0; k < 3; ++k) {
        view.origin[k] = static_cast<float>(bricks.origin[k]);
        view.bricks[k] = bricks.bricks[static_cast<std::size_t>(k)];
    }
    view.inverse = static_cast<float>(1 / bricks.voxel);
    view.band = static_cast<float>(bricks.band);
    view.brick_of = bricks.brick_of.data();
    view.values = bricks.values.data();
    return view;
}

void sample_many(const VoxelBricks& bricks, const SampleSpans& samples)
{
    const auto& [x, y, z, distance, gx, gy, gz] = samples;
    const std::size_t count = x.size();
    THRONG_CHECK(y.size() == count && z.size() == count && distance.size() == count
                     && gx.size() == count && gy.size() == count && gz.size() == count,
                 "seven spans of one length");
    // The kernel counts values in 32 bits, and reads one even where none is wanted.
    if (bricks.empty() || bricks.values.size() > std::numeric_limits<std::int32_t>::max()) {
        for (std::size_t i = 0; i < count; ++i) {
            const auto at = sample_bricks<float>(bricks, {x[i], y[i], z[i]});
            distance[i] = at.distance;
            gx[i] = at.gradient.x();
            gy[i] = at.gradient.y();
            gz[i] = at.gradient.z();
        }
        return;
    }
    sample_kernel()(
        view_of(bricks),
        {x.data(), y.data(), z.data(), distance.data(), gx.data(), gy.data(), gz.data()}, count);
}

}  // namespace throng
