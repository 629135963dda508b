// Pair truth: how two polytopes of any number of corners truly lie to one another.
//
// quad_truth.hpp tries everything, which is too much for hulls of thousands of corners. Here the
// balls inside the two rule out most axes beforehand, and what is left is tried in four times the
// digits; distances are taken from the few nearest corners and then proved: a direction along which
// all corners are as far apart leaves no room for a mistake.
#pragma once

#include "narrowphase/alternatives/convex_methods.hpp"

namespace throng::perf {

/// separation: m, the distance; below 0 minus the least move that parts them.
/// unproved:   m, by how much it may be off; rounding of the direction, some 1e-16 of the size,
///             unless something is wrong.
struct PairTruth {
    double separation = 0;
    double unproved = 0;
};

/// Needs: polytopes.
PairTruth pair_truth(const PolytopePair& pair, const Pose& b_in_a);

/// m3, what the two share, in the digits of long double: each face of either is cut by all the
/// planes of the other, and the pieces are added up.
double shared_volume(const PolytopePair& pair, const Pose& b_in_a);

}  // namespace throng::perf
