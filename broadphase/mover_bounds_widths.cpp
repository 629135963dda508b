// The widths that mover_bounds_lanes.cpp was compiled for.
#include "broadphase/mover_bounds.hpp"
#include "kernels/math/lane_width.hpp"

#include <cstring>

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
    if (!machine_has_lanes(width)) return nullptr;
    if (std::strcmp(width, "avx512") == 0) return avx512::kBoundMovers;
    if (std::strcmp(width, "avx2") == 0) return avx2::kBoundMovers;
    return scalar::kBoundMovers;
}

MoverKernel mover_kernel()
{
    static const MoverKernel chosen = mover_kernel_of(lane_width());
    return chosen;
}

}  // namespace throng
