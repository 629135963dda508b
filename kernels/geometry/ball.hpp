// Ball: a center and a radius.
#pragma once

#include "throng/math.hpp"

namespace throng {

struct Ball {
    Vec3 center = Vec3::Zero();
    double radius = 0;
};

/// How far a place is from a ball, m; below 0 inside.
inline double distance_to(const Ball& ball, const Vec3& place)
{
    return (place - ball.center).norm() - ball.radius;
}

}  // namespace throng
