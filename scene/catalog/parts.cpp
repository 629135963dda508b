#include "scene/catalog/parts.hpp"

#include "kernels/check.hpp"
#include "throng/box3.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace throng {

Scene begin_scene(std::string_view name, int size)
{
    Scene scene;
    scene.name = std::string(name) + ':' + std::to_string(size);
    Material stone;
    stone.name = "stone";
    scene.materials.push_back(stone);
    return scene;
}

MeshShape mesh_shape(TriangleSoup mesh)
{
    MeshShape shape;
    shape.vertices = std::move(mesh.vertices);
    shape.triangles = std::move(mesh.triangles);
    return shape;
}

TriangleSoup fitted(TriangleSoup mesh, double size)
{
    Box3 bounds;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) {
            bounds.lower = bounds.lower.cwiseMin(mesh.vertices[corner]);
            bounds.upper = bounds.upper.cwiseMax(mesh.vertices[corner]);
        }
    const Vec3 middle = (bounds.lower + bounds.upper) / 2;
    for (Vec3& vertex : mesh.vertices) vertex -= middle;
    double greatest = 0;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle)
            greatest = std::max(greatest, mesh.vertices[corner].norm());
    THRONG_CHECK(greatest > 0, "a point has no size to be fitted");
    for (Vec3& vertex : mesh.vertices) vertex *= size / greatest;
    return mesh;
}

void add_ground(Scene& scene)
{
    BodyDescription ground;
    ground.name = "ground";
    ground.shape = add_shape(scene, "ground", PlaneShape{});
    ground.material = 0;
    ground.motion = Motion::static_;
    scene.bodies.push_back(std::move(ground));
}

BodyDescription&
add_static_box(Scene& scene, std::string_view name, const Vec3& position, const Vec3& half_extents)
{
    BodyDescription body;
    body.name = name;
    body.shape = add_shape(scene, name, BoxShape{half_extents});
    body.material = 0;
    body.motion = Motion::static_;
    body.position = position;
    return scene.bodies.emplace_back(std::move(body));
}

void add_container(Scene& scene, double half_width, double height)
{
    const double thick = 2;  // m: far more than a body travels in a step
    const double outer = half_width + 2 * thick;
    const double middle = half_width + thick;
    add_static_box(scene, "floor", {0, 0, -thick}, {outer, outer, thick});
    for (const double side : {-1.0, 1.0}) {
        const char* sign = side < 0 ? "-" : "+";
        add_static_box(scene, std::string("wall ") + sign + 'x', {side * middle, 0, height / 2},
                       {thick, outer, height / 2});
        add_static_box(scene, std::string("wall ") + sign + 'y', {0, side * middle, height / 2},
                       {half_width, thick, height / 2});
    }
}

Instances& add_instances(Scene& scene, std::uint32_t shape, std::size_t count, bool own_sizes)
{
    Instances& group = scene.instances.emplace_back();
    group.common.shape = shape;
    group.common.material = 0;
    group.own_sizes = own_sizes;
    group.records.reserve(count * group.stride());
    return group;
}

namespace {

void append(std::vector<double>& records, const Vec3& v)
{
    records.insert(records.end(), {v.x(), v.y(), v.z()});
}

void append_motion(std::vector<double>& records,
                   const Pose& pose,
                   const Vec3& velocity,
                   const Vec3& angular_velocity)
{
    const Quat& q = pose.orientation;
    append(records, pose.position);
    records.insert(records.end(), {q.w(), q.x(), q.y(), q.z()});
    append(records, velocity);
    append(records, angular_velocity);
}

}  // namespace

void add_record(Instances& group,
                const Pose& pose,
                const Vec3& velocity,
                const Vec3& angular_velocity)
{
    THRONG_CHECK(!group.own_sizes, "a record of this group needs a size");
    append_motion(group.records, pose, velocity, angular_velocity);
}

void add_record(Instances& group,
                const Pose& pose,
                const Vec3& velocity,
                const Vec3& angular_velocity,
                const Vec3& size)
{
    THRONG_CHECK(group.own_sizes, "a record of this group has no size");
    append_motion(group.records, pose, velocity, angular_velocity);
    append(group.records, size);
}

Quat turn(const Vec3& axis, double angle)
{
    const double s = std::sin(angle / 2);
    return Quat(std::cos(angle / 2), axis.x() * s, axis.y() * s, axis.z() * s);
}

Vec3 random_vector(Random& random, double low, double high)
{
    const double x = random.uniform(low, high);
    const double y = random.uniform(low, high);
    const double z = random.uniform(low, high);
    return {x, y, z};
}

Vec3 random_direction(Random& random)
{
    // Points of the unit ball, less its middle, where dividing by the length would be coarse.
    for (;;) {
        const Vec3 v = random_vector(random, -1, 1);
        const double length = std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z());
        if (length > 0.1 && length <= 1) return v / length;
    }
}

Quat random_turn(Random& random, double greatest)
{
    const Vec3 axis = random_direction(random);
    return turn(axis, random.uniform(-greatest, greatest));
}

Vec3 random_drift(Random& random)
{
    const double x = random.uniform(-1, 1);
    const double y = random.uniform(-1, 1);
    return {x, y, 0};
}

Quat fitting_turn(Random& random, const Vec3& half_extents, double limit)
{
    for (;;) {
        Quat q = random_turn(random, std::numbers::pi);
        const Vec3 extents = 2 * (q.toRotationMatrix().cwiseAbs() * half_extents);
        if (extents.maxCoeff() <= limit) return q;
    }
}

HeapLayout heap_layout(int size)
{
    const double cube_root = std::pow(size, 1.0 / 3);
    const int layers = std::max(6, static_cast<int>(std::nearbyint(cube_root * 0.6)));
    return {layers, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(size) / layers)))};
}

Vec3 Grid::place(int i, Random& random) const
{
    const double jitter = 0.02;  // enough that no column stands on edge
    const double half = (side - 1) * spacing / 2;
    const int layer = i / (side * side);
    const int cell = i % (side * side);
    const int column = cell % side, row = cell / side;
    const double x = column * spacing - half + random.uniform(-jitter, jitter);
    const double y = row * spacing - half + random.uniform(-jitter, jitter);
    return {x, y, lowest + layer * spacing};
}

void drop_in_turn(
    Scene& scene, std::vector<ShapeDescription> kinds, int size, const Grid& grid, Random& random)
{
    const int stride = static_cast<int>(kinds.size());
    for (int kind = 0; kind < std::min(stride, size); ++kind) {
        const auto shape = static_cast<std::uint32_t>(scene.shapes.size());
        scene.shapes.push_back(std::move(kinds[static_cast<std::size_t>(kind)]));
        const auto count = static_cast<std::size_t>((size - kind + stride - 1) / stride);
        Instances& group = add_instances(scene, shape, count, false);
        for (int i = kind; i < size; i += stride) {
            const Vec3 position = grid.place(i, random);
            const Vec3 velocity = random_drift(random);
            add_record(group, {position, random_turn(random, std::numbers::pi)}, velocity);
        }
    }
}

namespace {

// The pyramid between the origin and a face of the convex hull, as six times its volume, below 0
// where the origin is outside; 0 when these three points span no face. No four points of one face.
double pyramid_below(const std::vector<Vec3>& points, std::size_t i, std::size_t j, std::size_t k)
{
    const Vec3 normal = (points[j] - points[i]).cross(points[k] - points[i]);
    bool above = false, below = false;
    for (std::size_t m = 0; m < points.size(); ++m) {
        if (m == i || m == j || m == k) continue;
        (normal.dot(points[m] - points[i]) > 0 ? above : below) = true;
        if (above && below) return 0;
    }
    return (above ? -1 : 1) * normal.dot(points[i]);
}

// The centroid of the convex hull. Every triple is tried for a face: slow, and short.
Vec3 hull_centroid(const std::vector<Vec3>& points)
{
    double volume = 0;
    Vec3 moment = Vec3::Zero();
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = i + 1; j < points.size(); ++j)
            for (std::size_t k = j + 1; k < points.size(); ++k) {
                const double part = pyramid_below(points, i, j, k);
                volume += part;
                moment += part / 4 * (points[i] + points[j] + points[k]);
            }
    return moment / volume;
}

}  // namespace

std::vector<Vec3> random_stone(Random& random)
{
    const std::size_t corners = 24;
    const double nearest_cos = 0.97;  // no two corners within 14 degrees
    const Vec3 semi_axes = random_vector(random, 0.35, 0.55);
    std::vector<Vec3> points;
    while (points.size() < corners) {
        const Vec3 direction = random_direction(random);
        const auto crowds = [&](const Vec3& other) { return direction.dot(other) >= nearest_cos; };
        if (std::none_of(points.begin(), points.end(), crowds)) points.push_back(direction);
    }
    for (Vec3& point : points) point = point.cwiseProduct(semi_axes);
    const Vec3 centroid = hull_centroid(points);
    for (Vec3& point : points) point -= centroid;
    return points;
}

}  // namespace throng
