// Box pairs: many pairs of boxes at once, as many side by side as the machine's registers hold.
//
// The same answers as box_box() gives in float, to within rounding, at a fraction of the time. It
// remembers nothing: all fifteen axes take less time than asking what was there before.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "narrowphase/convex/wide/box_kernels.hpp"

#include <span>

namespace throng {

/// The pair as collide_boxes() wants it.
///
///   b_in_a         pose of b in a's frame; to be computed in double
///   half_a, half_b half extents
///   speculative_margin  m, points further apart than this are left out (at least 0)
inline BoxPair box_pair(const PoseT<float>& b_in_a,
                        const Vec3T<float>& half_a,
                        const Vec3T<float>& half_b,
                        float speculative_margin)
{
    const Vec3T<float>& p = b_in_a.position;
    const QuatT<float>& q = b_in_a.orientation;
    return {{p.x(), p.y(), p.z(), speculative_margin, q.x(), q.y(), q.z(), q.w()},
            {half_a.x(), half_a.y(), half_a.z(), 0, half_b.x(), half_b.y(), half_b.z(), 0}};
}

/// Finds where boxes touch or come within the margin of one another: manifolds in a's frame, normal
/// from a to b; count 0 where nothing is within the margin, the rest of such a manifold left as it
/// was.
///
/// An answer hangs on its pair alone, not on the others of the call nor on the width of the
/// machine. Best with some hundred pairs a call: what is left of each step is padded to full
/// registers.
///
/// Needs: as many manifolds as pairs.
void collide_boxes(std::span<const BoxPair> pairs, std::span<LocalManifold<float>> manifolds);

/// The same with the kernels of some width.
void collide_boxes(const BoxKernels& kernels,
                   std::span<const BoxPair> pairs,
                   std::span<LocalManifold<float>> manifolds);

}  // namespace throng
