// Leave out: a scene as it would be if nobody called for an effect.
#pragma once

#include "throng/effects.hpp"
#include "throng/scene.hpp"

namespace throng {

/// What calls for an effect taken out of a scene: springs, coefficients, masks or dials. Effects of
/// kLeftOutByWorld leave it as it is; to them World::leave_out() sees. Of those that two may meet
/// by, contact has all pass through one another, and no_overlap and little_overlap let them
/// overlap. Throws std::invalid_argument for motion, without which there is nothing.
Scene leave_out(const Scene& scene, Effect effect);

}  // namespace throng
