#include "kernels/simd/lane_width.hpp"

#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

namespace throng {

namespace {

constexpr const char* kWidths[] = {"avx512", "avx2", "scalar"};  // widest first

const char* widest()
{
    for (const char* width : kWidths)
        if (machine_has_lanes(width)) return width;
    return "scalar";
}

}  // namespace

bool machine_has_lanes(const char* width)
{
    if (std::strcmp(width, "scalar") == 0) return true;
    if (std::strcmp(width, "avx2") == 0) return __builtin_cpu_supports("avx2") != 0;
    if (std::strcmp(width, "avx512") == 0)
        return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0
            && __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512vl") != 0;
    return false;
}

const char* lane_width()
{
    static const char* const chosen = [] {
        const char* asked = std::getenv("THRONG_LANES");  // NOLINT(concurrency-mt-unsafe): once
        if (asked == nullptr || *asked == 0) return widest();
        for (const char* width : kWidths)
            if (std::strcmp(asked, width) == 0 && machine_has_lanes(width)) return width;
        throw std::runtime_error(std::string("THRONG_LANES: wanted scalar, avx2 or avx512, and one "
                                             "that this machine has (it has up to ")
                                 + widest() + "), not \"" + asked + "\"");
    }();
    return chosen;
}

}  // namespace throng
