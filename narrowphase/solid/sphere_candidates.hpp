// Sphere candidates: a solid that stands as spheres against whatever else there is.
//
// Down the tree level by level, with whatever is beyond the margin left behind, so that there is an
// answer at every level and time or error say how deep it goes.
#pragma once

#include "kernels/data/shapes.hpp"
#include "narrowphase/convex/pair_input.hpp"
#include "narrowphase/manifold/contact_patches.hpp"

#include <limits>

namespace throng {

/// How far to go down.
///
///   level  the deepest level wanted
///   error  m, no deeper than where the answer's error is within
///   tests  of sphere against sphere or against the other shape; the first level is always done
struct SphereBudget {
    int level = std::numeric_limits<int>::max();
    double error = 0;
    std::size_t tests = std::numeric_limits<std::size_t>::max();
};

/// What an answer is worth.
///
///   error  m, how far the surfaces that were used may be from the true ones, both together
///   level  that was reached; a tree that has fewer was used at its last
///   apart  m, the two are at least so far apart, of distances to `speculative_margin`: at most
///          that less the error; 0 or less where they may touch
///   tests  that it took
struct SphereAnswer {
    double error = 0;
    int level = 0;
    double apart = 0;
    std::size_t tests = 0;
};

/// Where a solid's spheres touch another shape, out to the margin, in the solid's frame with
/// normals from it to the other.
///
///   in          a: solid with spheres; b: solid (by its spheres, else its field, else its
///               triangles), sphere, capsule, cylinder, box, hull, plane, or mesh (its front faces)
///   candidates  appended to. Separations are those of spheres: with the other's surface, or of two
///               spheres, each with the one that it is deepest in or nearest to and no other
///   budget      see above; counts no more tests than it has, but for the first level
///
/// That each has one partner keeps spheres that have come more than half way through a thin wall
/// from being pushed out on both its sides: all but the deepest of its pairs there are between
/// spheres that merely lie side by side. Where even that one is on the far side, it pushes through.
///
/// Never throws; the same for the same input.
SphereAnswer find_sphere_candidates(const PairInput<double>& in,
                                    const SphereBudget& budget,
                                    std::vector<ContactCandidate>& candidates);

}  // namespace throng
