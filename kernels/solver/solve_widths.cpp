// The widths that the solver's kernels were compiled for.
#include "kernels/simd/lane_width.hpp"
#include "kernels/solver/solve_kernels.hpp"

namespace throng {

namespace scalar {
extern const SolveKernels<float> kSolveFloat;
extern const SolveKernels<double> kSolveDouble;
}  // namespace scalar
namespace avx2 {
extern const SolveKernels<float> kSolveFloat;
extern const SolveKernels<double> kSolveDouble;
}  // namespace avx2
namespace avx512 {
extern const SolveKernels<float> kSolveFloat;
extern const SolveKernels<double> kSolveDouble;
}  // namespace avx512

template <>
const SolveKernels<float>* solve_kernels_of<float>(const char* width)
{
    return of_width(width, &scalar::kSolveFloat, &avx2::kSolveFloat, &avx512::kSolveFloat);
}

template <>
const SolveKernels<double>* solve_kernels_of<double>(const char* width)
{
    return of_width(width, &scalar::kSolveDouble, &avx2::kSolveDouble, &avx512::kSolveDouble);
}

template <class Real>
const SolveKernels<Real>& solve_kernels()
{
    static const SolveKernels<Real>& chosen = *solve_kernels_of<Real>(lane_width());
    return chosen;
}

template const SolveKernels<float>& solve_kernels<float>();
template const SolveKernels<double>& solve_kernels<double>();

}  // namespace throng
