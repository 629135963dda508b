// Step picture: the stages of a step and what waits for what, drawn.
#pragma once

#include "throng/world.hpp"

#include <map>
#include <ostream>
#include <span>
#include <string_view>

namespace throng {

/// As SVG: a column for all that may begin at the same time, an arrow for each wait that no other
/// implies. `ms` has the mean time of stages, by name; may be empty.
void draw_step(std::span<const World::StageInfo> stages,
               const std::map<std::string_view, double>& ms,
               std::ostream& out);

}  // namespace throng
