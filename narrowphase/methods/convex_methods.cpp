#include "narrowphase/methods/convex_methods.hpp"

#include "narrowphase/methods/ask_gjk.hpp"
#include "narrowphase/methods/ask_sat.hpp"
#include "narrowphase/methods/bounding_ball.hpp"
#include "narrowphase/methods/chung_wang.hpp"
#include "narrowphase/methods/clip_volume.hpp"
#include "narrowphase/methods/containment.hpp"
#include "narrowphase/methods/k_dop.hpp"

namespace throng {
namespace {

bool is_polytope(ShapeRef shape)
{
    return shape.kind == ShapeKind::box || shape.kind == ShapeKind::hull;
}

constexpr ConvexMethod kMethods[] = {
    {"containment", "vertices inside and edges through faces, as in the first textbooks",
     tells_touch, true, ask_containment},
    {"clip_volume", "one polytope cut by the planes of the other, and what is left measured",
     tells_touch | tells_volume, true, ask_clip_volume},
    {"sat", "every axis that could part two polytopes", tells_touch | tells_depth, true, ask_sat},
    {"chung_wang", "the search for a direction that parts the two", tells_touch, false,
     ask_chung_wang},
    {"gjk", "the distance by GJK, the depth by EPA", tells_touch | tells_distance | tells_depth,
     false, ask_gjk},
    {"sphere", "filter: balls round the two", tells_touch, false, ask_bounding_ball},
    {"k_dop:6", "filter: slabs along the axes", tells_touch, false, ask_k_dop<6>},
    {"k_dop:14", "filter: slabs along axes and cube's corners", tells_touch, false, ask_k_dop<14>},
    {"k_dop:18", "filter: slabs along axes and cube's edges", tells_touch, false, ask_k_dop<18>},
    {"k_dop:26", "filter: slabs along axes, corners and edges", tells_touch, false, ask_k_dop<26>},
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
