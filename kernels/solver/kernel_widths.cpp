// The widths that the wide kernels of kernels/ were compiled for.
#include "kernels/dynamics/flight.hpp"
#include "kernels/geometry/voxel_kernels.hpp"
#include "kernels/simd/lane_width.hpp"
#include "kernels/solver/solve_kernels.hpp"

namespace throng {

THRONG_WIDTHS(FlyKernel, kFly, fly_kernel_of, fly_kernel)
THRONG_WIDTHS(SampleKernel, kSample, sample_kernel_of, sample_kernel)
THRONG_WIDTHS(
    SolveKernels<float>, kSolveFloat, solve_kernels_of<float>, solve_kernels<float>, template <>)
THRONG_WIDTHS(
    SolveKernels<double>, kSolveDouble, solve_kernels_of<double>, solve_kernels<double>, template <>
)

}  // namespace throng
