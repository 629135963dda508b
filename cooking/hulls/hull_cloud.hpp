// Hull cloud: the points a hull is asked for, looked at before anything is built.
#pragma once

#include "cooking/hulls/exact_hull.hpp"

#include <span>
#include <string>

namespace throng {

/// Points near the origin, scaled by a power of two to an extent between 1/2 and 1.
struct HullCloud {
    std::vector<Vec3> points;
    std::array<std::uint32_t, 4> start{};  // four that enclose a volume
    Mat3 frame;                            // rows: the longest way, across it, across both
    double extent = 0;                     // longest side of the box round the points
    double thickness = 0;  // distance of the fourth from the plane of the first three
    std::string trouble;   // why they have no hull; then nothing else is filled
};

HullCloud hull_cloud(std::span<const Vec3> given);

/// Finds start, frame and thickness, each point as far as possible from those before it.
void find_start(HullCloud& cloud);

/// The points on a grid fine enough for the cloud's thickness.
std::vector<GridPoint> round_to_grid(const HullCloud& cloud);

}  // namespace throng
