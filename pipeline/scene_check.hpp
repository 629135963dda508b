// Scene check: what a scene must be before it can become a world.
//
// The one place that knows the rules, for scenes read from files and for those that programs make.
#pragma once

#include "pipeline/scene.hpp"
#include "pipeline/scene_path.hpp"

#include <optional>
#include <string>

namespace throng {

/// The part of a scene that is refused, and what was wanted there.
struct SceneTrouble {
    ScenePath path;
    std::string wanted;
};

/// The first trouble in the order shapes, materials, bodies, instances, the rest.
std::optional<SceneTrouble> find_trouble(const Scene& scene);

/// The same as text, `bodies[3].mass: wanted ...`; empty when the scene is good.
std::string check_scene(const Scene& scene);

}  // namespace throng
