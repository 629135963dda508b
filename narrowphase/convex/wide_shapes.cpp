#include "narrowphase/convex/wide_shapes.hpp"

#include "kernels/geometry/polytope.hpp"
#include "kernels/geometry/wide_hull.hpp"

#include <algorithm>

namespace throng {
namespace {

// A box of half extents 1: what the others share with it is all but corners and offsets.
Hull unit_box()
{
    const BoxPolytope box(Vec3::Ones());
    const PolytopeView view = box.view();
    Hull hull;
    hull.vertices.assign(view.vertices.begin(), view.vertices.end());
    hull.normals.assign(view.normals.begin(), view.normals.end());
    hull.offsets.assign(view.offsets.begin(), view.offsets.end());
    hull.face_begin.assign(view.face_begin.begin(), view.face_begin.end());
    hull.face_vertices.assign(view.face_vertices.begin(), view.face_vertices.end());
    hull.edges.assign(view.edges.begin(), view.edges.end());
    hull.inner_radius = view.inner_radius;
    hull.outer_radius = view.outer_radius;
    widen(hull);
    return hull;
}

}  // namespace

WideShape::WideShape(const Shapes& shapes, ShapeRef shape)
{
    if (shape.kind == ShapeKind::box) {
        be_box(shapes.boxes[shape.index].half_extents);
        return;
    }
    const Hull& hull = shapes.hulls[shape.index];
    suited_ = hull.wide.vertices > 0;
    if (!suited_) return;
    view_ = hull.wide.view();
    center_ = hull.center;
}

void WideShape::be_box(const Vec3& half_extents)
{
    static const Hull unit = unit_box();
    view_ = unit.wide.view();
    const Vec3T<float> half = half_extents.cast<float>();
    std::copy_n(view_.numbers, std::size(box_), box_);
    float* row = box_;
    for (const float extent : half)
        for (int i = 0; i < kWideGroup; ++i) *row++ *= extent;
    float* offsets = row + 3 * kWideGroup;
    for (int i = 0; i < 6; ++i) offsets[i] = half[i / 2];
    view_.numbers = box_;
    view_.inner = half.minCoeff();
    view_.outer = half.norm();
    suited_ = is_wide(half_extents.minCoeff(), half_extents.norm());
}

}  // namespace throng
