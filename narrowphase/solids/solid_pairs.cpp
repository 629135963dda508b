#include "narrowphase/solids/solid_pairs.hpp"

#include "kernels/geometry/shape_bounds.hpp"
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
    touch_by_voxels(shapes, shapes.solids[solid.index], other, other_in_solid, reach, touches);
    const double size = std::min(size_of(shapes, solid), size_of(shapes, other));
    return make_patches(touches, reach, size, out);
}

}  // namespace throng
