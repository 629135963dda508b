#include "narrowphase/ccd/impact_of_spheres.hpp"

#include "narrowphase/ccd/moving_balls.hpp"
#include "narrowphase/solid/sphere_separations.hpp"
#include "narrowphase/solid/sphere_walk.hpp"

namespace throng {
namespace {

using Node = SphereTree::Node;

Vec3 center_of(const Node& node) { return node.center.cast<double>(); }

MovingShape ball_of(const MovingShape& moving, const Node& node)
{
    MovingShape ball = moving;
    ball.pieces = false;
    ball.local = moving.local * Pose{center_of(node), Quat::Identity()};
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
        : shapes_(shapes), a_(a), b_(b), begin_(begin), rule_(rule), ways_(a, b, begin)
    {
        first_.time = end;
    }

    /// Of two trees.
    Impact among(const SphereTree& a, const SphereTree& b)
    {
        visit_sphere_pairs(
            a, b,
            [&](const Node& p, const Node& q) {
                const double wide = double{p.bound} + double{q.bound} + rule_.close;
                return ways_.may_meet(center_of(p), center_of(q), wide, left());
            },
            [&](const Node& p, const Node& q) { process(ball_of(a_, p), ball_of(b_, q)); });
        return told();
    }

    /// Of a tree and a shape that has none.
    Impact among(const SphereTree& a)
    {
        visit_spheres(
            a, [&](const Node& node) { return may_meet(node); },
            [&](const Node& node, std::uint32_t) { process(ball_of(a_, node), b_); });
        return told();
    }

private:
    double left() const { return first_.time - begin_; }

    // Whether a ball about a node may come within `close` of the other shape as a whole.
    bool may_meet(const Node& node) const
    {
        const Vec3 center = center_of(node);
        const double wide = double{node.bound} + rule_.close + ways_.approach(center, left());
        return distance_from(shapes_, b_.shape, ways_.seen_from_b(center), wide) <= wide;
    }

    void process(const MovingShape& a, const MovingShape& b)
    {
        const Impact impact = time_of_impact(shapes_, a, b, begin_, first_.time, rule_);
        evaluations_ += impact.evaluations;
        if (impact.state != ToiState::hit) return;
        if (first_.state == ToiState::hit && !(impact.time < first_.time)) return;
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
    MovingBalls ways_;
    Impact first_;
    int evaluations_ = 0;
};

}  // namespace

bool stands_as_spheres(const Shapes& shapes, const MovingShape& moving)
{
    return moving.pieces && moving.shape.kind == ShapeKind::solid
        && !shapes.solids[moving.shape.index].spheres.levels.empty();
}

Impact impact_of_spheres(const Shapes& shapes,
                         const MovingShape& a,
                         const MovingShape& b,
                         double begin,
                         double end,
                         const ImpactRule& rule)
{
    if (!stands_as_spheres(shapes, a)) {
        Impact impact = impact_of_spheres(shapes, b, a, begin, end, rule);
        impact.normal = -impact.normal;
        return impact;
    }
    const SphereTree& tree = shapes.solids[a.shape.index].spheres;
    FirstOfPieces pieces(shapes, a, b, begin, end, rule);
    if (!stands_as_spheres(shapes, b)) return pieces.among(tree);
    return pieces.among(tree, shapes.solids[b.shape.index].spheres);
}

}  // namespace throng
