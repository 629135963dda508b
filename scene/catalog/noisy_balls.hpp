// Noisy balls: lumps with smooth hills and dents, of any number of triangles.
#pragma once

#include "scene/catalog/closed_meshes.hpp"

namespace throng {

/// A ball of triangles of nearly one size: each of an icosahedron's twenty cut into
/// `cuts` * `cuts` and pushed out to the ball. At least 1.
TriangleSoup geodesic_ball(double radius, std::uint32_t cuts);

/// A geodesic ball whose radius differs from one direction to the next by a sum of smooth waves, by
/// up to `roughness` of the radius either way. Every ray from the middle meets it once, so that it
/// never cuts itself.
///
///   radius     m
///   roughness  at least 0, below 1
///   triangles  about how many: the nearest of 20, 80, 180, 320, ...
TriangleSoup
noisy_ball(double radius, double roughness, std::uint32_t triangles, std::uint64_t seed);

}  // namespace throng
