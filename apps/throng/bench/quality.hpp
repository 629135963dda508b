// Quality: what a state is worth, whoever came to it.
#pragma once

#include "throng/world.hpp"

namespace throng::bench {

/// Measured from poses and velocities by the same geometry for everybody.
struct Quality {
    double mean_overlap = 0, greatest_overlap = 0;  // m, over pairs that overlap
    std::size_t overlapping_pairs = 0;
    double kinetic_energy = 0;  // J a dynamic body
    double mean_height = 0;     // m, of dynamic bodies' centers of mass
    double shared_volume = 0;   // of the volume of bodies that are meshes; NaN where none moves
};

/// Of a world made of that scene.
Quality quality_of(const Scene& scene, const World& world);

}  // namespace throng::bench
