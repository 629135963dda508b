// Batch bodies: what is asked of all bodies of a batch that can be moved.
#pragma once

#include "pipeline/step/step_data.hpp"

#include <algorithm>
#include <span>

namespace throng {

/// Whether it is so of any of them.
template <class Is>
bool any_body_of(const Layout& layout, const Batch& batch, const Is& is)
{
    const auto bodies = layout.bodies_of(batch);
    return std::any_of(bodies.begin(), bodies.end(), is);
}

/// Whether any of them can only turn, on a pivot or with a locked position.
inline bool any_only_turns(const Layout& layout, const Batch& batch, const Masses& masses)
{
    return any_body_of(layout, batch,
                       [&](std::uint32_t body) { return !(masses.inverse_mass[body] > 0); });
}

}  // namespace throng
