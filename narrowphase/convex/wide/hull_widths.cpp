// The widths that the hull kernels were compiled for.
#include "kernels/simd/lane_width.hpp"
#include "narrowphase/convex/wide/hull_kernels.hpp"

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
    return of_width(width, scalar::kMeetHulls, avx2::kMeetHulls, avx512::kMeetHulls);
}

HullKernel hull_kernel()
{
    static const HullKernel chosen = hull_kernel_of(lane_width());
    return chosen;
}

}  // namespace throng
