// k-DOP: slabs in k / 2 fixed directions.
#pragma once

#include "throng/math.hpp"

#include <array>

namespace throng {

inline constexpr std::size_t kMaxSlabs = 13;

/// direction . x of all points of a shape is between lower and upper; of slabs that it does not
/// have, these are 0. The directions are those of slab_direction().
struct KDop {
    std::array<double, kMaxSlabs> lower = {}, upper = {};
};

}  // namespace throng
