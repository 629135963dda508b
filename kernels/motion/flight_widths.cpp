// The widths that flight_lanes.cpp was compiled for.
#include "kernels/math/lane_width.hpp"
#include "kernels/motion/flight.hpp"

#include <cstring>

namespace throng {

namespace scalar {
extern const FlyKernel kFly;
}
namespace avx2 {
extern const FlyKernel kFly;
}
namespace avx512 {
extern const FlyKernel kFly;
}

FlyKernel fly_kernel_of(const char* width)
{
    if (!machine_has_lanes(width)) return nullptr;
    if (std::strcmp(width, "avx512") == 0) return avx512::kFly;
    if (std::strcmp(width, "avx2") == 0) return avx2::kFly;
    return scalar::kFly;
}

FlyKernel fly_kernel()
{
    static const FlyKernel chosen = fly_kernel_of(lane_width());
    return chosen;
}

}  // namespace throng
