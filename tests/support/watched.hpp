// Watched: what somebody who looks on before and after each step has to tell of a run.
#pragma once

#include "throng/world.hpp"

namespace throng::given {

/// Onlooker: an EnergyLedger or an ErrorEstimate.
template <class Onlooker>
Onlooker watched(World& world, int steps)
{
    Onlooker onlooker;
    for (int step = 0; step < steps; ++step) {
        onlooker.before_step(world);
        world.step();
        onlooker.after_step(world);
    }
    return onlooker;
}

template <class Onlooker>
Onlooker watched(const Scene& scene, int steps)
{
    World world(scene);
    return watched<Onlooker>(world, steps);
}

}  // namespace throng::given
