// Parts: what several recipes are put together from.
//
// Random numbers are drawn in a fixed order, which belongs to the recipe: these helpers draw one
// after the other, never as arguments of one call, whose order the language leaves open.
#pragma once

#include "scene/catalog/closed_meshes.hpp"
#include "scene/catalog/random.hpp"
#include "throng/scene.hpp"

#include <string_view>

namespace throng {

/// An empty scene named "name:size" with one material, of place 0: density 1000, friction 0.5.
Scene begin_scene(std::string_view name, int size);

/// Adds a shape and gives its place.
template <class Shape>
std::uint32_t add_shape(Scene& scene, std::string_view name, Shape shape)
{
    scene.shapes.push_back({std::string(name), std::move(shape)});
    return static_cast<std::uint32_t>(scene.shapes.size() - 1);
}

/// A shape of these triangles, to be taken as the dial says where it moves.
MeshShape mesh_shape(TriangleSoup mesh);

/// The same mesh about the middle of its bounds, of such a size that it just reaches so far from
/// there. Vertices of no triangle do not count. The triangles must not all lie in one point.
TriangleSoup fitted(TriangleSoup mesh, double size);

/// Adds the plane z = 0 with all below it, static, of the scene's first material.
void add_ground(Scene& scene);

/// Adds a static box with a shape of its own; both get the name.
BodyDescription&
add_static_box(Scene& scene, std::string_view name, const Vec3& position, const Vec3& half_extents);

/// Adds an open box: floor at z = 0, four walls at x = +-half_width and y = +-half_width.
void add_container(Scene& scene, double half_width, double height);

/// Adds a group of dynamic bodies of one shape, with room for `count` records.
Instances& add_instances(Scene& scene, std::uint32_t shape, std::size_t count, bool own_sizes);

/// Adds a body to a group. `size` is given if, and only if, the group has own sizes.
void add_record(Instances& group,
                const Pose& pose,
                const Vec3& velocity = Vec3::Zero(),
                const Vec3& angular_velocity = Vec3::Zero());
void add_record(Instances& group,
                const Pose& pose,
                const Vec3& velocity,
                const Vec3& angular_velocity,
                const Vec3& size);

/// The turn by an angle about an axis of unit length.
Quat turn(const Vec3& axis, double angle);

/// Three numbers between low and high.
Vec3 random_vector(Random& random, double low, double high);

/// A direction, all equally likely.
Vec3 random_direction(Random& random);

/// A turn about a random direction by an angle up to greatest, either way.
Quat random_turn(Random& random, double greatest);

/// A velocity of up to 1 m/s along x and along y.
Vec3 random_drift(Random& random);

/// A random turn after which the box's extents along the world's axes are at most limit.
Quat fitting_turn(Random& random, const Vec3& half_extents, double limit);

/// Bodies in layers of side x side cells, so that a heap of them is about as deep as it is wide.
struct HeapLayout {
    int layers = 0, side = 0;
};
HeapLayout heap_layout(int size);

/// The place of body i in the grid, centered about z; jitter along x and y.
struct Grid {
    int side = 0;
    double spacing = 0, lowest = 0;
    Vec3 place(int i, Random& random) const;
};

/// Drops bodies from a grid, turned at random: body i of the grid is of kind i modulo their number.
/// Each kind becomes a shape and a group, so that ids run kind by kind.
void drop_in_turn(
    Scene& scene, std::vector<ShapeDescription> kinds, int size, const Grid& grid, Random& random);

/// Corners of a random convex stone about its centroid: 24 points on an ellipsoid with semi-axes
/// of 0.35 to 0.55 m.
std::vector<Vec3> random_stone(Random& random);

}  // namespace throng
