// Polytope pairs: random boxes and hulls placed against one another at a gap that is known.
#pragma once

#include "narrowphase/methods/separating_axes.hpp"
#include "tests/narrowphase/polyhedra.hpp"

#include <cmath>

namespace throng::testing {

/// Boxes, and hulls of 8 to 60 vertices, of radii from a twentieth of the scale to the scale.
inline Shapes pool_of_polytopes(std::uint64_t seed, double scale)
{
    RandomShapes random(seed);
    Shapes shapes;
    for (int i = 0; i < 24; ++i) {
        const double radius = scale * std::pow(20, -random.number(0, 1));
        shapes.boxes.push_back({random.vector(0.2, 1) * (radius / 1.8)});
        shapes.hulls.push_back(random.hull(8 + (i * i * 52) / (23 * 23), radius));
    }
    return shapes;
}

/// Prisms whose ends have many corners, none quite in the plane of the end.
inline Shapes uneven_prisms(std::uint64_t seed)
{
    RandomShapes random(seed);
    Shapes shapes;
    for (int corners = 6; corners < 60; corners += 9) {
        std::vector<Vec3> cloud;
        for (int i = 0; i < 2 * corners; ++i) {
            const double turn = 6.283185307179586 * (i / 2 + random.number(-0.3, 0.3)) / corners;
            const double height = (i % 2 == 0 ? 0.3 : -0.3) + random.number(-4e-6, 4e-6);
            cloud.emplace_back(0.5 * std::cos(turn), 0.5 * std::sin(turn), height);
        }
        shapes.hulls.push_back(build_hull(cloud).hull);
    }
    return shapes;
}

struct PolytopeCase {
    ShapeRef a, b;
    Pose b_in_a;
    double gap = 0;  // m, below 0 minus the depth
};

/// Two of the prisms, near one another: a face of each against the other.
inline PolytopeCase face_to_face(const Shapes& prisms, RandomShapes& random)
{
    const auto most = static_cast<double>(prisms.hulls.size());
    PolytopeCase pair;
    pair.a = {ShapeKind::hull, static_cast<std::uint32_t>(random.number(0, most))};
    pair.b = {ShapeKind::hull, static_cast<std::uint32_t>(random.number(0, most))};
    const auto any_normal = [&](const Hull& hull) {
        const auto faces = static_cast<double>(hull.normals.size());
        return hull.normals[static_cast<std::size_t>(random.number(0, faces))];
    };
    const PolytopeView a = view_of(prisms.hulls[pair.a.index]);
    const PolytopeView b = view_of(prisms.hulls[pair.b.index]);
    const Vec3 face_a = any_normal(prisms.hulls[pair.a.index]);
    const Vec3 face_b = any_normal(prisms.hulls[pair.b.index]);
    pair.b_in_a = {face_a * 0.3 + random.vector(-0.2, 0.2), Quat::FromTwoVectors(face_b, -face_a)};
    Vec3 normal;
    pair.gap = polytope_separation(a, b, pair.b_in_a, &normal);
    if (pair.gap < 0) {
        const double wanted =
            std::pow(10, random.number(-9, -3)) * (random.number(0, 3) < 1 ? 1 : -1);
        pair.b_in_a.position += normal * (wanted - pair.gap);
        pair.gap = wanted;
    }
    return pair;
}

/// Places shapes of a pool against one another: as they come, concentric, one inside the other,
/// face to face, and moved to gaps and depths down to 1e-9 of the scale.
class RandomPairs {
public:
    RandomPairs(const Shapes& shapes, std::uint64_t seed, double scale)
        : shapes_(shapes), random_(seed), scale_(scale)
    { }

    PolytopeCase next()
    {
        PolytopeCase pair{any(), any(), random_.pose(scale_ * 0.7), 0};
        const int kind = count_++ % 8;
        if (kind == 0) pair.b_in_a.position *= 2;
        if (kind == 1) pair.b_in_a.position.setZero();
        if (kind == 2) pair.b_in_a.position *= 0.05;
        if (kind == 3 || kind == 4) {
            pair.a.kind = pair.b.kind = ShapeKind::box;
            pair.b_in_a.orientation = quarter_turns();
            if (kind == 4) pair.b_in_a.position *= 0.3;
        }
        const PolytopeShape a(shapes_, pair.a), b(shapes_, pair.b);
        Vec3 normal;
        pair.gap = polytope_separation(a.view(), b.view(), pair.b_in_a, &normal);
        // From an overlap there is no way to part that is shorter than along its normal, so the gap
        // after a move along it is known.
        const double moved = scale_ * std::pow(10, random_.number(-9, -1.5));
        const double wanted = random_.number(-1, 1) < 0 ? -moved : moved;
        const bool wants = kind >= 3 && pair.gap < std::min(0.0, wanted);
        if (wants) {
            pair.b_in_a.position += normal * (wanted - pair.gap);
            pair.gap = wanted;
        }
        return pair;
    }

private:
    ShapeRef any()
    {
        const auto index = static_cast<std::uint32_t>(random_.number(0, 24));
        return {random_.number(0, 1) < 0.5 ? ShapeKind::box : ShapeKind::hull, index};
    }
    Quat quarter_turns()
    {
        const double quarter = 1.5707963267948966;
        const auto turns = [&] { return std::floor(random_.number(0, 4)) * quarter; };
        return Quat(Eigen::AngleAxisd(turns(), Vec3::UnitX()))
            * Quat(Eigen::AngleAxisd(turns(), Vec3::UnitZ()));
    }

    const Shapes& shapes_;
    RandomShapes random_;
    double scale_;
    int count_ = 0;
};

/// How far corners of the faces lie beneath their planes, at most.
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

/// Whether rounding has no say in whether they touch.
inline bool is_clear(const PolytopeCase& pair, double scale)
{
    return std::abs(pair.gap) > 0.99e-9 * scale;
}

}  // namespace throng::testing
