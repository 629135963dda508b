// Quality: what a state is worth, whoever came to it.
#include "apps/throng/bench/quality.hpp"

namespace throng::bench {

Quality quality_of(const World& world)
{
    const Measures measures = world.measure();
    Quality quality;
    quality.mean_overlap = measures.mean_overlap;
    quality.greatest_overlap = measures.greatest_overlap;
    quality.overlapping_pairs = measures.overlapping_pairs;
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
