#include "narrowphase/convex/convex_pair.hpp"

namespace throng {
namespace {

bool is_polytope(ShapeRef shape)
{
    return shape.kind == ShapeKind::box || shape.kind == ShapeKind::hull;
}

}  // namespace

ConvexPair::ConvexPair(const Shapes& shapes, ShapeRef a, ShapeRef b, const Pose& b_in_a)
    : shapes_(shapes), a_(a), b_(b), cores_(shapes, a, b, b_in_a)
{
    if (is_polytope(a) && is_polytope(b)) {
        shape_a_.emplace(shapes, a);
        shape_b_.emplace(shapes, b);
        polytopes_.emplace(shape_a_->view(), shape_b_->view(), b_in_a);
    }
}

void ConvexPair::place(const Pose& b_in_a)
{
    cores_ = ConvexCorePair(shapes_, a_, b_, b_in_a);
    if (polytopes_) polytopes_.emplace(shape_a_->view(), shape_b_->view(), b_in_a);
}

}  // namespace throng
