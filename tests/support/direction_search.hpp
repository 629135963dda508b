// Direction search: how far apart two convex shapes are, from nothing but the corners and circles
// that they are made of. The slow, plain twin of the pair functions; shares no geometry with them.
#pragma once

#include "kernels/data/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace throng::given {

/// Points, circles about the axis z and a rounding: enough for every convex kind.
struct Outline {
    std::vector<Vec3> points;
    double circle_radius = 0;  // with points: each is the center of a circle across z
    double rounding = 0;

    /// Furthest reach along a direction of unit length.
    double extent(const Vec3& direction) const
    {
        double most = -1e300;
        for (const Vec3& point : points) most = std::max(most, point.dot(direction));
        return most + rounding + circle_radius * std::hypot(direction.x(), direction.y());
    }
};

inline Outline outline_of(const Shapes& shapes, ShapeRef shape)
{
    Outline outline;
    switch (shape.kind) {
    case ShapeKind::sphere:
        outline.points = {Vec3::Zero()};
        outline.rounding = shapes.spheres[shape.index].radius;
        break;
    case ShapeKind::capsule: {
        const Capsule& capsule = shapes.capsules[shape.index];
        outline.points = {Vec3(0, 0, -capsule.half_length), Vec3(0, 0, capsule.half_length)};
        outline.rounding = capsule.radius;
        break;
    }
    case ShapeKind::cylinder: {
        const Cylinder& cylinder = shapes.cylinders[shape.index];
        outline.points = {Vec3(0, 0, -cylinder.half_length), Vec3(0, 0, cylinder.half_length)};
        outline.circle_radius = cylinder.radius;
        break;
    }
    case ShapeKind::box:
        for (int i = 0; i < 8; ++i) {
            const Vec3 signs(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
            outline.points.push_back(shapes.boxes[shape.index].half_extents.cwiseProduct(signs));
        }
        break;
    case ShapeKind::hull:
        outline.points = shapes.hulls[shape.index].vertices;
        break;
    default:
        break;
    }
    return outline;
}

/// How far apart two outlines lie along a direction from a to b; below 0 where they overlap.
struct OutlinePair {
    Outline a, b;
    Pose b_in_a;

    double along(const Vec3& normal) const
    {
        const Vec3 local = b_in_a.orientation.conjugate() * -normal;
        return normal.dot(b_in_a.position) - b.extent(local) - a.extent(normal);
    }
};

/// The greatest gap over all directions: the distance of shapes that are apart, minus the depth of
/// those that overlap. A spiral of directions over the sphere, the best of them improved in ever
/// smaller steps, with `extra` as further places to start from.
inline double greatest_separation(const OutlinePair& clearance,
                                  const std::vector<Vec3>& extra = {},
                                  int directions = 3000)
{
    std::vector<std::pair<double, Vec3>> starts;
    for (int i = 0; i < directions; ++i) {
        const double z = 1 - (2.0 * i + 1) / directions;
        const double around = 2.399963229728653 * i;
        const double across = std::sqrt(1 - z * z);
        const Vec3 normal(across * std::cos(around), across * std::sin(around), z);
        starts.emplace_back(clearance.along(normal), normal);
    }
    for (const Vec3& normal : extra) starts.emplace_back(clearance.along(normal), normal);
    std::sort(starts.begin(), starts.end(),
              [](const auto& l, const auto& r) { return l.first > r.first; });
    if (starts.size() > 6) starts.resize(6);

    std::mt19937 random(7);
    std::normal_distribution<double> bell;
    double best = starts.front().first;
    for (auto& [value, normal] : starts) {
        double step = 0.05;
        while (step > 1e-11) {
            bool better = false;
            for (int i = 0; i < 12; ++i) {
                const Vec3 tried =
                    (normal + step * Vec3(bell(random), bell(random), bell(random))).normalized();
                const double now = clearance.along(tried);
                if (!(now > value)) continue;
                value = now;
                normal = tried;
                better = true;
            }
            if (!better) step *= 0.6;
        }
        best = std::max(best, value);
    }
    return best;
}

inline Quat random_turn(std::mt19937& random)
{
    std::normal_distribution<double> bell;
    return Quat(bell(random), bell(random), bell(random), bell(random)).normalized();
}

inline Vec3 random_direction(std::mt19937& random)
{
    std::normal_distribution<double> bell;
    return Vec3(bell(random), bell(random), bell(random)).normalized();
}

}  // namespace throng::given
