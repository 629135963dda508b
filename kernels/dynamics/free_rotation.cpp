#include "kernels/dynamics/free_rotation.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// A nutation loses a part in 2400 of its phase at this much a part, rad.
constexpr double kNod = 0.1;

}  // namespace

FreeRotation free_rotation(const Vec3& moments)
{
    const auto between = [&](int k) {
        return (moments[k] - moments[(k + 1) % 3]) * (moments[k] - moments[(k + 2) % 3]) <= 0;
    };
    FreeRotation rotation;
    rotation.middle = between(0) ? 0 : between(1) ? 1 : 2;
    rotation.share = 1 / moments[rotation.middle];
    rotation.outer = 1 / moments[(rotation.middle + 1) % 3] - rotation.share;
    rotation.inner = 1 / moments[(rotation.middle + 2) % 3] - rotation.share;
    rotation.pace = std::sqrt(std::abs(rotation.outer * rotation.inner));
    return rotation;
}

int parts_of(const FreeRotation& rotation, double momentum, double span, int most)
{
    const double parts = span * rotation.pace * momentum / kNod;
    if (!(parts <= most)) return 0;
    return std::max(1, static_cast<int>(std::ceil(parts)));
}

}  // namespace throng
