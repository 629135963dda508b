#include "narrowphase/alternatives/shared_volume.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "kernels/geometry/support.hpp"
#include "kernels/geometry/voxel_bricks.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

struct Scratch {
    DepthImage a, b;
};

Scratch& scratch()
{
    thread_local Scratch kept;
    return kept;
}

Box3 common(const Box3& a, const Box3& b)
{
    return {a.lower.cwiseMax(b.lower), a.upper.cwiseMin(b.upper)};
}

// Bounds of a mesh by its vertices, for rays are dear.
Box3 tight_bounds(const Shapes& shapes, ShapeRef shape, const Pose& pose)
{
    const Mesh* const mesh = mesh_of(shapes, shape);
    if (mesh == nullptr) return shape_bounds(shapes, shape, pose);
    const Mat3 turn = pose.orientation.toRotationMatrix();
    Box3 box;
    for (const Vec3& vertex : mesh->vertices) {
        const Vec3 turned = turn * vertex + pose.position;
        box.lower = box.lower.cwiseMin(turned);
        box.upper = box.upper.cwiseMax(turned);
    }
    return box;
}

// A turn that makes a direction, or the opposite one where that is nearer, into z.
Pose turned_to(const Vec3& direction)
{
    const Vec3 up = direction.z() < 0 ? Vec3(-direction) : direction;
    const Vec3 axis = up.cross(Vec3::UnitZ());
    return {Vec3::Zero(), Quat(1 + up.z(), axis.x(), axis.y(), axis.z()).normalized()};
}

RayGrid grid_over(const Box3& box, double pixel, const std::array<double, 2>& offset)
{
    RayGrid grid;
    grid.pixel = pixel;
    for (std::size_t k = 0; k < 2; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        const double side = (box.upper[axis] - box.lower[axis]) / pixel;
        grid.shift[k] = box.lower[axis] / pixel + offset[k];
        grid.count[k] = static_cast<std::int32_t>(std::floor(std::max(0.0, side - offset[k]))) + 1;
    }
    return grid;
}

// Visits what two bodies share of each ray.
template <class Visitor>
void visit_shared(const RayGrid& grid, const DepthImage& a, const DepthImage& b, Visitor visit)
{
    std::size_t ray = 0;
    for (std::int32_t row = 0; row < grid.count[1]; ++row)
        for (std::int32_t i = 0; i < grid.count[0]; ++i, ++ray) {
            const auto of_a = a.on(ray), of_b = b.on(ray);
            for (std::size_t j = 0, k = 0; j < of_a.size() && k < of_b.size();) {
                if (of_a[j].enter < of_b[k].leave && of_b[k].enter < of_a[j].leave)
                    visit(grid.at(0, i), grid.at(1, row), of_a[j], of_b[k]);
                if (of_a[j].leave < of_b[k].leave) {
                    ++j;
                } else {
                    ++k;
                }
            }
        }
}

// The ends on a less those on b, each along the ray.
double ends_of(const RayInterval& a, const RayInterval& b)
{
    const auto sign = [](double x) { return (x > 0) - (x < 0); };
    return sign(b.leave - a.leave) - sign(a.enter - b.enter);
}

bool holds_something(const Box3& box) { return (box.lower.array() < box.upper.array()).all(); }

// Cells over what two bounds share, and the sum over those that count.
struct Cells {
    Box3 box;
    double side = 0;
    Vec3 offset;
    double count = 0;
    Vec3 sum = Vec3::Zero();

    Cells(const Box3& shared, int cells, const Vec3& at) : box(shared), offset(at)
    {
        side = (box.upper - box.lower).maxCoeff() / cells;
    }
    SharedVolume total() const
    {
        if (count == 0) return {};
        return {count * side * side * side, sum / count, Vec3::Zero(), 0};
    }
};

}  // namespace

RayLook look_along(const VolumePair& pair,
                   const Vec3& direction,
                   int rays,
                   Layers layers,
                   const std::array<double, 2>& offset)
{
    THRONG_CHECK(rays > 0, "a look needs rays");
    const Pose view = turned_to(direction), b = view * pair.b_in_a;
    const Box3 box =
        common(tight_bounds(pair.shapes, pair.a, view), tight_bounds(pair.shapes, pair.b, b));
    if (!holds_something(box)) return {};
    const double side = (box.upper - box.lower).head<2>().maxCoeff();
    const RayGrid grid = grid_over(box, side / rays, offset);
    Scratch& images = scratch();
    images.a.draw(pair.shapes, pair.a, view, grid, layers);
    images.b.draw(pair.shapes, pair.b, b, grid, layers);

    RayLook look;
    Vec3 moment = Vec3::Zero();
    visit_shared(grid, images.a, images.b,
                 [&](double x, double y, const RayInterval& of_a, const RayInterval& of_b) {
                     const double enter = std::max(of_a.enter, of_b.enter);
                     const double leave = std::min(of_a.leave, of_b.leave);
                     look.volume += leave - enter;
                     moment += Vec3(x, y, 0.5 * (enter + leave)) * (leave - enter);
                     look.longest = std::max(look.longest, leave - enter);
                     look.push += ends_of(of_a, of_b);
                 });
    if (!(look.volume > 0)) return {};
    look.center = view.orientation.conjugate() * Vec3(moment / look.volume);
    const double area = grid.pixel * grid.pixel;
    look.volume *= area;
    look.push *= direction.z() < 0 ? -area : area;
    return look;
}

SharedVolume shared_by_images(const VolumePair& pair, int rays, Layers layers)
{
    SharedVolume shared;
    Vec3 push = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis) {
        const RayLook look = look_along(pair, Vec3::Unit(axis), rays, layers);
        shared.volume += look.volume / 3;
        shared.center += look.center * look.volume;
        push[axis] = look.push;
    }
    if (!(shared.volume > 0)) return {};
    shared.center /= 3 * shared.volume;
    shared.normal = unit_or(push, Vec3(Vec3::Zero()));
    if (!shared.normal.isZero(0))
        shared.depth = look_along(pair, shared.normal, rays, layers).longest;
    return shared;
}

SharedVolume shared_by_voxels(const VolumePair& pair, int cells, const Vec3& offset)
{
    THRONG_CHECK(cells > 0, "voxels need cells");
    const Box3 box = common(tight_bounds(pair.shapes, pair.a, {}),
                            tight_bounds(pair.shapes, pair.b, pair.b_in_a));
    if (!holds_something(box)) return {};
    Cells all(box, cells, offset);
    // Columns of cells are rays, and those inside both are counted by the ends of what is shared.
    const RayGrid grid = grid_over(box, all.side, {offset.x(), offset.y()});
    Scratch& images = scratch();
    images.a.draw(pair.shapes, pair.a, {}, grid, Layers::all);
    images.b.draw(pair.shapes, pair.b, pair.b_in_a, grid, Layers::all);
    visit_shared(grid, images.a, images.b,
                 [&](double x, double y, const RayInterval& of_a, const RayInterval& of_b) {
                     const auto place = [&](double z) {
                         return (z - box.lower.z()) / all.side - offset.z();
                     };
                     const double first = std::ceil(place(std::max(of_a.enter, of_b.enter)));
                     const double last = std::floor(place(std::min(of_a.leave, of_b.leave)));
                     if (!(first <= last)) return;
                     const double middle = 0.5 * (first + last) + offset.z();
                     const double count = last - first + 1;
                     all.count += count;
                     all.sum += Vec3(x, y, box.lower.z() + middle * all.side) * count;
                 });
    return all.total();
}

SharedVolume shared_by_fields(
    const VoxelBricks& a, const VoxelBricks& b, const Pose& b_in_a, int cells, const Vec3& offset)
{
    THRONG_CHECK(cells > 0, "voxels need cells");
    const auto sides = [](const VoxelBricks& field) {
        return Vec3(Vec3(field.bricks[0], field.bricks[1], field.bricks[2])
                    * (VoxelBricks::kCells * field.voxel));
    };
    const Vec3 half = 0.5 * sides(b);
    const Vec3 extent = b_in_a.orientation.toRotationMatrix().cwiseAbs() * half;
    const Vec3 middle = b_in_a * Vec3(b.origin + half);
    const Box3 box = common({a.origin, a.origin + sides(a)}, {middle - extent, middle + extent});
    if (!holds_something(box)) return {};
    Cells all(box, cells, offset);
    const Vec3 side = (box.upper - box.lower) / all.side;
    for (int z = 0; z < side.z(); ++z)
        for (int y = 0; y < side.y(); ++y)
            for (int x = 0; x < side.x(); ++x) {
                const Vec3 at = box.lower + (Vec3(x, y, z) + offset) * all.side;
                if (!(sample_bricks<double>(a, at).distance < 0)) continue;
                if (!(sample_bricks<double>(b, b_in_a.to_local(at)).distance < 0)) continue;
                all.count += 1;
                all.sum += at;
            }
    return all.total();
}

}  // namespace throng
