// Query shape: a shape that a question names, checked as a scene would and made ready.
#pragma once

#include "kernels/data/shapes.hpp"
#include "throng/scene.hpp"

#include <string>

namespace throng {

/// Empty, or what a scene would refuse a single shape for, and what it wants instead.
std::string trouble_with(const ShapeDescription& shape);

/// Empty, or what is wrong with a pose: not finite, too far, not of unit length within 1e-6.
std::string trouble_with(const Pose& pose);

/// Appends a shape that there is no trouble with.
/// Needs: no plane, mesh or compound.
ShapeRef append_convex(Shapes& shapes, const ShapeDescription& shape);

}  // namespace throng
