#include "kernels/dynamics/travels.hpp"

#include "kernels/check.hpp"
#include "kernels/math/rotation.hpp"
#include "kernels/parallel/blocks.hpp"

#include <algorithm>

namespace throng {
namespace {

constexpr std::size_t kGrain = 512;  // colliders a block: some ten microseconds

}  // namespace

void follow_colliders(std::span<const std::uint32_t> some,
                      std::span<const Pose> placed,
                      std::span<const double> outer_radius,
                      std::span<const double> speculative_margin,
                      Travels& travels)
{
    const std::size_t count = placed.size(), known = std::min(travels.placed.size(), count);
    THRONG_CHECK(outer_radius.size() == count && speculative_margin.size() == count,
                 "each collider needs a radius and a reach");
    travels.placed.resize(count);
    travels.traveled.resize(count, 0.0);
    travels.approach.resize(count, 0.0);
    std::copy(placed.begin() + static_cast<std::ptrdiff_t>(known), placed.end(),
              travels.placed.begin() + static_cast<std::ptrdiff_t>(known));
    for_each_block(some.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = some[k];
            const Pose &now = placed[i], &last = travels.placed[i];
            const Vec3 shift = now.position - last.position;
            const Quat turn = now.orientation * last.orientation.conjugate();
            if (!shift.isZero(0) || !turn.vec().isZero(0)) {
                travels.traveled[i] += furthest_moved(shift, turn, outer_radius[i]);
                travels.placed[i] = now;
            }
            travels.approach[i] = travels.traveled[i] + speculative_margin[i];
        }
    });
}

double separation_between(const NearBox& a, const NearBox& b)
{
    float most = 0;
    for (int axis = 0; axis < 3; ++axis)
        most = std::max({most, a.lower[axis] - b.upper[axis], b.lower[axis] - a.upper[axis]});
    return double{most};
}

}  // namespace throng
