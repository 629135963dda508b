// The widths that mover_bounds_lanes.cpp was compiled for.
#include "broadphase/mover_bounds.hpp"
#include "kernels/simd/lane_width.hpp"

namespace throng {

namespace scalar {
extern const MoverKernel kBoundMovers;
}
namespace avx2 {
extern const MoverKernel kBoundMovers;
}
namespace avx512 {
extern const MoverKernel kBoundMovers;
}

MoverKernel mover_kernel_of(const char* width)
{
    return of_width(width, scalar::kBoundMovers, avx2::kBoundMovers, avx512::kBoundMovers);
}

MoverKernel mover_kernel()
{
    static const MoverKernel chosen = mover_kernel_of(lane_width());
    return chosen;
}

}  // namespace throng
