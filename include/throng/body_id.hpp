// Body id: how a program names a body of a world.
#pragma once

#include <cstdint>

namespace throng {

/// Names a body: its place, and how many held that place before it. One that was given to nobody
/// names none.
struct BodyId {
    std::uint32_t index = 0xffffffffu;
    std::uint32_t generation = 0;
    bool operator==(const BodyId&) const = default;
};

}  // namespace throng
