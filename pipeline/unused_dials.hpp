// Unused dials: those that a scene sets and that nothing in it reads.
#pragma once

#include "pipeline/scene.hpp"

namespace throng {

/// Of Scene::dials_set those that do nothing, in that order, each with its reason:
/// `contact_rate: unused, solver pgs has no soft contacts`.
std::vector<std::string> unused_dials(const Scene& scene);

}  // namespace throng
