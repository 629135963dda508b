// Broken pairs: pairs of boxes that collision libraries are known to have got wrong, with the truth
// from an exhaustive test in four times the digits.
#pragma once

#include "throng/math.hpp"

#include <optional>
#include <span>

namespace throng {

/// A pose as it was published: a matrix, unit to about eight digits, or a quaternion.
struct GivenPose {
    Pose pose;  // of unit length
    std::optional<Mat3> turn;
};

struct PlacedBox {
    Vec3 size;  // full edge lengths
    Pose pose;
    std::optional<Mat3> turn;  // where the pose was given by a matrix

    PlacedBox(const Vec3& edges, const GivenPose& given)
        : size(edges), pose(given.pose), turn(given.turn)
    { }
};

/// separation: minus the overlap, or the distance, for the poses as given. normal: from a to b in
/// nine digits, of those that overlap; where depths tie it may as well be another.
struct BrokenPair {
    const char* name;
    PlacedBox a, b;
    double separation;
    Vec3 normal;
};

std::span<const BrokenPair> broken_pairs();

}  // namespace throng
