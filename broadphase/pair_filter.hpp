// Pair filter: which colliders may touch at all, wherever they are.
#pragma once

#include <cstdint>
#include <vector>

namespace throng {

/// Groups and masks, one of each per collider.
///
/// Two colliders may touch when each one's group has a bit in the other's mask, and never when they
/// belong to the same body.
struct PairFilter {
    std::vector<std::uint32_t> group, mask, body;

    /// Adds a collider, whose id is the number of those added before.
    void add(std::uint32_t its_body, std::uint32_t its_group = 1, std::uint32_t its_mask = ~0u);
    void resize(std::size_t colliders);
    std::size_t size() const { return body.size(); }

    bool allows(std::uint32_t a, std::uint32_t b) const
    {
        return body[a] != body[b] && (group[a] & mask[b]) != 0 && (group[b] & mask[a]) != 0;
    }
};

}  // namespace throng
