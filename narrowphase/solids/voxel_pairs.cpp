#include "narrowphase/solids/voxel_pairs.hpp"

#include "narrowphase/solids/surface_walk.hpp"
#include "narrowphase/solids/voxel_probes.hpp"

#include <algorithm>

namespace throng {
namespace {

Pose inverse(const Pose& pose)
{
    const Quat back = pose.orientation.conjugate();
    return {back * -pose.position, back};
}

std::vector<PointTouch>& scratch()
{
    thread_local std::vector<PointTouch> found;
    found.clear();
    return found;
}

// Points of a: out of the other shape is from b to a.
template <class Other>
void touch_points_of_a(const Solid& a,
                       const Other& other,
                       const Pose& other_in_a,
                       double reach,
                       std::vector<SurfaceTouch>& out)
{
    std::vector<PointTouch>& found = scratch();
    walk_surface(a.points, other, other_in_a, reach, found);
    for (const PointTouch& touch : found)
        out.push_back({touch.position - touch.outward * (touch.distance / 2), -touch.outward,
                       touch.distance, touch_feature(TouchSide::a, touch.point)});
}

void touch_points_of_b(const Solid& a,
                       const Solid& b,
                       const Pose& b_in_a,
                       double reach,
                       std::vector<SurfaceTouch>& out)
{
    std::vector<PointTouch>& found = scratch();
    walk_surface(b.points, FieldSide(a), inverse(b_in_a), reach, found);
    const Mat3 turn = b_in_a.orientation.toRotationMatrix();
    for (const PointTouch& touch : found) {
        const Vec3 between = touch.position - touch.outward * (touch.distance / 2);
        out.push_back({turn * between + b_in_a.position, turn * touch.outward, touch.distance,
                       touch_feature(TouchSide::b, touch.point)});
    }
}

// Behind a static mesh nothing says how thick it is: no deeper than half of the solid, and than
// four of the distances between its points.
double deepest_behind(const Solid& a, const FieldSide& field)
{
    return std::min(0.25 * (field.box().upper - field.box().lower).minCoeff(),
                    4 * a.points.spacing);
}

}  // namespace

void touch_by_voxels(const Shapes& shapes,
                     const Solid& a,
                     ShapeRef other,
                     const Pose& other_in_a,
                     double reach,
                     std::vector<SurfaceTouch>& out)
{
    const bool has_field = !a.field.empty();
    switch (other.kind) {
    case ShapeKind::solid: {
        const Solid& b = shapes.solids[other.index];
        if (!b.field.empty()) touch_points_of_a(a, FieldSide(b), other_in_a, reach, out);
        if (has_field) touch_points_of_b(a, b, other_in_a, reach, out);
        return;
    }
    case ShapeKind::mesh: {
        const Mesh& mesh = shapes.meshes[other.index];
        const FieldSide field(a);
        touch_points_of_a(a, MeshSide(mesh, reach, deepest_behind(a, field)), other_in_a, reach,
                          out);
        if (has_field) probe_mesh(a, mesh, other_in_a, reach, out);
        return;
    }
    default:
        touch_points_of_a(a, ConvexSide(shapes, other), other_in_a, reach, out);
        if (has_field && other.kind != ShapeKind::plane)
            probe_convex(shapes, a, other, other_in_a, reach, out);
    }
}

}  // namespace throng
