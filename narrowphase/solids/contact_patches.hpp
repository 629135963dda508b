// Contact patches: the many places where two surfaces touch, made into few manifolds.
#pragma once

#include "kernels/data/manifolds.hpp"

#include <span>
#include <vector>

namespace throng {

/// A place where two surfaces touch or soon may, in a's frame.
///
///   position    midway between the two surfaces
///   normal      unit, from a to b
///   separation  m, along the normal; below 0 when overlapping
///   feature     the same while the same place of a surface is meant
struct SurfaceTouch {
    Vec3 position = Vec3::Zero();
    Vec3 normal = Vec3::UnitZ();
    double separation = 0;
    std::uint32_t feature = 0;
};

/// One of the manifolds of a pair of which at least one is a solid.
///
///   patch  the same from step to step while the same part of the surfaces touches
struct PatchManifold {
    std::uint32_t patch = 0;
    LocalManifold<double> manifold;
};

/// The greatest number of manifolds made of one pair's touches.
inline constexpr std::size_t kMostPatches = 12;

/// Groups touches that lie near one another and push much the same way into manifolds of up to four
/// points that span the group; the deepest touch of each is among its points. Appended to `out` in
/// order of patch.
///
///   touches  are sorted by this; the answer does not hang on their order
///   reach    m, touches further apart than this are left out
///   size     m, of the smaller of the two shapes
///
/// Where there are more groups than kMostPatches, the shallowest are joined to the nearest that
/// pushes much the same way, or left out; how many touches were left out is what it answers.
std::size_t make_patches(std::vector<SurfaceTouch>& touches,
                         double reach,
                         double size,
                         std::vector<PatchManifold>& out);

}  // namespace throng
