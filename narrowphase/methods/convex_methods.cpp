#include "narrowphase/methods/convex_methods.hpp"

#include "narrowphase/methods/clip_volume.hpp"
#include "narrowphase/methods/separating_axes.hpp"

namespace throng {

namespace {

bool is_polytope(ShapeRef shape)
{
    return shape.kind == ShapeKind::box || shape.kind == ShapeKind::hull;
}

constexpr ConvexMethod kMethods[] = {
    {"sat", "every axis that could part two polytopes", kTellsTouch | kTellsDepth, true, ask_sat},
    {"clip_volume", "one polytope cut by the planes of the other, and what is left measured",
     kTellsTouch | kTellsVolume, true, ask_clip_volume},
};

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
    cores_ = CorePair(shapes_, a_, b_, b_in_a);
    if (polytopes_) polytopes_.emplace(shape_a_->view(), shape_b_->view(), b_in_a);
}

std::span<const ConvexMethod> convex_methods() { return kMethods; }

const ConvexMethod* find_convex_method(std::string_view name)
{
    for (const ConvexMethod& method : kMethods)
        if (method.name == name) return &method;
    return nullptr;
}

}  // namespace throng
