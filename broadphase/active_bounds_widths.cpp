// The widths that active_bounds_lanes.cpp was compiled for.
#include "broadphase/active_bounds.hpp"
#include "kernels/simd/lane_width.hpp"

namespace throng {

namespace scalar {
extern const ActiveBoundsKernel kUpdateActiveBounds;
}
namespace avx2 {
extern const ActiveBoundsKernel kUpdateActiveBounds;
}
namespace avx512 {
extern const ActiveBoundsKernel kUpdateActiveBounds;
}

ActiveBoundsKernel active_bounds_kernel_of(const char* width)
{
    return of_width(width, scalar::kUpdateActiveBounds, avx2::kUpdateActiveBounds,
                    avx512::kUpdateActiveBounds);
}

ActiveBoundsKernel active_bounds_kernel()
{
    static const ActiveBoundsKernel chosen = active_bounds_kernel_of(lane_width());
    return chosen;
}

}  // namespace throng
