// Solid parts: what the cases of shapes that are not convex share.
#pragma once

#include "cost/hard_cases/cases.hpp"
#include "scene/catalog/closed_meshes.hpp"

#include <string_view>

namespace throng {

/// A value of the dial `nonconvex`, and whether what it makes of a torus still has its hole.
struct SolidRepresentationName {
    std::string_view name;
    bool keeps_holes;
};
inline constexpr SolidRepresentationName kSolidWays[] = {
    {"voxels", true}, {"parts", true}, {"spheres", true}, {"depth_image", true}, {"hull", false}};

/// The scene with the bench's settings, its meshes that move taken that way.
Scene taken(const CaseBench& bench, Scene scene, const SolidRepresentationName& way);

/// m/s, of any body.
double greatest_speed(const class World& world);

}  // namespace throng
