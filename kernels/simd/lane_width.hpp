// Lane width: which of the instruction sets that the wide kernels were compiled for a run takes.
#pragma once

#include "throng/version.hpp"

#include <string_view>

namespace throng {

/// Of lane_width(), among scalar, avx2 and avx512.
int lane_width_place();

/// Of what a file of wide kernels was compiled to for each instruction set, the one of a width;
/// none (a T{}) where the machine has not got that width or the name is another.
template <class T>
T of_width(const char* width, T scalar, T avx2, T avx512)
{
    if (!machine_has_lanes(width)) return T{};
    const std::string_view name = width;
    return name == "avx512" ? avx512 : name == "avx2" ? avx2 : scalar;
}

}  // namespace throng

/// Defines two functions for a constant that a file of wide kernels has once a width: `kernel_of`,
/// a pointer to that of a width by name, null where this machine has not got it or the name is
/// another; and `kernel`, the one that this run takes (see lane_width()). For a file that is
/// compiled for every machine, in the namespace throng. What comes last stands before each
/// function.
#define THRONG_WIDTHS(Type, kConstant, kernel_of, kernel, ...)                                     \
    namespace scalar {                                                                             \
    extern const Type kConstant;                                                                   \
    }                                                                                              \
    namespace avx2 {                                                                               \
    extern const Type kConstant;                                                                   \
    }                                                                                              \
    namespace avx512 {                                                                             \
    extern const Type kConstant;                                                                   \
    }                                                                                              \
    __VA_ARGS__ const Type* kernel_of(const char* width)                                           \
    {                                                                                              \
        return of_width(width, &scalar::kConstant, &avx2::kConstant, &avx512::kConstant);          \
    }                                                                                              \
    __VA_ARGS__ const Type& kernel()                                                               \
    {                                                                                              \
        static const Type* const all[] = {kernel_of("scalar"), kernel_of("avx2"),                  \
                                          kernel_of("avx512")};                                    \
        return *all[lane_width_place()];                                                           \
    }
