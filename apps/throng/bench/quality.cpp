// Quality: what a state is worth, whoever came to it.
#include "apps/throng/bench/quality.hpp"

#include "cost/shared_in_heap.hpp"

#include <limits>

namespace throng::bench {
namespace {

// Along the longest side of what two bounds share.
constexpr int kRays = 48;

bool is_moving_mesh(const Scene& scene, const BodyDescription& body)
{
    return body.motion == Motion::dynamic
        && std::holds_alternative<MeshShape>(scene.shapes[body.shape].shape);
}

// NaN where no mesh moves, or one is not closed.
double shared_volume_of(const Scene& scene, const World& world)
{
    bool any = false;
    for (const BodyDescription& body : scene.bodies) any = any || is_moving_mesh(scene, body);
    for (const Instances& group : scene.instances) any = any || is_moving_mesh(scene, group.common);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (!any) return kNone;
    const SharedInHeap shared = shared_in_heap(scene, world, kRays);
    return shared.trouble.empty() ? shared.volume / shared.body : kNone;
}

}  // namespace

Quality quality_of(const Scene& scene, const World& world)
{
    const Measures measures = world.measure();
    Quality quality;
    quality.mean_overlap = measures.mean_overlap;
    quality.greatest_overlap = measures.greatest_overlap;
    quality.overlapping_pairs = measures.overlapping_pairs;
    quality.shared_volume = shared_volume_of(scene, world);
    std::size_t dynamic = 0;
    for (const BodyId body : world.bodies()) {
        if (world.motion(body) != Motion::dynamic) continue;
        ++dynamic;
        quality.mean_height += world.center_of_mass(body).z();
    }
    if (dynamic == 0) return quality;
    quality.kinetic_energy = measures.kinetic_energy / static_cast<double>(dynamic);
    quality.mean_height /= static_cast<double>(dynamic);
    return quality;
}

}  // namespace throng::bench
