// Solid parts: what the cases of shapes that are not convex share.
#pragma once

#include "cost/cases.hpp"
#include "scenes/closed_meshes.hpp"

#include <string_view>

namespace throng {

/// A value of the dial `nonconvex`, and whether what it makes of a torus still has its hole.
struct SolidWayName {
    std::string_view name;
    bool keeps_holes;
};
inline constexpr SolidWayName kSolidWays[] = {
    {"voxels", true}, {"parts", true}, {"spheres", true}, {"depth_image", true}, {"hull", false}};

/// The scene with the bench's settings, its meshes that move taken that way.
Scene taken(const CaseBench& bench, Scene scene, const SolidWayName& way);

/// m/s, of any body.
double greatest_speed(const class World& world);

/// What all pairs of a scene's bodies share, where the world now has them.
///
///   volume   m3
///   body     m3, of all moving bodies
///   pairs    that share any
///   trouble  empty, or why it cannot be told
struct SharedInHeap {
    double volume = 0;
    double body = 0;
    int pairs = 0;
    std::string trouble;
};

/// By depth images with so many rays along the longest side of what two bounds share. Bodies are
/// meshes that are closed and reach no further than `reach` from their origins, and static boxes.
SharedInHeap shared_in_heap(const Scene& scene, const World& world, double reach, int rays);

}  // namespace throng
