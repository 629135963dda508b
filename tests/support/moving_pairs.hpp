// Moving pairs: random shapes on random ways, and a plain look at how far apart they are.
#pragma once

#include "cooking/hulls/hull.hpp"
#include "kernels/geometry/gjk.hpp"
#include "kernels/math/rotation.hpp"
#include "narrowphase/ccd/time_of_impact.hpp"
#include "tests/support/dice.hpp"

namespace throng::test {

/// Two shapes on their ways, and what they are made of.
struct MovingPair {
    Shapes shapes;
    MovingShape a, b;
};

inline ShapeRef random_shape(Dice& dice, ShapeKind kind, Shapes& shapes)
{
    const auto put = [&](auto& list, auto shape) {
        list.push_back(std::move(shape));
        return ShapeRef{kind, static_cast<std::uint32_t>(list.size() - 1)};
    };
    const double small = dice.between(0.05, 0.5), great = dice.between(0.05, 1);
    switch (kind) {
    case ShapeKind::sphere:
        return put(shapes.spheres, Sphere{small});
    case ShapeKind::capsule:
        return put(shapes.capsules, Capsule{small / 2, great});
    case ShapeKind::cylinder:
        return put(shapes.cylinders, Cylinder{small, great});
    case ShapeKind::box:
        return put(shapes.boxes, Box{{small, great, dice.between(0.05, 1)}});
    default:
        break;
    }
    std::vector<Vec3> points;
    for (int i = 0; i < 12; ++i) points.push_back(dice.point(0.7));
    return put(shapes.hulls, build_hull(points).hull);
}

inline constexpr ShapeKind kConvexKinds[] = {ShapeKind::sphere, ShapeKind::capsule,
                                             ShapeKind::cylinder, ShapeKind::box, ShapeKind::hull};

/// Beside one another, on ways that often cross, both turning by up to `turn` on each axis, and by
/// up to `spin` on each of their own.
inline MovingPair random_pair(Dice& dice, double turn, double spin = 0)
{
    MovingPair pair;
    pair.a.shape = random_shape(dice, kConvexKinds[dice.below(5)], pair.shapes);
    pair.b.shape = random_shape(dice, kConvexKinds[dice.below(5)], pair.shapes);
    pair.a.trajectory = {{dice.point(1), dice.turn()}, dice.point(3), dice.point(turn)};
    pair.b.trajectory = {{dice.point(1) + Vec3(2.5, 0, 0), dice.turn()},
                         dice.point(3) - Vec3(2.5, 0, 0),
                         dice.point(turn)};
    if (dice.chance(0.3)) pair.a.local = {dice.point(0.5), dice.turn()};
    if (spin == 0) return pair;
    // Along its length as well: what a rod spins about does not move it.
    pair.a.trajectory.spin =
        dice.chance(0.5) ? Vec3(0, 0, dice.between(-spin, spin)) : dice.point(spin);
    pair.b.trajectory.spin = dice.point(spin);
    return pair;
}

/// The distance of two convex shapes at a time, m; 0 where they overlap.
inline double distance_at(const MovingPair& pair, double time)
{
    const Pose a = pair.a.trajectory.at(time) * pair.a.local;
    const Pose b = pair.b.trajectory.at(time) * pair.b.local;
    const ConvexCorePair cores(pair.shapes, pair.a.shape, pair.b.shape,
                               {a.to_local(b.position), a.orientation.conjugate() * b.orientation});
    const Distance found = gjk(cores, 1e30);
    return found.apart
        ? std::max(0.0, found.distance - cores.a.convex_radius - cores.b.convex_radius)
        : 0;
}

/// m a unit of time, no point of either moves faster.
inline double greatest_speed(const MovingPair& pair)
{
    const auto of = [&](const MovingShape& moving) {
        const double extent =
            moving.local.position.norm() + convex_core_of<double>(pair.shapes, moving.shape).size;
        return moving.trajectory.shift.norm() + moving.trajectory.angle() * extent;
    };
    return of(pair.a) + of(pair.b);
}

/// The plain answer: the distance at so many times, of which the first that may have a touch just
/// before or after it. What lies further apart than the way of half the time between two cannot
/// have touched there.
struct Sampled {
    double least = 1e30;     // m, of all samples
    double first_near = 2;   // time of the first sample within reach of a touch; 2: none
    double first_touch = 2;  // of the first that touches
};

inline Sampled sample(const MovingPair& pair, double end, double close, int count)
{
    Sampled sampled;
    const double way = greatest_speed(pair) * end / count / 2;
    for (int i = 0; i <= count; ++i) {
        const double time = end * i / count, distance = distance_at(pair, time);
        sampled.least = std::min(sampled.least, distance);
        if (distance <= way + close) sampled.first_near = std::min(sampled.first_near, time);
        if (distance <= close) sampled.first_touch = std::min(sampled.first_touch, time);
    }
    return sampled;
}

inline constexpr ToiMethod kToiMethods[] = {ToiMethod::newton, ToiMethod::bisection,
                                            ToiMethod::conservative};

}  // namespace throng::test
