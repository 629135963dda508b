// Polytope pairs: boxes and hulls placed against one another, for tests of methods that ask about
// two.
#pragma once

#include "cost/hard_cases/broken_pairs.hpp"
#include "kernels/geometry/separating_axes.hpp"
#include "kernels/math/turn_between.hpp"
#include "narrowphase/alternatives/convex_methods.hpp"
#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {

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
    double clearance = 0;  // m, below 0 minus the depth
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
    pair.b_in_a = {face_a * 0.3 + random.vector(-0.2, 0.2), turn_between(face_b, -face_a)};
    Vec3 normal;
    pair.clearance = polytope_separation(a, b, pair.b_in_a, &normal);
    if (pair.clearance < 0) {
        const double wanted =
            std::pow(10, random.number(-9, -3)) * (random.number(0, 3) < 1 ? 1 : -1);
        pair.b_in_a.position += normal * (wanted - pair.clearance);
        pair.clearance = wanted;
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
        pair.clearance = polytope_separation(a.view(), b.view(), pair.b_in_a, &normal);
        // From an overlap there is no way to part that is shorter than along its normal, so the gap
        // after a move along it is known.
        const double moved = scale_ * std::pow(10, random_.number(-9, -1.5));
        const double wanted = random_.number(-1, 1) < 0 ? -moved : moved;
        const bool wants = kind >= 3 && pair.clearance < std::min(0.0, wanted);
        if (wants) {
            pair.b_in_a.position += normal * (wanted - pair.clearance);
            pair.clearance = wanted;
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

/// Whether rounding has no say in whether they touch.
inline bool is_clear(const PolytopeCase& pair, double scale)
{
    return std::abs(pair.clearance) > 0.99e-9 * scale;
}

/// What a method has to say of a gap that is known.
inline OverlapState truth_of(double clearance)
{
    return clearance > 0 ? OverlapState::apart : OverlapState::touching;
}

/// m, by the axes of their faces and edges.
inline double separation_of(const ConvexPair& pair)
{
    const PolytopePair& shapes = *pair.polytopes();
    return polytope_separation(shapes.a, shapes.b, {shapes.shift, Quat(shapes.turn)}, nullptr);
}

/// Shows (shapes, pair) the hard boxes at each scale, but for those whose poses are given to fewer
/// digits than it takes to tell.
template <class Visitor>
void for_hard_boxes(Visitor&& visit)
{
    for (const BrokenPair& hard : broken_pairs()) {
        SCOPED_TRACE(hard.name);
        const double size = hard.a.size.norm() + hard.b.size.norm();
        if (std::abs(hard.separation) < 1e-8 * size) continue;
        for (const double scale : {1e-6, 1.0, 1e6}) {
            const Shapes shapes = two_boxes(hard.a.size * (scale / 2), hard.b.size * (scale / 2));
            Pose pose = inverse(hard.a.pose) * hard.b.pose;
            pose.position *= scale;
            visit(shapes, PolytopeCase{kBoxA, kBoxB, pose, hard.separation * scale});
        }
    }
}

/// A box or a hull of 8 to 60 points, about a meter across: round, or with points strewn in a box.
inline ShapeRef add_polytope(RandomShapes& random, double scale, Shapes& shapes)
{
    const double which = random.number(0, 3);
    if (which < 1) {
        shapes.boxes.push_back({random.vector(0.1, 0.6) * scale});
        return {ShapeKind::box, static_cast<std::uint32_t>(shapes.boxes.size() - 1)};
    }
    const int points = static_cast<int>(random.number(8, 60.99));
    if (which < 2) {
        shapes.hulls.push_back(random.hull(points, 0.5 * scale));
    } else {
        std::vector<Vec3> cloud;
        const Vec3 half = random.vector(0.1, 0.6);
        for (int i = 0; i < points; ++i)
            cloud.emplace_back(random.vector(-1, 1).cwiseProduct(half) * scale);
        shapes.hulls.push_back(build_hull(cloud).hull);
    }
    return {ShapeKind::hull, static_cast<std::uint32_t>(shapes.hulls.size() - 1)};
}

/// Far, near, touching, deep, contained, parallel or concentric, one after the other.
inline Pose meeting_pose(RandomShapes& random, int which, double scale)
{
    Pose pose{random.vector(-1, 1).normalized() * scale, random.turn()};
    switch (which % 7) {
    case 0:
        pose.position *= random.number(2, 10);
        break;
    case 1:
        pose.position *= random.number(0.9, 1.3);
        break;
    case 2:
        pose.position *= random.number(0.7, 1);
        break;
    case 3:
        pose.position *= random.number(0, 0.5);
        break;
    case 4:
        pose.position *= random.number(0, 0.05);
        break;
    case 5:
        pose.orientation = Quat(1, 0, 0, 0);
        pose.position *= random.number(0, 1.5);
        break;
    default:
        pose.position.setZero();
        if (which % 2 == 0) pose.orientation = Quat(1, 0, 0, 0);
        break;
    }
    return pose;
}

/// Such shapes in such poses, with gaps as they come. A few hundred shapes are enough: hulls take
/// longer to build than to ask about.
class MeetingPairs {
public:
    MeetingPairs(std::uint64_t seed, double scale) : random_(seed), scale_(scale)
    {
        for (int i = 0; i < 200; ++i) refs_.push_back(add_polytope(random_, scale, shapes_));
    }

    const Shapes& shapes() const { return shapes_; }
    void next()
    {
        a = any();
        b = count_ % 50 == 49 ? a : any();
        b_in_a = meeting_pose(random_, count_++, scale_);
    }

    ShapeRef a, b;
    Pose b_in_a;

private:
    ShapeRef any()
    {
        return refs_[static_cast<std::size_t>(
            random_.number(0, static_cast<double>(refs_.size())))];
    }

    RandomShapes random_;
    double scale_;
    int count_ = 0;
    Shapes shapes_;
    std::vector<ShapeRef> refs_;
};

}  // namespace throng
