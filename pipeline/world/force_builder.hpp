// Force builder: what a scene states of forces, made into the arrays that the step works on.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/forces.hpp"
#include "throng/scene.hpp"

#include <span>
#include <string>
#include <vector>

namespace throng {

/// Notes what acts on a body that is being added: constant forces, drag, and where it hangs.
///
///   center  m, body axes: its center of mass, seen from the frame it was stated in
void state_forces(std::uint32_t body,
                  const BodyDescription& stated,
                  const Vec3& center,
                  Forces& forces);

/// Adds springs between bodies that were added.
///
///   ids     [bodies of the scene] where each of them went
///   center  [bodies] m, from the frame of each to its position: its center of mass or its pivot
void join_springs(std::span<const Spring> springs,
                  std::span<const std::uint32_t> ids,
                  std::span<const Vec3> center,
                  const BodyStates& states,
                  Forces& forces);

/// Which springs each body has, and who has to be carried on together: what stands still or goes by
/// itself passes nothing on. To be asked anew where springs or kinds of bodies change.
void sort_springs(const BodyStates& states, Forces& forces);

/// Forgets all that acts on some bodies, which are removed, the springs that hold them included.
void drop_forces(std::span<const std::uint32_t> going, const BodyStates& states, Forces& forces);

/// A sentence for each spring that makes its bodies swing wider and wider at these settings: the
/// limit, and what would do.
std::vector<std::string>
unstable_springs(const Forces& forces, const Masses& masses, const Settings& settings);

}  // namespace throng
