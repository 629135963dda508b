// Impact of spheres: when a solid that stands as spheres first meets another shape on its way.
#pragma once

#include "narrowphase/ccd/time_of_impact.hpp"

namespace throng {

/// Whether the shape is a solid that is to be taken by its pieces, and these are spheres.
bool stands_as_spheres(const Shapes& shapes, const MovingShape& moving);

/// The first of the impacts of its spheres, each for itself, as time_of_impact() has it; where both
/// stand as spheres, of each two of them. Those that touch as it begins are left out one by one:
/// the others are looked at all the same.
Impact impact_of_spheres(const Shapes& shapes,
                         const MovingShape& a,
                         const MovingShape& b,
                         double begin,
                         double end,
                         const ImpactRule& rule);

}  // namespace throng
