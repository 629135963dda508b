// Time-of-impact method: how the moment of touch is found.
#pragma once

#include <cstdint>

namespace throng {

enum class ToiMethod : std::uint8_t {
    newton,        // towards where the tangent meets the level
    bisection,     // by halves
    conservative,  // as far as the greatest speed of approach allows
};

}  // namespace throng
