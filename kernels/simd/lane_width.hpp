// Lane width: which of the instruction sets that the wide kernels were compiled for a run takes.
#pragma once

#include "throng/version.hpp"

#include <string_view>

namespace throng {

/// True for "scalar", "avx2" or "avx512" where this machine has it.
bool machine_has_lanes(const char* width);

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
