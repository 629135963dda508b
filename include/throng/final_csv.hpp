// Final CSV: where every body is and how it moves, for programs that compare runs.
#pragma once

#include "throng/world.hpp"

#include <ostream>

namespace throng {

/// Writes a header and a line for each body alive, by id:
///
///   id, name, position and orientation (w, x, y, z) of the body's own frame, velocity of its
///   center of mass, angular velocity; SI units, world axes
///
/// Numbers have the fewest digits that read back to the same bits. A name that holds a comma, a
/// quote or a line break is quoted as RFC 4180 has it.
void write_final_csv(const World& world, std::ostream& out);

}  // namespace throng
