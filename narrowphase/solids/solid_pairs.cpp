#include "narrowphase/solids/solid_pairs.hpp"

#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/methods/touch_spheres.hpp"
#include "narrowphase/solids/image_touches.hpp"
#include "narrowphase/solids/voxel_pairs.hpp"

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

// The other's spheres against this one, told from this one.
void touch_from_other(const Shapes& shapes,
                      ShapeRef solid,
                      ShapeRef other,
                      const Pose& other_in_solid,
                      double reach,
                      std::vector<SurfaceTouch>& touches)
{
    const Quat back = other_in_solid.orientation.conjugate();
    const Pose solid_in_other{-(back * other_in_solid.position), back};
    touch_by_spheres(shapes, other, solid, solid_in_other, reach, {}, touches);
    for (SurfaceTouch& touch : touches) {
        touch.position = other_in_solid * touch.position;
        touch.normal = other_in_solid.orientation * -touch.normal;
    }
}

}  // namespace

std::size_t collide_solid(const Shapes& shapes,
                          ShapeRef solid,
                          ShapeRef other,
                          const Pose& other_in_solid,
                          double reach,
                          std::vector<PatchManifold>& out)
{
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
        touch_by_voxels(shapes, shapes.solids[solid.index], other, other_in_solid, reach, touches);
    const double size = std::min(size_of(shapes, solid), size_of(shapes, other));
    return make_patches(touches, reach, size, out);
}

}  // namespace throng
