#include "narrowphase/impact/impact_of_spheres.hpp"

#include "narrowphase/methods/sphere_gaps.hpp"
#include "narrowphase/methods/sphere_walk.hpp"

#include <algorithm>

namespace throng {
namespace {

using Node = SphereTree::Node;

// A shape on its way as it was when that began. Places from where its body turns about.
class Start {
public:
    Start(const MovingShape& moving, double begin)
        : body_(moving.sweep.at(begin)), shape_(body_ * moving.local),
          turn_(shape_.orientation.toRotationMatrix()), from_body_(shape_.position - body_.position)
    { }

    Vec3 body() const { return body_.position; }
    const Pose& shape() const { return shape_; }
    Vec3 arm(const Node& node) const { return turn_ * node.center.cast<double>() + from_body_; }

private:
    Pose body_, shape_;  // the latter of the shape's own axes
    Mat3 turn_;
    Vec3 from_body_;
};

MovingShape ball_of(const MovingShape& moving, const Node& node)
{
    MovingShape ball = moving;
    ball.spheres = false;
    ball.local = moving.local * Pose{node.center.cast<double>(), Quat::Identity()};
    ball.ball = double{node.radius};
    return ball;
}

// The first impact of pieces of two shapes.
class FirstOfPieces {
public:
    FirstOfPieces(const Shapes& shapes,
                  const MovingShape& a,
                  const MovingShape& b,
                  double begin,
                  double end,
                  const ImpactRule& rule)
        : shapes_(shapes), a_(a), b_(b), begin_(begin), rule_(rule), from_a_(a, begin),
          from_b_(b, begin), shift_(b.sweep.shift - a.sweep.shift), turn_a_(a.sweep.turn.norm()),
          turn_b_(b.sweep.turn.norm())
    {
        first_.time = end;
    }

    /// Of two trees.
    Impact among(const SphereTree& a, const SphereTree& b)
    {
        visit_sphere_pairs(
            a, b, [&](const Node& p, const Node& q) { return may_meet(p, q); },
            [&](const Node& p, const Node& q) { look_at(ball_of(a_, p), ball_of(b_, q)); });
        return told();
    }

    /// Of a tree and a shape that has none.
    Impact among(const SphereTree& a)
    {
        visit_spheres(
            a, [&](const Node& node) { return may_meet(node); },
            [&](const Node& node, std::uint32_t) { look_at(ball_of(a_, node), b_); });
        return told();
    }

private:
    double left() const { return first_.time - begin_; }

    // m, that turning at so much takes a point of a body at most.
    double turning(double turn, double arm) const { return std::min(2.0, turn * left()) * arm; }

    // Whether balls about the two nodes may come within `close` of one another: along a straight
    // way, but for what turning adds.
    bool may_meet(const Node& p, const Node& q) const
    {
        const Vec3 arm_p = from_a_.arm(p), arm_q = from_b_.arm(q);
        const double wide = double{p.bound} + double{q.bound} + rule_.close
            + turning(turn_a_, arm_p.norm()) + turning(turn_b_, arm_q.norm());
        const Vec3 apart = from_b_.body() + arm_q - from_a_.body() - arm_p, way = shift_ * left();
        const double along = way.squaredNorm();
        const double part = along > 0 ? std::clamp(-apart.dot(way) / along, 0.0, 1.0) : 0;
        return (apart + part * way).squaredNorm() <= wide * wide;
    }

    // The same of a node and the other shape as a whole, which may turn under it.
    bool may_meet(const Node& node) const
    {
        const Vec3 arm = from_a_.arm(node), at = from_a_.body() + arm;
        const double own = shift_.norm() * left() + turning(turn_a_, arm.norm());
        const double under = turning(turn_b_, (at - from_b_.body()).norm() + own);
        const double wide = double{node.bound} + rule_.close + own + under;
        return distance_from(shapes_, b_.shape, from_b_.shape().to_local(at), wide) <= wide;
    }

    void look_at(const MovingShape& a, const MovingShape& b)
    {
        const Impact impact = impact_time(shapes_, a, b, begin_, first_.time, rule_);
        evaluations_ += impact.evaluations;
        if (impact.meeting != Meeting::meet) return;
        if (first_.meeting == Meeting::meet && !(impact.time < first_.time)) return;
        first_ = impact;
    }

    Impact told() const
    {
        Impact first = first_;
        first.evaluations = evaluations_;
        return first;
    }

    const Shapes& shapes_;
    const MovingShape &a_, &b_;
    double begin_;
    const ImpactRule& rule_;
    Start from_a_, from_b_;
    Vec3 shift_;
    double turn_a_, turn_b_;
    Impact first_;
    int evaluations_ = 0;
};

}  // namespace

Impact impact_of_spheres(const Shapes& shapes,
                         const MovingShape& a,
                         const MovingShape& b,
                         double begin,
                         double end,
                         const ImpactRule& rule)
{
    if (!a.spheres) {
        Impact impact = impact_of_spheres(shapes, b, a, begin, end, rule);
        impact.normal = -impact.normal;
        return impact;
    }
    const SphereTree& tree = shapes.solids[a.shape.index].spheres;
    FirstOfPieces pieces(shapes, a, b, begin, end, rule);
    return b.spheres ? pieces.among(tree, shapes.solids[b.shape.index].spheres)
                     : pieces.among(tree);
}

}  // namespace throng
