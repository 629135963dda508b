#include "kernels/geometry/image_views.hpp"

#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/shape_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// With more rays along a side layers take some MB a solid.
constexpr int kMostLayerRays = 128;

double longest_side(const Shapes& shapes, ShapeRef shape)
{
    const Box3 box = shape_bounds(shapes, shape, {});
    return (box.upper - box.lower).maxCoeff();
}

RayGrid grid_through(const Box3& box, int axis, double pixel)
{
    RayGrid grid;
    grid.pixel = pixel;
    grid.shift = {0.5, 0.5};
    const int axes[] = {across(axis), upward(axis)};
    for (std::size_t k = 0; k < 2; ++k) {
        const double low = std::ceil(box.lower[axes[k]] / pixel - 0.5);
        const double high = std::floor(box.upper[axes[k]] / pixel - 0.5);
        if (!(low <= high && std::abs(low) < 1e9)) return {pixel, {}, {}, {}};
        grid.first[k] = static_cast<std::int32_t>(low);
        // A box is no larger than the smaller shape, which is kMostRays wide, its diagonal more.
        grid.count[k] = static_cast<std::int32_t>(std::min(high - low + 1, 2.0 * kMostRays));
    }
    return grid;
}

// Which rays of the three views things come near, by the axes of a's frame: two views share each,
// and its rays lie the same in both, unless there are none.
class AxisWindows {
public:
    explicit AxisWindows(const ThreeGrids& grids)
        : axes_{axis_of(grids, 0), axis_of(grids, 1), axis_of(grids, 2)}
    { }

    std::array<RayRange, 3> between(const Vec3& lower, const Vec3& upper) const
    {
        return {axes_[0].between(lower.x(), upper.x()), axes_[1].between(lower.y(), upper.y()),
                axes_[2].between(lower.z(), upper.z())};
    }
    // Whether any view may see some of a box.
    bool sees(const Vec3& lower, const Vec3& upper) const
    {
        const auto rays = between(lower, upper);
        return rays[0].empty() + rays[1].empty() + rays[2].empty() < 2;
    }

private:
    static RayAxis axis_of(const ThreeGrids& grids, std::size_t axis)
    {
        const RayGrid &first = grids[(axis + 2) % 3], &second = grids[(axis + 1) % 3];
        return first.rays() > 0 ? RayAxis(first, 0) : RayAxis(second, 1);
    }

    std::array<RayAxis, 3> axes_;
};

// Of a mesh or a solid all three views at once: each of its triangles is turned but once, and most
// of a fine mesh lie between two rays of every view.
void draw_triangles(const Shapes& shapes,
                    ShapeRef shape,
                    const Pose& in_a,
                    const ThreeGrids& grids,
                    const ThreeImages& images)
{
    const Mesh& mesh = *mesh_of(shapes, shape);
    const Mat3 turn = in_a.orientation.toRotationMatrix(), extents = turn.cwiseAbs();
    const AxisWindows windows(grids);
    const auto in_view = [&](const Mesh::Node& node) {
        const Vec3 center = turn * (0.5 * (node.lower + node.upper)) + in_a.position;
        const Vec3 half = extents * (0.5 * (node.upper - node.lower));
        return windows.sees(center - half, center + half);
    };
    visit_nodes(mesh, in_view, [&](std::uint32_t triangle) {
        const auto& [i, j, k] = mesh.triangles[triangle];
        const std::array<Vec3, 3> corners = {turn * mesh.vertices[i] + in_a.position,
                                             turn * mesh.vertices[j] + in_a.position,
                                             turn * mesh.vertices[k] + in_a.position};
        const auto rays = windows.between(corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]),
                                          corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]));
        if (rays[0].empty() + rays[1].empty() + rays[2].empty() > 1) return;
        for (int axis = 0; axis < 3; ++axis) {
            const int x = across(axis), y = upward(axis);
            const RayWindow window{rays[static_cast<std::size_t>(x)],
                                   rays[static_cast<std::size_t>(y)]};
            if (window.columns.empty() || window.rows.empty()) continue;
            std::array<Vec3, 3> seen;
            for (std::size_t c = 0; c < 3; ++c)
                seen[c] = {corners[c][x], corners[c][y], corners[c][axis]};
            images[static_cast<std::size_t>(axis)]->add(triangle, seen, window);
        }
    });
}

}  // namespace

Pose turned_to(int axis)
{
    if (axis == 0) return {Vec3::Zero(), Quat(0.5, -0.5, -0.5, -0.5)};
    if (axis == 1) return {Vec3::Zero(), Quat(0.5, 0.5, 0.5, 0.5)};
    return {};
}

double pixel_of(const Shapes& shapes, ShapeRef solid, ShapeRef other)
{
    double size = longest_side(shapes, solid);
    if (other.kind != ShapeKind::mesh) size = std::min(size, longest_side(shapes, other));
    int wanted = shapes.solids[solid.index].rays;
    if (other.kind == ShapeKind::solid) wanted = std::max(wanted, shapes.solids[other.index].rays);
    return size / std::clamp(wanted > 0 ? wanted : kAutoRays, 2, kMostRays);
}

ThreeGrids grids_through(const Box3& box, double pixel)
{
    return {grid_through(box, 0, pixel), grid_through(box, 1, pixel), grid_through(box, 2, pixel)};
}

void draw_along_axes(const Shapes& shapes,
                     ShapeRef shape,
                     const Pose& in_a,
                     const ThreeGrids& grids,
                     const ThreeImages& images,
                     Layers layers,
                     double thickness)
{
    const bool triangles = mesh_of(shapes, shape) != nullptr;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Pose in_view = turned_to(static_cast<int>(axis)) * in_a;
        if (triangles)
            images[axis]->begin(shapes, shape, in_view, grids[axis]);
        else
            images[axis]->draw(shapes, shape, in_view, grids[axis], layers);
    }
    if (!triangles) return;
    draw_triangles(shapes, shape, in_a, grids, images);
    for (DepthImage* const image : images) image->finish(layers, thickness);
}

void draw_own(const Shapes& shapes,
              ShapeRef solid,
              const ThreeGrids& grids,
              const ThreeImages& images)
{
    const std::array<RayLayers, 3>& layers = shapes.solids[solid.index].layers;
    if (layers[0].begin.empty() || layers[0].grid.pixel != grids[0].pixel) {
        draw_along_axes(shapes, solid, {}, grids, images, Layers::all, 0);
        return;
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
        images[axis]->begin_from(shapes, solid, turned_to(static_cast<int>(axis)), grids[axis],
                                 layers[axis]);
}

std::array<RayLayers, 3> layers_of(const Solid& solid)
{
    std::array<RayLayers, 3> layers;
    if (solid.rays > kMostLayerRays || solid.mesh.triangles.empty()) return layers;
    Shapes shapes;
    shapes.solids = {solid};
    const ShapeRef own{ShapeKind::solid, 0};
    const double pixel = pixel_of(shapes, own, own);
    if (!(pixel > 0)) return layers;
    const Vec3 padding = Vec3::Constant(pixel);
    const Box3 box = shape_bounds(shapes, own, {});
    const ThreeGrids grids = grids_through({box.lower - padding, box.upper + padding}, pixel);
    std::array<DepthImage, 3> images;
    draw_along_axes(shapes, own, {}, grids, {&images[0], &images[1], &images[2]}, Layers::all, 0);
    for (std::size_t axis = 0; axis < 3; ++axis) layers[axis] = images[axis].layers();
    return layers;
}

}  // namespace throng
