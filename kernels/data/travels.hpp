// Travels: how far colliders have come, so that pairs that are apart need not be looked at before
// the two could have met.
#pragma once

#include "throng/math.hpp"

#include <vector>

namespace throng {

/// A pair that is apart may come within the margin only once the approaches of the two have grown
/// by what they are beyond it.
///
///   placed    [colliders] where it was in the last step
///   traveled  [colliders] m, no point of it has come further since the first step
///   approach  [colliders] m, the same and its speculative margin
struct Travels {
    std::vector<Pose> placed;
    std::vector<double> traveled, approach;
};

}  // namespace throng
