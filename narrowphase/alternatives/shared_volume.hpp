// Shared volume: what two closed shapes have in common, by counting and by parts.
//
// Counted along rays (depth images) or cell by cell (voxels) the error falls with the square of the
// resolution, on flat faces that lie along the grid with the first power of it. Exactly, for meshes
// and polytopes, in time that grows with the product of the numbers of triangles.
#pragma once

#include "kernels/data/shapes.hpp"
#include "kernels/geometry/depth_image.hpp"

namespace throng {

/// Two closed shapes, b placed in a's frame: sphere, capsule, cylinder, box, hull, solid, or a mesh
/// that is_closed(). Keep the shapes while it is in use.
struct VolumePair {
    const Shapes& shapes;
    ShapeRef a, b;
    Pose b_in_a;
};

/// What two shapes share, in a's frame.
///
///   volume  m3
///   center  of it, m; 0 where there is no volume
///   normal  unit: the way in which moving b lessens the volume fastest; 0 where no surface says,
///   as
///           where one lies inside the other, and where the way does not tell
///   depth   m, the longest stretch along the normal inside both; 0 where the way does not tell
struct SharedVolume {
    double volume = 0;
    Vec3 center = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    double depth = 0;
};

/// The same as seen along one direction.
///
///   push     m2, of the areas of what is shared, along their outward normals, those on a less
///   those
///            on b, the part along the direction: exact for what the rays see
///   longest  m, inside both, along the direction
struct RayLook {
    double volume = 0;
    Vec3 center = Vec3::Zero();
    double push = 0, longest = 0;
};

/// Looks at a pair along rays.
///
///   direction  unit, in a's frame
///   rays       along the longer side of what the two bounds share, seen along the direction; above
///   0 layers     `single` has its failure stated there offset     of the grid, in pixels, 0 to 1;
///   0.5 puts rays in the middle of their pixels
RayLook look_along(const VolumePair& pair,
                   const Vec3& direction,
                   int rays,
                   Layers layers = Layers::all,
                   const std::array<double, 2>& offset = {0.5, 0.5});

/// By depth images along the three axes of a, whose mean it is, and along the normal for the depth.
///
/// Source: Faure, Barbier, Allard, Falipou, Image-based collision detection and response between
///         arbitrary volume objects (2008).
SharedVolume shared_by_images(const VolumePair& pair, int rays, Layers layers = Layers::all);

/// By counting the centers of cells that lie inside both; volume and center alone.
///
///   cells    along the longest side of what the two bounds share in a's axes; above 0
///   offset   of the centers, in cells, 0 to 1
SharedVolume
shared_by_voxels(const VolumePair& pair, int cells, const Vec3& offset = Vec3::Constant(0.5));

/// The same for two fields, asked at each center.
SharedVolume shared_by_fields(const VoxelBricks& a,
                              const VoxelBricks& b,
                              const Pose& b_in_a,
                              int cells,
                              const Vec3& offset = Vec3::Constant(0.5));

}  // namespace throng
