#include "narrowphase/solid/image_candidates.hpp"

#include "kernels/geometry/image_views.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "kernels/geometry/support.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace throng {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Of two views of one place the other one counts where it sees less than this share of the depth.
// Two views of one flat overlap agree; of a round one, that which looks across it at 55 degrees
// sees about 0.7 of what the other does.
constexpr double kShallower = 0.5;
// Neighbors among the rays see one surface where their depths differ by no more pixels: at the
// steepest that a view answers for, a surface climbs 1.5 of them.
constexpr double kClimb = 2;
// How much the normals of a region spread that count as flat: far above their rounding.
constexpr double kFlat = 1e-6;
// Across a gap two round surfaces show each view the places where they lean away from it, so that
// where all axes are alike none is the one faced most. This share of the most is enough; what two
// views tell then is told twice.
constexpr double kNearlyMost = 0.85;

// How much longer a gap may be along a ray than along its normal, which leans 60 degrees at most.
constexpr double kAlong = 2;

// A pair of surfaces that face one another along a ray.
//
//   low, high      m, along the ray: where the lower body leaves and the upper enters, in order
//   shared         m, along the ray: the middle of what both share of it, or of the gap
//   on_a, on_b     unit, out of a and out of b, in a's frame
//   separation     m, along the ray: below 0 where they share the part between
//   up             b is above a
struct Facing {
    std::uint32_t ray = 0, layers = 0;
    double low = 0, high = 0, shared = 0, separation = 0;
    Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero(), normal = Vec3::Zero();
    bool up = false, kept = true;
};

// One of the three looks at the pair: along an axis of a's frame.
struct View {
    int axis = 2;
    Pose from_a;  // a's frame in that of the rays
    RayGrid grid;
    DepthImage a, b;
    std::vector<Facing> facings;               // by ray
    std::vector<std::uint32_t> begin, region;  // [rays + 1], [facings]

    int across() const { return throng::across(axis); }
    int upward() const { return throng::upward(axis); }
};

// What of a box the triangles of a mesh come near, or all of it where there are none in it: perhaps
// the mesh goes round it.
Box3 part_near(const Mesh& mesh, const Pose& pose, const Box3& box, double distance)
{
    const Mat3 turn = pose.orientation.toRotationMatrix(), extents = turn.cwiseAbs();
    const auto near = [&](const Mesh::Node& node) {
        const Vec3 center = turn * (0.5 * (node.lower + node.upper)) + pose.position;
        const Vec3 half = extents * (0.5 * (node.upper - node.lower));
        return box.overlaps({center - half, center + half});
    };
    Box3 found;
    visit_nodes(mesh, near, [&](std::uint32_t triangle) {
        Box3 round;
        for (const std::uint32_t corner : mesh.triangles[triangle]) {
            const Vec3 at = turn * mesh.vertices[corner] + pose.position;
            round = joined(round, {at, at});
        }
        if (box.overlaps(round)) found = joined(found, round);
    });
    if (found.empty()) return box;
    const Vec3 padding = Vec3::Constant(distance);
    return {(found.lower - padding).cwiseMax(box.lower),
            (found.upper + padding).cwiseMin(box.upper)};
}

// Whether two intervals touch or nearly do, and with b above a or below: by the lesser way out. A
// layer of a mesh has one face or both: who is beyond the one it has not shares nothing with it,
// though the way out by the other would be long.
bool face(const RayInterval& a, const RayInterval& b, double speculative_margin, Facing& facing)
{
    const double up = a.leave_face == RayInterval::kNoFace || b.enter_face == RayInterval::kNoFace
        ? kInfinity
        : a.leave - b.enter;
    const double down = a.enter_face == RayInterval::kNoFace || b.leave_face == RayInterval::kNoFace
        ? kInfinity
        : b.leave - a.enter;
    facing.up = up <= down;
    facing.separation = -std::min(up, down);
    facing.low = facing.up ? std::min(a.leave, b.enter) : std::min(a.enter, b.leave);
    facing.high = facing.up ? std::max(a.leave, b.enter) : std::max(a.enter, b.leave);
    const double from = std::max(a.enter, b.enter), to = std::min(a.leave, b.leave);
    facing.shared = 0.5 * (from + to);
    // Past a layer whose back is not seen there is no depth, only another side.
    if (facing.separation < 0 && from > to) return false;
    return facing.separation > -kInfinity && facing.separation <= speculative_margin;
}

// Across a gap only neighbors face one another.
bool is_next(std::span<const RayInterval> of, std::size_t i, const Facing& facing, bool upper)
{
    if (facing.separation <= 0) return true;
    if (upper) return i == 0 || of[i - 1].leave <= facing.low;
    return i + 1 == of.size() || of[i + 1].enter >= facing.high;
}

void collect_facings(View& view, double speculative_margin)
{
    view.facings.clear();
    view.begin.assign(1, 0);
    const Mat3 turn = view.from_a.orientation.toRotationMatrix().transpose();
    for (std::uint32_t ray = 0; ray < view.grid.rays(); ++ray) {
        const auto of_a = view.a.on(ray), of_b = view.b.on(ray);
        for (std::size_t i = 0; i < of_a.size(); ++i)
            for (std::size_t k = 0; k < of_b.size(); ++k) {
                Facing facing;
                if (!face(of_a[i], of_b[k], speculative_margin, facing)) continue;
                if (!is_next(of_a, i, facing, !facing.up) || !is_next(of_b, k, facing, facing.up))
                    continue;
                facing.ray = ray;
                facing.layers = static_cast<std::uint32_t>((i & 3U) << 2 | (k & 1U) << 1)
                    | static_cast<std::uint32_t>(facing.up);
                const bool up = facing.up;
                facing.on_a = turn * view.a.normal(up ? of_a[i].leave_face : of_a[i].enter_face);
                facing.on_b = turn * view.b.normal(up ? of_b[k].enter_face : of_b[k].leave_face);
                view.facings.push_back(facing);
            }
        view.begin.push_back(static_cast<std::uint32_t>(view.facings.size()));
    }
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

// Joins a facing to those of the ray before it that see the same surfaces go on.
void join_ray(View& view, std::uint32_t i, std::size_t ray)
{
    const Facing& here = view.facings[i];
    for (std::uint32_t k = view.begin[ray]; k < view.begin[ray + 1]; ++k) {
        const Facing& there = view.facings[k];
        const double apart = std::abs(here.low + here.high - there.low - there.high) / 2;
        if (here.up != there.up || apart > kClimb * view.grid.pixel) continue;
        const std::uint32_t one = root_of(view.region, i), two = root_of(view.region, k);
        view.region[std::max(one, two)] = std::min(one, two);
    }
}

void find_regions(View& view)
{
    view.region.resize(view.facings.size());
    std::iota(view.region.begin(), view.region.end(), 0U);
    const auto width = static_cast<std::uint32_t>(view.grid.count[0]);
    for (std::uint32_t i = 0; i < view.facings.size(); ++i) {
        const std::uint32_t ray = view.facings[i].ray;
        if (ray % width != 0) join_ray(view, i, ray - 1);
        if (ray >= width) join_ray(view, i, ray - width);
    }
}

// How far unit normals spread that add up to this: about the sine of what they lean.
double spread_of(const Vec3& sum, double count)
{
    const double length = sum.norm() / count;
    return std::sqrt(std::max(0.0, 1 - length * length));
}

// A normal for each facing, of both surfaces. That of the surface which bends less over the region
// counts more: of a ball on a plate the plate's, of a corner in a face the face's, of two balls
// such that their leanings cancel.
void find_normals(View& view)
{
    struct Sum {
        Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();
        double count = 0;
    };
    thread_local std::vector<Sum> sums;
    sums.assign(view.facings.size(), {});
    for (std::uint32_t i = 0; i < view.facings.size(); ++i) {
        Sum& sum = sums[root_of(view.region, i)];
        sum.on_a += view.facings[i].on_a;
        sum.on_b += view.facings[i].on_b;
        sum.count += 1;
    }
    for (std::uint32_t i = 0; i < view.facings.size(); ++i) {
        Facing& facing = view.facings[i];
        const Sum& sum = sums[root_of(view.region, i)];
        const double bend_a = spread_of(sum.on_a, sum.count) + kFlat;
        const double bend_b = spread_of(sum.on_b, sum.count) + kFlat;
        facing.normal = unit_or(Vec3(bend_b * facing.on_a - bend_a * facing.on_b), facing.on_a);
        facing.separation *= std::abs(facing.normal[view.axis]);
        const double most = facing.normal.cwiseAbs().maxCoeff();
        facing.kept = std::abs(facing.normal[view.axis]) >= kNearlyMost * most;
    }
}

Vec3 place_of(const View& view, const Facing& facing, double along)
{
    const auto width = static_cast<std::uint32_t>(view.grid.count[0]);
    Vec3 place;
    place[view.across()] = view.grid.at(0, static_cast<std::int32_t>(facing.ray % width));
    place[view.upward()] = view.grid.at(1, static_cast<std::int32_t>(facing.ray / width));
    place[view.axis] = along;
    return place;
}

// Whether a ray of another view sees the place in an overlap that is much less deep.
bool is_shallower_on(const View& view, std::size_t ray, double at, double separation)
{
    for (std::uint32_t i = view.begin[ray]; i < view.begin[ray + 1]; ++i) {
        const Facing& facing = view.facings[i];
        const bool there =
            facing.low - view.grid.pixel <= at && at <= facing.high + view.grid.pixel;
        const bool shared = facing.kept && there && facing.separation < 0;
        if (shared && facing.separation > kShallower * separation) return true;
    }
    return false;
}

// The same for the ray nearest the place; where the overlap is said to be deeper than a pixel, for
// its neighbors too: a corner may lie between the rays of the one view and be met by the other.
bool is_shallower_in(const View& view, const Vec3& place, double separation)
{
    const RayGrid& grid = view.grid;
    const std::array<double, 2> at = {place[view.across()], place[view.upward()]};
    const double far = separation < -grid.pixel ? 1 : 0;
    std::array<std::int32_t, 2> first{}, last{};
    for (std::size_t k = 0; k < 2; ++k) {
        const double ray = std::floor(at[k] / grid.pixel - grid.shift[k] + 0.5) - grid.first[k];
        first[k] = static_cast<std::int32_t>(std::clamp(ray - far, 0.0, grid.count[k] * 1.0));
        last[k] = static_cast<std::int32_t>(std::clamp(ray + far, -1.0, grid.count[k] - 1.0));
    }
    for (std::int32_t row = first[1]; row <= last[1]; ++row)
        for (std::int32_t i = first[0]; i <= last[0]; ++i)
            if (is_shallower_on(view, static_cast<std::size_t>(row * grid.count[0] + i),
                                place[view.axis], separation))
                return true;
    return false;
}

// What of the two bounds rays have to go through: only those near the surface of both can tell of
// touches, and most of two boxes is not. Empty where nothing comes within the margin.
Box3 part_to_look_at(const Shapes& shapes,
                     ShapeRef solid,
                     ShapeRef other,
                     const Pose& other_in_solid,
                     double speculative_margin)
{
    const Box3 a = shape_bounds(shapes, solid, {}), b = shape_bounds(shapes, other, other_in_solid);
    const Vec3 padding = Vec3::Constant(speculative_margin);
    Box3 part{a.lower.cwiseMax(b.lower) - padding, a.upper.cwiseMin(b.upper) + padding};
    if (!(part.lower.array() <= part.upper.array()).all()) return {};
    if (const Mesh* const mesh = mesh_of(shapes, other))
        part = part_near(*mesh, other_in_solid, part, kAlong * speculative_margin);
    return part_near(shapes.solids[solid.index].mesh, {}, part, kAlong * speculative_margin);
}

std::uint32_t feature_of(const View& view, const Facing& facing)
{
    const auto width = static_cast<std::uint32_t>(view.grid.count[0]);
    const auto place = [&](std::size_t k, std::uint32_t ray) {
        return (static_cast<std::uint32_t>(view.grid.first[k]) + ray) & 0x1fffU;
    };
    return static_cast<std::uint32_t>(view.axis) << 30 | place(1, facing.ray / width) << 17
        | place(0, facing.ray % width) << 4 | facing.layers;
}

void append_touches(const View& view,
                    const std::array<View, 3>& views,
                    double speculative_margin,
                    std::vector<ContactCandidate>& candidates)
{
    for (const Facing& facing : view.facings) {
        if (!facing.kept || facing.separation > speculative_margin) continue;
        const Vec3 shared = place_of(view, facing, facing.shared);
        const auto sees_less = [&](const View& seen) {
            return seen.axis != view.axis && is_shallower_in(seen, shared, facing.separation);
        };
        if (facing.separation < 0 && std::any_of(views.begin(), views.end(), sees_less)) continue;
        const Vec3 place = place_of(view, facing, 0.5 * (facing.low + facing.high));
        candidates.push_back({place, facing.normal, facing.separation, feature_of(view, facing)});
    }
}

}  // namespace

void find_image_candidates(const PairInput<double>& in, std::vector<ContactCandidate>& candidates)
{
    const auto& [shapes, solid, other, other_in_solid, speculative_margin] = in;
    thread_local std::array<View, 3> views;
    const Box3 part = part_to_look_at(shapes, solid, other, other_in_solid, speculative_margin);
    const double pixel = pixel_of(shapes, solid, other);
    if (part.empty() || !(pixel > 0)) return;
    // Half of the solid's thickness: what sinks deeper is past its middle.
    const Box3 own = shape_bounds(shapes, solid, {});
    const double thickness = 0.5 * (own.upper - own.lower).minCoeff();
    const Layers layers = other.kind == ShapeKind::mesh ? Layers::sheet : Layers::all;

    const ThreeGrids grids = grids_through(part, pixel);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        views[axis].axis = static_cast<int>(axis);
        views[axis].from_a = turned_to(static_cast<int>(axis));
        views[axis].grid = grids[axis];
    }
    draw_own(shapes, solid, grids, {&views[0].a, &views[1].a, &views[2].a});
    draw_along_axes(shapes, other, other_in_solid, grids, {&views[0].b, &views[1].b, &views[2].b},
                    layers, thickness);
    for (View& view : views) {
        collect_facings(view, kAlong * speculative_margin);
        find_regions(view);
        find_normals(view);
    }
    for (const View& view : views) append_touches(view, views, speculative_margin, candidates);
}

}  // namespace throng
