// Voxel bricks: a signed distance baked into bricks, and read from them.
#pragma once

#include "kernels/data/bounds.hpp"
#include "kernels/data/solids.hpp"

#include <functional>
#include <span>

namespace throng {

/// The grid for a shape, with nothing stored in it: from a band below its box to a band and less
/// than a brick above.
VoxelBricks lay_bricks(const Box3& box, double voxel, double band);

/// Bakes a distance known everywhere: the plain way, a call for every value of the grid.
///
///   box       where the shape is; the grid reaches a band beyond it
///   distance  m, below 0 inside
VoxelBricks bake_bricks(const Box3& box,
                        double voxel,
                        double band,
                        const std::function<double(const Vec3&)>& distance);

/// The distance and its gradient: trilinear, so both are exact for what is flat. Outside of the
/// stored bricks `distance` is the band and `gradient` 0: the surface is no nearer than that.
template <class Real>
struct FieldSample {
    Real distance = 0;
    Vec3T<Real> gradient = Vec3T<Real>::Zero();
};

/// One point, the plain way.
template <class Real>
FieldSample<Real> sample_bricks(const VoxelBricks& bricks, const Vec3T<Real>& point);

/// Many points and what comes of them: spans of one length.
///
///   x, y, z     [points] m
///   distance    [points] m
///   gx, gy, gz  [points] gradient
struct SampleSpans {
    std::span<const float> x, y, z;
    std::span<float> distance, gx, gy, gz;
};

/// Many points, as many side by side as the machine's registers hold: the bits of
/// sample_bricks<float>() at every width. What comes out may not overlap what goes in.
void sample_many(const VoxelBricks& bricks, const SampleSpans& samples);

}  // namespace throng
