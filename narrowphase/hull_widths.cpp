// The widths that the hull kernels were compiled for.
#include "kernels/math/lane_width.hpp"
#include "narrowphase/hull_kernels.hpp"

#include <cstring>

namespace throng {

namespace scalar {
extern const HullKernel kMeetHulls;
}
namespace avx2 {
extern const HullKernel kMeetHulls;
}
namespace avx512 {
extern const HullKernel kMeetHulls;
}

HullKernel hull_kernel_of(const char* width)
{
    if (!machine_has_lanes(width)) return nullptr;
    if (std::strcmp(width, "avx512") == 0) return avx512::kMeetHulls;
    if (std::strcmp(width, "avx2") == 0) return avx2::kMeetHulls;
    return scalar::kMeetHulls;
}

HullKernel hull_kernel()
{
    static const HullKernel chosen = hull_kernel_of(lane_width());
    return chosen;
}

}  // namespace throng
