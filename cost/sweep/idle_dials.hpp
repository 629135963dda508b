// Idle dials: those that made no difference wherever they were turned.
#pragma once

#include "cost/sweep/sweep.hpp"

namespace throng {

/// The dials each of whose values that was measured gave the very error that the same setting has
/// without it, in every trial that both went through; in the order in which they were tried. None
/// where no setting has an error at all: nothing can matter then.
std::vector<std::string> idle_dials(std::span<const Point> points, std::size_t measure);

}  // namespace throng
