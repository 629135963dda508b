// Hull guide: what is worked out with a hull so that its furthest vertices are found quickly.
#pragma once

#include "kernels/data/shapes.hpp"

namespace throng {

/// Fills the guide of a hull that has everything else.
void make_guide(Hull& hull);

}  // namespace throng
