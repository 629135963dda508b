// Plane pairs: a convex shape on a plane, up to four points.
//
// The plane is brought into the shape's frame, where the furthest points of every kind are known.
#include "kernels/check.hpp"
#include "kernels/geometry/support.hpp"
#include "narrowphase/pair_functions.hpp"

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
    Real reach;
    LocalManifold<Real>& out;

    Real height(const Vec3T<Real>& point) const { return depth - point.dot(into); }

    // A point of the core whose surface is `radius` further on; left out when beyond reach.
    void touch(const Vec3T<Real>& point, Real radius, std::uint32_t feature) const
    {
        const Real separation = height(point) - radius;
        if (!(separation <= reach)) return;
        out.add(point + into * (radius + separation / 2), separation, feature);
    }
};

// The lowest corner, then the others of the side that faces the plane; where some of that is out of
// reach, those reached along the edges that climb least.
template <class Real>
void touch_box(const Core<Real>& box, const Ground<Real>& ground)
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

    // The side that faces the plane, where all of it is within reach: a thin box that leans a
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
    const bool whole = highest <= ground.reach;
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
        ground.touch(point, Real(0), corner);
    }
}

// A cap when the axis leans towards the plane, else the lower line of the side.
template <class Real>
void touch_cylinder(const Core<Real>& cylinder, const Ground<Real>& ground)
{
    const Vec3T<Real>& into = ground.into;
    const Real across = std::sqrt(into.x() * into.x() + into.y() * into.y());
    if (std::abs(into.z()) > across) {
        const SupportFace<Real> cap = rim_points(cylinder, into);
        for (std::size_t i = 0; i < 4; ++i) ground.touch(cap.corners[i], Real(0), cap.features[i]);
        return;
    }
    const Real x = into.x() / across * cylinder.extents.x();
    const Real y = into.y() / across * cylinder.extents.x();
    ground.touch(Vec3T<Real>(x, y, -cylinder.extents.z()), Real(0), 32);
    ground.touch(Vec3T<Real>(x, y, cylinder.extents.z()), Real(0), 33);
}

// Of the vertices within reach, four that span the most area: the lowest, the one furthest from
// it, and the furthest to either side of the line between them. Among near equals the first wins,
// so that noise in the pose does not swap points from step to step.
template <class Real>
void touch_hull(const Hull& hull, Real size, const Ground<Real>& ground)
{
    Real lowest = std::numeric_limits<Real>::infinity();
    for (const Vec3& vertex : hull.vertices) {
        lowest = std::min(lowest, ground.height(vertex.cast<Real>()));
    }
    if (!(lowest <= ground.reach)) return;

    constexpr std::size_t kNone = ~std::size_t{0};
    const auto near_to = [&](Real limit, auto&& score) {
        std::size_t best = kNone;
        Real most = 0;
        for (std::size_t i = 0; i < hull.vertices.size(); ++i) {
            const Vec3T<Real> vertex = hull.vertices[i].cast<Real>();
            if (!(ground.height(vertex) <= limit)) continue;
            const Real now = score(vertex);
            if (!(now > most * Real(1.001))) continue;
            most = now;
            best = i;
        }
        return best;
    };
    const Real slack = std::min(Real(1e-4) * size, std::max(ground.reach - lowest, Real(0)));
    const std::size_t first = near_to(lowest + slack, [](const auto&) { return Real(1); });
    const Vec3T<Real> from = hull.vertices[first].cast<Real>();
    const auto flat_from = [&](const Vec3T<Real>& vertex) -> Vec3T<Real> {
        const Vec3T<Real> offset = vertex - from;
        return offset - ground.into * offset.dot(ground.into);
    };
    const std::size_t second =
        near_to(ground.reach, [&](const auto& vertex) { return flat_from(vertex).squaredNorm(); });
    ground.touch(from, Real(0), static_cast<std::uint32_t>(first));
    if (second == kNone) return;

    const Vec3T<Real> to = hull.vertices[second].cast<Real>();
    const Vec3T<Real> left = ground.into.cross(flat_from(to));
    // Below a millionth of the line's own square, an area is noise.
    const Real least = Real(1e-6) * left.squaredNorm();
    const auto beside = [&](Real sign) {
        return near_to(ground.reach,
                       [&](const auto& vertex) { return sign * left.dot(vertex - from) - least; });
    };
    ground.touch(to, Real(0), static_cast<std::uint32_t>(second));
    for (const std::size_t i : {beside(Real(1)), beside(Real(-1))}) {
        if (i == kNone) continue;
        ground.touch(hull.vertices[i].cast<Real>(), Real(0), static_cast<std::uint32_t>(i));
    }
}

}  // namespace

template <class Real>
void convex_plane(const Shapes& shapes,
                  ShapeRef a,
                  ShapeRef b,
                  const PoseT<Real>& b_in_a,
                  Real reach,
                  PairCache&,
                  LocalManifold<Real>& out)
{
    out.count = 0;
    const Plane& plane = shapes.planes[b.index];
    const Vec3T<Real> normal = b_in_a.orientation * plane.normal.template cast<Real>();
    out.normal = -normal;
    const Real depth = -(static_cast<Real>(plane.offset) + normal.dot(b_in_a.position));
    const Ground<Real> ground = {out.normal, depth, reach, out};

    const Core<Real> core = core_of<Real>(shapes, a);
    switch (core.kind) {
    case ShapeKind::sphere:
        ground.touch(Vec3T<Real>::Zero(), core.radius, 0);
        break;
    case ShapeKind::capsule:
        ground.touch(-core.extents, core.radius, 0);
        ground.touch(core.extents, core.radius, 1);
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
