// The widths that the wide kernels of this folder were compiled for.
#include "kernels/simd/lane_width.hpp"
#include "narrowphase/convex/wide/box_kernels.hpp"
#include "narrowphase/convex/wide/hull_kernels.hpp"

namespace throng {

THRONG_WIDTHS(BoxKernels, kBoxes, box_kernels_of, box_kernels)
THRONG_WIDTHS(HullKernel, kMeetHulls, hull_kernel_of, hull_kernel)

}  // namespace throng
