// Impact of surfaces: when two meshes on their ways first meet, triangle by triangle.
#pragma once

#include "narrowphase/ccd/time_of_impact.hpp"

namespace throng {

/// The first of the impacts of each two of their triangles, as time_of_impact() has it. Those that
/// touch as it begins are left out one by one: the others are looked at all the same.
Impact impact_of_surfaces(const Mesh& on_a,
                          const MovingShape& a,
                          const Mesh& on_b,
                          const MovingShape& b,
                          double begin,
                          double end,
                          const ImpactRule& rule);

}  // namespace throng
