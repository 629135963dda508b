#include "pipeline/world/scene_fields.hpp"

#include "kernels/data/bodies.hpp"

#include <algorithm>

namespace throng {

bool SceneFields::add(const Scene& scene, std::span<const std::uint32_t> bodies, Forces& forces)
{
    Field field{bodies.size(), {}, scene.wind};
    for (const Attractor& attractor : scene.attractors)
        field.attractors.push_back({attractor.position, attractor.strength});
    if (field.empty()) return false;
    const auto place = static_cast<std::uint32_t>(fields_.size());
    fields_.push_back(std::move(field));
    for (const std::uint32_t body : bodies) {
        if (field_of_.size() <= body) field_of_.resize(body + std::size_t{1}, kNoBody);
        field_of_[body] = place;
    }
    gather(forces);
    return true;
}

bool SceneFields::remove(std::span<const std::uint32_t> going, Forces& forces)
{
    bool changed = false;
    for (const std::uint32_t body : going) {
        if (body >= field_of_.size() || field_of_[body] == kNoBody) continue;
        Field& field = fields_[field_of_[body]];
        // Its place may be another scene's next.
        field_of_[body] = kNoBody;
        if (--field.bodies > 0) continue;
        field = {};
        changed = true;
    }
    while (!fields_.empty() && fields_.back().empty()) fields_.pop_back();
    if (changed) gather(forces);
    return changed;
}

void SceneFields::gather(Forces& forces) const
{
    forces.attractors.clear();
    forces.wind.setZero();
    for (const Field& field : fields_) {
        forces.attractors.insert(forces.attractors.end(), field.attractors.begin(),
                                 field.attractors.end());
        if (!field.wind.isZero(0)) forces.wind = field.wind;
    }
}

}  // namespace throng
