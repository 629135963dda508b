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
struct ContactCandidate {
    Vec3 position = Vec3::Zero();
    Vec3 normal = Vec3::UnitZ();
    double separation = 0;
    std::uint32_t feature = 0;
};

/// The greatest number of groups that one pair's touches are put in, of places that are kept of one
/// group besides the four that span it, and of manifolds made of all.
inline constexpr std::size_t kMostPatches = 24, kMostBetween = 64;
inline constexpr std::size_t kMostManifolds = (4 + kMostBetween) * kMostPatches;

/// Groups candidates that push much the same way, and chooses of each group up to four that span
/// it. Those whose normals are within 8 degrees of the group's are one manifold with that normal;
/// each of the others is a manifold of one point, from 12 degrees on with its own. Appended to
/// `out` in order of patch.
///
///   candidates          sorted by this, and those further apart than `speculative_margin` taken
///                       out; the answer does not hang on their order. Features are to differ from
///                       one another
///   speculative_margin  m, touches further apart than this are left out
///   size                m, of the smaller of the two shapes
///   deep                m, what is deeper than this is as deep for what is chosen, beside the
///                       deepest
///
/// Normals of a group's touches are within 31 degrees of the group's: their mean, weighed by how
/// far within the margin each is. Separations are what of them lies along their manifold's. The
/// places of candidates do not part them: bodies are rigid, so what pushes one way holds by the
/// four that span the most wherever they are, as a table stands on four legs.
///
/// That holds for patches that are flat. Where a body is held from opposite sides, and fast, as a
/// bolt that runs down its nut, of patches that bend places between the four are kept too, three
/// hundredths of size apart or more, each by itself with its own normal: what is not kept would be
/// within the other by the end of a step.
///
/// What is chosen hangs on directions and places rather than on small differences in depth, so that
/// bodies at rest keep the same points. The deepest of each group is among them, or one that is as
/// deep to within a ten-thousandth of size. What lies shallower counts for less; the less so the
/// further the speculative margin is beyond a tenth of size, as of fast bodies what is far may
/// touch first.
///
/// Where there are more groups than kMostPatches, the candidates of the shallowest join those that
/// push within 45 degrees of them, or are left out; how many that overlap were left out is what it
/// answers.
std::size_t make_patches(std::vector<ContactCandidate>& candidates,
                         double speculative_margin,
                         double size,
                         double deep,
                         std::vector<PartManifold>& out);

}  // namespace throng
