// Wide hull: a hull in float, side by side, for the wide kernels of contact.
#pragma once

#include "kernels/data/shapes.hpp"

namespace throng {

/// Fills hull.wide from the rest of the hull, or leaves it empty where float will not do.
void widen(Hull& hull);

/// Whether float will do for a shape with balls of these radii inside and round it, m.
bool is_wide(double inner_radius, double outer_radius);

}  // namespace throng
