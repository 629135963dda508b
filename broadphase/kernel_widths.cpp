// The widths that the wide kernels of this folder were compiled for.
#include "broadphase/active_bounds.hpp"
#include "kernels/simd/lane_width.hpp"

namespace throng {

THRONG_WIDTHS(ActiveBoundsKernel,
              kUpdateActiveBounds,
              active_bounds_kernel_of,
              active_bounds_kernel)

}  // namespace throng
