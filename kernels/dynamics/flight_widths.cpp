// The widths that flight_lanes.cpp was compiled for.
#include "kernels/dynamics/flight.hpp"
#include "kernels/simd/lane_width.hpp"

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
    return of_width(width, scalar::kFly, avx2::kFly, avx512::kFly);
}

FlyKernel fly_kernel()
{
    static const FlyKernel chosen = fly_kernel_of(lane_width());
    return chosen;
}

}  // namespace throng
