// Scene check: what a scene must be before it can become a world.
//
// The one place that knows the rules, for scenes read from files and for those that programs make.
#pragma once

#include "scene/scene_path.hpp"
#include "throng/scene.hpp"

#include <optional>
#include <stdexcept>
#include <string>

namespace throng {

/// The part of a scene that is refused, and what was wanted there.
struct SceneTrouble {
    ScenePath path;
    std::string wanted;
};

/// A scene that cannot become a world: what() reads `scene: bodies[3].mass: wanted ...`.
class SceneRefused : public std::invalid_argument {
public:
    explicit SceneRefused(SceneTrouble trouble)
        : std::invalid_argument("scene: " + path_text(trouble.path) + ": " + trouble.wanted),
          trouble_(std::move(trouble))
    { }
    const SceneTrouble& trouble() const { return trouble_; }

private:
    SceneTrouble trouble_;
};

/// The first trouble in the order shapes, materials, bodies, instances, the rest.
std::optional<SceneTrouble> find_trouble(const Scene& scene);

}  // namespace throng
