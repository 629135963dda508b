// Method start: with how much of its speed a method of the narrow phase runs.
#pragma once

#include <cstdint>

namespace throng {

enum class MethodStart : std::uint8_t {
    cached,  // from what the pair remembers
    cold,    // as if it remembered nothing
    plain,   // without its accelerations: the answer sheet
};

}  // namespace throng
