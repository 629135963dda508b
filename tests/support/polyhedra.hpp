// Polyhedra: random boxes, hulls and poses, and what the tests of polyhedral pairs ask of them.
#pragma once

#include "cooking/hulls/hull.hpp"
#include "kernels/geometry/polytope.hpp"
#include "narrowphase/alternatives/direction_sweep.hpp"
#include "narrowphase/convex/pair_functions.hpp"
#include "tests/support/finite_manifold.hpp"

#include <algorithm>
#include <random>

namespace throng {

class RandomShapes {
public:
    explicit RandomShapes(std::uint64_t seed) : engine_(seed) { }

    double number(double low, double high)
    {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) / 9007199254740992.0);
    }
    Vec3 vector(double low, double high)
    {
        return {number(low, high), number(low, high), number(low, high)};
    }
    Quat turn()
    {
        Quat turn(number(-1, 1), number(-1, 1), number(-1, 1), number(-1, 1));
        return turn.normalized();
    }
    Pose pose(double spread) { return {vector(-spread, spread), turn()}; }

    /// Points on a ball of the radius, made into a hull.
    Hull hull(int points, double radius)
    {
        std::vector<Vec3> cloud;
        for (int i = 0; i < points; ++i) cloud.push_back(vector(-1, 1).normalized() * radius);
        return build_hull(cloud).hull;
    }

private:
    std::mt19937_64 engine_;
};

inline std::vector<Vec3> corners_of(const Vec3& half)
{
    const BoxPolytope box(half);
    return {box.vertices.begin(), box.vertices.end()};
}

/// How far corners of the faces lie beneath their planes, at most: more than rounding only where a
/// hull's faces were put together of triangles that are not quite in one plane.
inline double stray_of(const PolytopeView& shape)
{
    double most = 0;
    for (std::size_t face = 0; face < shape.normals.size(); ++face) {
        for (const std::uint16_t vertex : shape.face(face)) {
            const double along = shape.normals[face].dot(shape.vertices[vertex]);
            most = std::max(most, shape.offsets[face] - along);
        }
    }
    return most;
}

inline Shapes two_boxes(const Vec3& half_a, const Vec3& half_b)
{
    Shapes shapes;
    shapes.boxes = {{half_a}, {half_b}};
    return shapes;
}

inline constexpr ShapeRef kBoxA{ShapeKind::box, 0}, kBoxB{ShapeKind::box, 1};

inline Pose at(double x, double y, double z) { return {{x, y, z}, Quat::Identity()}; }

inline Pose inverse(const Pose& pose)
{
    return {pose.to_local(Vec3::Zero()), pose.orientation.conjugate()};
}

template <class Real>
PoseT<Real> cast(const Pose& pose)
{
    return {pose.position.cast<Real>(), pose.orientation.cast<Real>()};
}

template <class Real>
LocalManifold<Real> run(PairFunction<Real> function,
                        const Shapes& shapes,
                        ShapeRef a,
                        ShapeRef b,
                        const Pose& pose,
                        double extent)
{
    PairCache cache;
    LocalManifold<Real> out;
    function({shapes, a, b, cast<Real>(pose), static_cast<Real>(extent)}, cache, out);
    return out;
}

/// Separation of the deepest point; infinite where there is none.
template <class Real>
double deepest(const LocalManifold<Real>& manifold)
{
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < manifold.count; ++i) {
        const auto& point = manifold.points[static_cast<std::size_t>(i)];
        least = std::min(least, static_cast<double>(point.separation));
    }
    return least;
}

template <class Real>
bool features_differ(const LocalManifold<Real>& manifold)
{
    for (int i = 0; i < manifold.count; ++i) {
        for (int j = 0; j < i; ++j) {
            if (manifold.points[static_cast<std::size_t>(i)].feature
                == manifold.points[static_cast<std::size_t>(j)].feature)
                return false;
        }
    }
    return true;
}

/// How far a cloud of points reaches, placed and turned.
inline Extent extent_of(std::vector<Vec3> points, const Pose& pose)
{
    for (Vec3& point : points) point = pose * point;
    return [points = std::move(points)](const Vec3& direction) {
        double most = -std::numeric_limits<double>::infinity();
        for (const Vec3& point : points) most = std::max(most, direction.dot(point));
        return most;
    };
}

}  // namespace throng
