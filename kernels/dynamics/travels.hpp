// Travels: adds up how far colliders have come, from step to step.
#pragma once

#include "kernels/data/bounds.hpp"
#include "kernels/data/travels.hpp"

#include <span>

namespace throng {

/// Adds what some have come since the last call, by any of their points at most; all others are
/// where they were. Who is new has been nowhere yet. A plane reaches everywhere: once it moves, its
/// travel is no number or infinite, and no pair of it can be told to be apart.
///
///   some                colliders, none twice
///   placed              [colliders] where they are now
///   outer_radius        [colliders] m, no point is further from where its frame is
///   speculative_margin  [colliders] m
void follow_colliders(std::span<const std::uint32_t> some,
                      std::span<const Pose> placed,
                      std::span<const double> outer_radius,
                      std::span<const double> speculative_margin,
                      Travels& travels);

/// How far two boxes are apart along the axis that parts them most; 0 where none does.
double separation_between(const NearBox& a, const NearBox& b);

}  // namespace throng
