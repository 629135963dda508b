// Collider overlaps: which colliders overlap and how deep, found afresh from geometry on the poses
// as they are.
#pragma once

#include "pipeline/world/world_state.hpp"

#include <vector>

namespace throng {

/// Two colliders whose shapes overlap. depth: m, by the least translation, above 0.
struct ColliderOverlap {
    std::uint32_t collider_a = 0, collider_b = 0;
    double depth = 0;
};

/// All that overlap of those that may touch, in the order of pairs. Takes about as long as a broad
/// and a narrow phase; runs on the world's own threads.
std::vector<ColliderOverlap> find_collider_overlaps(const WorldState& state);

}  // namespace throng
