// Sphere tree: a progressive hierarchy of spheres that stands for a closed mesh.
//
// Each level is a cover of the whole mesh by itself (sphere_cover.hpp), its spheres grown so that
// their surface lies as far outside of the mesh's as inside; the spheres of the next level are
// handed to those that they grow least.
#pragma once

#include "kernels/data/solids.hpp"

namespace throng {

/// How far a tree is built.
///
///   levels   number of them at most; level k has 8^k spheres ...
///   spheres  ... and no level more than this
///   error    m, no further level once one is within
///   looks    for the worst place of each level; with fewer the errors told are looser
struct SphereTreeLimits {
    int levels = 5;
    std::size_t spheres = 2000;
    double error = 0;
    std::size_t looks = 400000;
};

/// The tree of a closed mesh, with vertex normals. Each level's error is a bound for every point
/// (sphere_error.hpp), and less than that of the level before: a level that would not better it by
/// a tenth is left out, and after two of those there are no more. One without a level where the
/// mesh is empty.
SphereTree build_sphere_tree(const Mesh& mesh, const SphereTreeLimits& limits = {});

}  // namespace throng
