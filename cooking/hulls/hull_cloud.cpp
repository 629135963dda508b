#include "cooking/hulls/hull_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

// Thinner than this against its extent, a cloud of points has no inside worth the name. Needles
// and plates of one part in a million keep two digits of room.
constexpr double kFlat = 1e-8;
std::string not_finite(std::span<const Vec3> points)
{
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!points[i].allFinite())
            return "point " + std::to_string(i) + " is not finite; give finite coordinates";
    return {};
}

std::size_t count_distinct(std::span<const Vec3> points, std::size_t enough)
{
    std::vector<Vec3> seen;
    for (const Vec3& point : points) {
        if (seen.size() == enough) break;
        if (std::find(seen.begin(), seen.end(), point) == seen.end()) seen.push_back(point);
    }
    return seen.size();
}

// The point for which measure(point) is greatest, the first of them.
template <class Measure>
std::uint32_t greatest(std::span<const Vec3> points, Measure measure)
{
    std::uint32_t best = 0;
    double best_value = -std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const double value = measure(points[i]);
        if (value > best_value) {
            best_value = value;
            best = i;
        }
    }
    return best;
}

// The two farthest apart among the extremes along the axes.
std::array<std::uint32_t, 2> farthest_pair(std::span<const Vec3> points)
{
    std::vector<std::uint32_t> extremes;
    for (int axis = 0; axis < 3; ++axis) {
        extremes.push_back(greatest(points, [&](const Vec3& p) { return -p[axis]; }));
        extremes.push_back(greatest(points, [&](const Vec3& p) { return p[axis]; }));
    }
    std::array<std::uint32_t, 2> best{extremes[0], extremes[1]};
    for (const std::uint32_t a : extremes)
        for (const std::uint32_t b : extremes)
            if ((points[a] - points[b]).squaredNorm()
                > (points[best[0]] - points[best[1]]).squaredNorm())
                best = {a, b};
    return best;
}

}  // namespace

void find_start(HullCloud& cloud)
{
    const std::vector<Vec3>& points = cloud.points;
    const auto [first, second] = farthest_pair(points);
    const Vec3 origin = points[first];
    const double length = (points[second] - origin).norm();
    const Vec3 along = (points[second] - origin) / length;
    const auto off_line = [&](const Vec3& p) { return along.cross(p - origin).norm(); };
    const std::uint32_t third = greatest(points, off_line);
    if (off_line(points[third]) <= kFlat * length) {
        cloud.trouble = "points lie on one line; give points that enclose a volume";
        return;
    }
    const Vec3 up = along.cross(points[third] - origin).normalized();
    const auto off_plane = [&](const Vec3& p) { return std::abs(up.dot(p - origin)); };
    const std::uint32_t fourth = greatest(points, off_plane);
    cloud.thickness = off_plane(points[fourth]);
    if (cloud.thickness <= kFlat * length)
        cloud.trouble = "points lie in one plane; give points that enclose a volume";
    cloud.start = {first, second, third, fourth};
    cloud.frame << along.transpose(), up.cross(along).transpose(), up.transpose();
}

HullCloud hull_cloud(std::span<const Vec3> given)
{
    HullCloud cloud;
    cloud.trouble = not_finite(given);
    if (!cloud.trouble.empty()) return cloud;
    if (const std::size_t distinct = count_distinct(given, 4); distinct < 4) {
        cloud.trouble = "points are " + std::to_string(distinct)
            + " distinct ones; give at least 4 that enclose a volume";
        return cloud;
    }
    Vec3 lower = given[0], upper = given[0];
    for (const Vec3& point : given) {
        lower = lower.cwiseMin(point);
        upper = upper.cwiseMax(point);
    }
    const double extent = (upper - lower).maxCoeff();
    if (!(extent > 1e-60 && extent < 1e60)) {
        cloud.trouble = "points span less than 1e-60 m or more than 1e60 m; give them in meters";
        return cloud;
    }
    int exponent = 0;
    std::frexp(extent, &exponent);
    const double scale = std::ldexp(1.0, -exponent);
    cloud.extent = extent * scale;
    for (const Vec3& point : given) cloud.points.emplace_back((point - lower) * scale);
    find_start(cloud);
    return cloud;
}

// A thin cloud that lies aslant is rounded along its own axes, lest the grid be coarse against its
// thickness. Others keep their axes, and with them points that lie exactly in one plane.
std::vector<GridPoint> round_to_grid(const HullCloud& cloud)
{
    Vec3 upper = Vec3::Zero();
    for (const Vec3& point : cloud.points) upper = upper.cwiseMax(point);
    if (cloud.thickness > 0.01 * upper.minCoeff()) return to_grid(cloud.points);
    std::vector<Vec3> turned;
    for (const Vec3& point : cloud.points) turned.emplace_back(cloud.frame * point);
    return to_grid(turned);
}

}  // namespace throng
