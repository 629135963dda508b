// Method pairs: pairs of boxes and hulls as they come, for tests of methods that ask about two.
#pragma once

#include "narrowphase/methods/convex_methods.hpp"
#include "tests/narrowphase/polyhedra.hpp"

namespace throng {

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

/// A few hundred shapes are enough: hulls take longer to build than to ask about.
class PolytopeCases {
public:
    PolytopeCases(std::uint64_t seed, double scale) : random_(seed), scale_(scale)
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
