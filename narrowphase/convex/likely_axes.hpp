// Likely axes: the few directions in which shapes that rest on one another separate, tried before
// the search by GJK and EPA, which takes ten times as long.
#pragma once

#include "narrowphase/convex/contact_axis.hpp"

namespace throng {

enum class Likely : std::uint8_t {
    unknown,  // none of the directions can be shown to be the best
    found,    // the axis
    beyond    // a direction separates the cores by more than the limit
};

/// Tries cylinders side by side or crossed, a cylinder or capsule on a face of a box or hull, and
/// whatever stands on a cylinder's cap. An axis is found when the nearest points lie well within
/// the two features, which for cores that are apart proves it the best; for cores that overlap they
/// must lie further within than they are deep.
Likely likely_axis(const ConvexCorePair& pair, double limit, ContactAxis& axis);

}  // namespace throng
