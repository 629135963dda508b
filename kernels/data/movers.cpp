// Movers: the list of who moves, kept up to date.
#include "kernels/data/bodies.hpp"

#include <algorithm>

namespace throng {

void list_movers(BodyStates& states)
{
    states.movers.dynamic.clear();
    states.movers.kinematic.clear();
    for (std::uint32_t body = 0; body < states.kind.size(); ++body) {
        if (!states.moves(body)) continue;
        (states.dynamic(body) ? states.movers.dynamic : states.movers.kinematic).push_back(body);
    }
}

void follow_movers(const std::vector<std::uint32_t>& awoken, BodyStates& states)
{
    // Whoever has stopped is asleep, or was quarantined and is of another kind.
    std::vector<std::uint32_t>& dynamic = states.movers.dynamic;
    const auto stopped = [&](std::uint32_t body) { return !states.moves(body); };
    std::erase_if(dynamic, stopped);
    std::erase_if(states.movers.kinematic, stopped);
    const auto middle = static_cast<std::ptrdiff_t>(dynamic.size());
    for (const std::uint32_t body : awoken)
        if (states.moves(body)) dynamic.push_back(body);
    std::inplace_merge(dynamic.begin(), dynamic.begin() + middle, dynamic.end());
    dynamic.erase(std::unique(dynamic.begin(), dynamic.end()), dynamic.end());
}

}  // namespace throng
