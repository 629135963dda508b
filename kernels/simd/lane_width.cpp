#include "kernels/simd/lane_width.hpp"

#include <cstdlib>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <string>

namespace throng {

namespace {

constexpr const char* kWidths[] = {"scalar", "avx2", "avx512"};  // widest last

int widest()
{
    int place = static_cast<int>(std::size(kWidths)) - 1;
    while (!machine_has_lanes(kWidths[place])) --place;
    return place;
}

// Throws std::runtime_error, after `whose`.
int place_of(const char* whose, const char* asked)
{
    for (int place = 0; place < static_cast<int>(std::size(kWidths)); ++place)
        if (std::strcmp(asked, kWidths[place]) == 0 && machine_has_lanes(asked)) return place;
    throw std::runtime_error(std::string(whose)
                             + ": wanted scalar, avx2 or avx512, and one that this machine has (it "
                               "has up to "
                             + kWidths[widest()] + "), not \"" + asked + "\"");
}

int& taken()
{
    static int place = [] {
        const char* asked = std::getenv("THRONG_LANES");  // NOLINT(concurrency-mt-unsafe): once
        return asked == nullptr || *asked == 0 ? widest() : place_of("THRONG_LANES", asked);
    }();
    return place;
}

}  // namespace

bool machine_has_lanes(const char* width)
{
    if (std::strcmp(width, "scalar") == 0) return true;
    if (std::strcmp(width, "avx2") == 0)
        return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
    if (std::strcmp(width, "avx512") == 0)
        return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0
            && __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512vl") != 0;
    return false;
}

const char* lane_width() { return kWidths[lane_width_place()]; }

int lane_width_place() { return taken(); }

void take_lanes(const char* width) { taken() = place_of("take_lanes", width); }

}  // namespace throng
