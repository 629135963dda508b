// Active bodies: the list of them, kept up to date.
#include "kernels/data/bodies.hpp"

#include <algorithm>

namespace throng {

void list_active_bodies(BodyStates& states)
{
    states.active_bodies.dynamic.clear();
    states.active_bodies.kinematic.clear();
    for (std::uint32_t body = 0; body < states.kind.size(); ++body) {
        if (!states.moves(body)) continue;
        (states.dynamic(body) ? states.active_bodies.dynamic : states.active_bodies.kinematic)
            .push_back(body);
    }
}

void update_active_bodies(const std::vector<std::uint32_t>& woke, BodyStates& states)
{
    // Whoever has stopped is asleep, or was quarantined and is of another kind.
    std::vector<std::uint32_t>& dynamic = states.active_bodies.dynamic;
    const auto stopped = [&](std::uint32_t body) { return !states.moves(body); };
    std::erase_if(dynamic, stopped);
    std::erase_if(states.active_bodies.kinematic, stopped);
    const auto middle = static_cast<std::ptrdiff_t>(dynamic.size());
    for (const std::uint32_t body : woke)
        if (states.moves(body)) dynamic.push_back(body);
    std::inplace_merge(dynamic.begin(), dynamic.begin() + middle, dynamic.end());
    dynamic.erase(std::unique(dynamic.begin(), dynamic.end()), dynamic.end());
}

}  // namespace throng
