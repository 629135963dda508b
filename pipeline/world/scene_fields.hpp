// Scene fields: the attractors and the wind of the scenes that were added to a world. They go with
// the last body of their scene; those of a scene without bodies stay.
#pragma once

#include "kernels/data/forces.hpp"
#include "throng/scene.hpp"

#include <span>

namespace throng {

class SceneFields {
public:
    /// Takes what a scene brings. True where that is anything.
    bool add(const Scene& scene, std::span<const std::uint32_t> bodies, Forces& forces);
    /// Takes away what scenes brought whose last body is among those that go. True where that is
    /// anything.
    bool remove(std::span<const std::uint32_t> going, Forces& forces);

private:
    struct Field {
        std::size_t bodies = 0;  // of its scene, that are there
        std::vector<AttractorForce> attractors;
        Vec3 wind = Vec3::Zero();

        bool empty() const { return attractors.empty() && wind.isZero(0); }
    };
    /// All attractors in the order in which they came, and the last wind.
    void gather(Forces& forces) const;

    std::vector<Field> fields_;            // empty ones are gone
    std::vector<std::uint32_t> field_of_;  // [bodies] kNoBody: no field; may be shorter
};

}  // namespace throng
