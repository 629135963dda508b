#include "narrowphase/solid/solid_pairs.hpp"

#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/solid/image_touches.hpp"
#include "narrowphase/solid/touch_spheres.hpp"
#include "narrowphase/solid/voxel_pairs.hpp"

#include <algorithm>

namespace throng {
namespace {

// Half the diagonal of its box; a plane has no end.
double size_of(const Shapes& shapes, ShapeRef shape)
{
    if (shape.kind == ShapeKind::hull) return shapes.hulls[shape.index].outer_radius;
    const Box3 box = shape_bounds(shapes, shape, Pose{});
    return 0.5 * (box.upper - box.lower).norm();
}

// Of what stands for the shape: spheres may reach out of it by so much.
double error_of(const Shapes& shapes, ShapeRef shape)
{
    return shape.kind == ShapeKind::solid ? shapes.solids[shape.index].error : 0;
}

// How far two boxes are apart along the axis of the first that parts them most; below 0 where none
// does.
double gap_between(const Box3& a, const Box3& b)
{
    return std::max((a.lower - b.upper).maxCoeff(), (b.lower - a.upper).maxCoeff());
}

// How far the two are apart at least: their boxes as each sees the other's.
double least_gap(const Shapes& shapes, ShapeRef solid, ShapeRef other, const Pose& other_in_solid)
{
    const double gap = gap_between(shape_bounds(shapes, solid, Pose{}),
                                   shape_bounds(shapes, other, other_in_solid));
    if (other.kind != ShapeKind::solid && other.kind != ShapeKind::box) return gap;
    return std::max(gap,
                    gap_between(shape_bounds(shapes, other, Pose{}),
                                shape_bounds(shapes, solid, other_in_solid.inverse())));
}

// The other's spheres against this one, told from this one.
void touch_from_other(const Shapes& shapes,
                      ShapeRef solid,
                      ShapeRef other,
                      const Pose& other_in_solid,
                      double reach,
                      std::vector<SurfaceTouch>& touches)
{
    touch_by_spheres(shapes, other, solid, other_in_solid.inverse(), reach, {}, touches);
    for (SurfaceTouch& touch : touches) {
        touch.position = other_in_solid * touch.position;
        touch.normal = other_in_solid.orientation * -touch.normal;
    }
}

}  // namespace

SolidAnswer collide_solid(const Shapes& shapes,
                          ShapeRef solid,
                          ShapeRef other,
                          const Pose& other_in_solid,
                          double reach,
                          std::vector<PatchManifold>& out)
{
    SolidAnswer answer;
    answer.apart = least_gap(shapes, solid, other, other_in_solid) - error_of(shapes, solid)
        - error_of(shapes, other);
    if (answer.apart > reach) return answer;
    thread_local std::vector<SurfaceTouch> touches;
    touches.clear();
    const SolidWay way = shapes.solids[solid.index].way;
    const SolidWay other_way =
        other.kind == ShapeKind::solid ? shapes.solids[other.index].way : SolidWay::voxels;
    if (way == SolidWay::depth_image || other_way == SolidWay::depth_image)
        touch_by_depth_image(shapes, solid, other, other_in_solid, reach, touches);
    else if (way == SolidWay::spheres)
        touch_by_spheres(shapes, solid, other, other_in_solid, reach, {}, touches);
    else if (other_way == SolidWay::spheres)
        touch_from_other(shapes, solid, other, other_in_solid, reach, touches);
    else
        answer.apart = std::max(answer.apart,
                                touch_by_voxels(shapes, shapes.solids[solid.index], other,
                                                other_in_solid, reach, touches));
    const double size = std::min(size_of(shapes, solid), size_of(shapes, other));
    answer.left_out = make_patches(touches, reach, size, out);
    return answer;
}

}  // namespace throng
