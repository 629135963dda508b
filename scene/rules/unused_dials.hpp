// Unused dials: those that a scene sets and that nothing in it reads, or that others do not allow.
#pragma once

#include "scene/scene.hpp"

namespace throng {

/// Of Scene::dials_set those that do nothing, in that order, each with its reason:
/// `contact_rate: unused, solver pgs has no soft contacts`.
std::vector<std::string> unused_dials(const Scene& scene);

/// Which dial has a value that another's does not allow, and what was wanted; empty for none.
std::string clashing_dials(const Settings& settings);

}  // namespace throng
