// The widths that sweep.cpp was compiled for, and which of them this machine takes.
#include "kernels/solve/sweep.hpp"

#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

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

namespace {

const SolveKernels<float>* kernels(const char* width, float)
{
    if (std::strcmp(width, "avx512") == 0) return &avx512::kSolveFloat;
    if (std::strcmp(width, "avx2") == 0) return &avx2::kSolveFloat;
    return &scalar::kSolveFloat;
}
const SolveKernels<double>* kernels(const char* width, double)
{
    if (std::strcmp(width, "avx512") == 0) return &avx512::kSolveDouble;
    if (std::strcmp(width, "avx2") == 0) return &avx2::kSolveDouble;
    return &scalar::kSolveDouble;
}

bool machine_has(const char* width)
{
    if (std::strcmp(width, "scalar") == 0) return true;
    if (std::strcmp(width, "avx2") == 0) return __builtin_cpu_supports("avx2") != 0;
    if (std::strcmp(width, "avx512") == 0)
        return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0
            && __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512vl") != 0;
    return false;
}

const char* widest()
{
    for (const char* width : {"avx512", "avx2"})
        if (machine_has(width)) return width;
    return "scalar";
}

}  // namespace

template <class Real>
const SolveKernels<Real>* solve_kernels_of(const char* width)
{
    return machine_has(width) ? kernels(width, Real{}) : nullptr;
}

template <class Real>
const SolveKernels<Real>& solve_kernels()
{
    // Read once: the width of a run never changes under it.
    static const SolveKernels<Real>& chosen = []() -> const SolveKernels<Real>& {
        const char* asked = std::getenv("THRONG_LANES");  // NOLINT(concurrency-mt-unsafe): once
        if (asked == nullptr || *asked == 0) return *solve_kernels_of<Real>(widest());
        if (const SolveKernels<Real>* found = solve_kernels_of<Real>(asked)) return *found;
        throw std::runtime_error(std::string("THRONG_LANES: wanted scalar, avx2 or avx512, and one "
                                             "that this machine has (it has up to ")
                                 + widest() + "), not \"" + asked + "\"");
    }();
    return chosen;
}

template const SolveKernels<float>* solve_kernels_of<float>(const char*);
template const SolveKernels<double>* solve_kernels_of<double>(const char*);
template const SolveKernels<float>& solve_kernels<float>();
template const SolveKernels<double>& solve_kernels<double>();

}  // namespace throng
