#include "kernels/data/bodies.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

Surfaces::MaterialPair Surfaces::between(std::uint32_t a, std::uint32_t b) const
{
    if (!overrides.empty()) {
        const auto [low, high] = std::minmax(a, b);
        const auto key = std::pair(low, high);
        const auto found = std::lower_bound(overrides.begin(), overrides.end(), key,
                                            [](const Override& entry, const auto& wanted) {
                                                return std::pair(entry.a, entry.b) < wanted;
                                            });
        if (found != overrides.end() && found->a == low && found->b == high)
            return found->materials;
    }
    return {std::sqrt(friction[a] * friction[b]), std::max(restitution[a], restitution[b]),
            std::max(rolling_friction[a], rolling_friction[b])};
}

}  // namespace throng
