// Stated hull: the hull of stated points, built once for all who ask about it on its way from a
// file into a world.
#pragma once

#include "cooking/hulls/hull.hpp"
#include "throng/scene.hpp"

#include <memory>

namespace throng {

/// Builds the hull of the points; the answer is kept until it is forgotten, as moving_mesh() keeps
/// its own.
std::shared_ptr<const HullResult> stated_hull(const HullShape& stated);

/// No longer keeps it: whoever has the answer still has it.
void forget_stated_hull(const HullShape& stated);

}  // namespace throng
