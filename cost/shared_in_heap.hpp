// Shared in heap: how much of their volume bodies that are not convex share, however they were
// stepped.
#pragma once

#include "throng/scene.hpp"

namespace throng {

class World;

/// What all pairs of a scene's bodies share, where the world now has them.
///
///   volume   m3
///   body     m3, of all bodies that are meshes
///   pairs    that share any
///   trouble  empty, or why it cannot be told
struct SharedInHeap {
    double volume = 0;
    double body = 0;
    int pairs = 0;
    std::string trouble;
};

/// By depth images of the triangles themselves, with so many rays along the longest side of what
/// two bounds share: meshes, which have to be closed once they are repaired, with one another and
/// with every other body that is no plane, compound or level set.
SharedInHeap shared_in_heap(const Scene& scene, const World& world, int rays);

}  // namespace throng
