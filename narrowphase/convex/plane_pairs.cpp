// Plane pairs: a convex shape on a plane, up to four points.
//
// The plane is brought into the shape's frame, where the furthest points of every kind are known.
#include "kernels/check.hpp"
#include "kernels/geometry/support.hpp"
#include "narrowphase/convex/pair_functions.hpp"
#include "narrowphase/manifold/foot.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// The plane as the shape sees it: solid at x . into >= depth, so that `into` is the manifold's
// normal and depth - x . into is how far x is above the plane.
template <class Real>
struct Ground {
    Vec3T<Real> into;
    Real depth;
    Real speculative_margin;
    LocalManifold<Real>& out;

    Real height(const Vec3T<Real>& point) const { return depth - point.dot(into); }

    // A point of the core whose surface is `radius` further on; left out when beyond the margin.
    void add_point(const Vec3T<Real>& point, Real radius, std::uint32_t feature) const
    {
        const Real separation = height(point) - radius;
        if (!(separation <= speculative_margin)) return;
        out.add(point + into * (radius + separation / 2), separation, feature);
    }
};

// The lowest corner, then the others of the side that faces the plane; where some of that is out of
// reach, those reached along the edges that climb least.
template <class Real>
void touch_box(const ConvexCore<Real>& box, const Ground<Real>& ground)
{
    std::array<Real, 3> climb;
    std::uint32_t lowest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Real along = ground.into[static_cast<int>(i)];
        climb[i] = std::abs(along) * box.extents[static_cast<int>(i)];
        if (along >= 0) lowest |= 1u << i;
    }
    std::array<std::size_t, 3> order = {0, 1, 2};
    if (climb[order[1]] < climb[order[0]]) std::swap(order[0], order[1]);
    if (climb[order[2]] < climb[order[1]]) std::swap(order[1], order[2]);
    if (climb[order[1]] < climb[order[0]]) std::swap(order[0], order[1]);

    // The side that faces the plane, where all of it is within the margin: a thin box that leans a
    // little climbs less along its thickness than along its length, and would be held at one end
    // alone.
    std::size_t facing = 0;
    for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
        const auto along = [&](std::size_t axis) {
            return std::abs(ground.into[static_cast<int>(axis)]);
        };
        if (along(i) > along(facing)) facing = i;
    }
    const Real highest = ground.depth - 2 * climb[facing] + climb[0] + climb[1] + climb[2];
    const bool whole = highest <= ground.speculative_margin;
    if (whole && order[2] != facing) {
        if (order[0] == facing) std::swap(order[0], order[1]);
        std::swap(order[1], order[2]);
    }

    const std::uint32_t first = 1u << order[0];
    const std::uint32_t second = 1u << order[1];
    const std::uint32_t third = 1u << order[2];
    const bool face = whole || climb[order[0]] + climb[order[1]] <= climb[order[2]];
    const std::uint32_t last = face ? first | second : third;
    for (const std::uint32_t flipped : {0u, first, second, last}) {
        const std::uint32_t corner = lowest ^ flipped;
        Vec3T<Real> point = box.extents;
        for (int i = 0; i < 3; ++i) {
            if (!(corner >> i & 1u)) point[i] = -point[i];
        }
        ground.add_point(point, Real(0), corner);
    }
}

// A cap when the axis leans towards the plane, else the lower line of the side.
template <class Real>
void touch_cylinder(const ConvexCore<Real>& cylinder, const Ground<Real>& ground)
{
    const Vec3T<Real>& into = ground.into;
    const Real across = std::sqrt(into.x() * into.x() + into.y() * into.y());
    if (std::abs(into.z()) > across) {
        const SupportFace<Real> cap = rim_points(cylinder, into);
        for (std::size_t i = 0; i < 4; ++i)
            ground.add_point(cap.corners[i], Real(0), cap.features[i]);
        return;
    }
    const Real x = into.x() / across * cylinder.extents.x();
    const Real y = into.y() / across * cylinder.extents.x();
    ground.add_point(Vec3T<Real>(x, y, -cylinder.extents.z()), Real(0), 32);
    ground.add_point(Vec3T<Real>(x, y, cylinder.extents.z()), Real(0), 33);
}

// The vertices of a hull over a plane.
template <class Real>
struct VerticesOver {
    const Hull& hull;
    const Ground<Real>& ground;

    std::size_t size() const { return hull.vertices.size(); }
    Vec3T<Real> at(std::size_t i) const { return hull.vertices[i].template cast<Real>(); }
    Real height(std::size_t i) const { return ground.height(at(i)); }
};

// What a hull stands on by its lowest vertices is held there: corners of a finely rounded rim that
// are a hair above the lowest would leave these to bear it one at a time. One that still comes down
// is held by what the step may bring down, and by what has sunk in.
template <class Real>
void touch_hull(const Hull& hull, Real size, const Ground<Real>& ground)
{
    const VerticesOver<Real> vertices{hull, ground};
    Foot<Real, VerticesOver<Real>> foot(vertices, ground.into, ground.speculative_margin);
    if (!foot.within_margin()) return;
    const Vec3T<Real> middle = hull.center.template cast<Real>();
    foot.spread(size, foot.kLevelTilt, foot.lowest());
    if (!foot.stands(middle))
        foot.spread_to_stand(size, ground.speculative_margin / static_cast<Real>(hull.outer_radius),
                             middle);
    for (const std::size_t i : foot.chosen())
        if (i != foot.kNone)
            ground.add_point(vertices.at(i), Real(0), static_cast<std::uint32_t>(i));
}

}  // namespace

template <class Real>
void convex_plane(const PairInput<Real>& in, PairCache&, LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    out.count = 0;
    const Plane& plane = shapes.planes[b.index];
    const Vec3T<Real> normal = b_in_a.orientation * plane.normal.template cast<Real>();
    out.normal = -normal;
    const Real depth = -(static_cast<Real>(plane.offset) + normal.dot(b_in_a.position));
    const Ground<Real> ground = {out.normal, depth, speculative_margin, out};

    const ConvexCore<Real> core = convex_core_of<Real>(shapes, a);
    switch (core.kind) {
    case ShapeKind::sphere:
        ground.add_point(Vec3T<Real>::Zero(), core.convex_radius, 0);
        break;
    case ShapeKind::capsule:
        ground.add_point(-core.extents, core.convex_radius, 0);
        ground.add_point(core.extents, core.convex_radius, 1);
        break;
    case ShapeKind::cylinder:
        touch_cylinder(core, ground);
        break;
    case ShapeKind::box:
        touch_box(core, ground);
        break;
    case ShapeKind::hull:
        touch_hull(*core.hull, core.size, ground);
        break;
    default:
        THRONG_CHECK(false, "a plane meets convex shapes of finite size");
    }
}

THRONG_PAIR_INSTANCES(convex_plane)

}  // namespace throng
