#include "kernels/geometry/support.hpp"

#include "kernels/check.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

template <class Real>
constexpr Real kHalfRoot = Real(0.70710678118654752440);

template <class Real>
SupportPoint<Real> furthest_vertex(const Hull& hull, const Vec3T<Real>& direction)
{
    SupportPoint<Real> best;
    Real most = -std::numeric_limits<Real>::infinity();
    for (std::size_t i = 0; i < hull.vertices.size(); ++i) {
        const Real along = hull.vertices[i].cast<Real>().dot(direction);
        if (!(along > most)) continue;
        most = along;
        best.feature = static_cast<std::uint32_t>(i);
    }
    best.position = hull.vertices[best.feature].template cast<Real>();
    return best;
}

template <class Real>
SupportPoint<Real> furthest_of_cylinder(const ConvexCore<Real>& core, const Vec3T<Real>& direction)
{
    const bool above = direction.z() >= 0;
    SupportPoint<Real> point;
    point.position.z() = above ? core.extents.z() : -core.extents.z();
    point.feature = above ? 1 : 0;
    // Scaled first: a direction may be so short or long that its square is 0 or infinite.
    const Real scale = std::max(std::abs(direction.x()), std::abs(direction.y()));
    if (scale > 0) {
        const Real x = direction.x() / scale;
        const Real y = direction.y() / scale;
        const Real rim_radius = core.extents.x() / std::sqrt(x * x + y * y);
        point.position.x() = x * rim_radius;
        point.position.y() = y * rim_radius;
    }
    return point;
}

template <class Real>
SupportFace<Real> box_face(const ConvexCore<Real>& core, const Vec3T<Real>& direction)
{
    int axis = 0;
    if (std::abs(direction.y()) > std::abs(direction[axis])) axis = 1;
    if (std::abs(direction.z()) > std::abs(direction[axis])) axis = 2;
    const bool positive = direction[axis] >= 0;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;

    SupportFace<Real> face;
    face.normal = Vec3T<Real>::Zero();
    face.normal[axis] = positive ? Real(1) : Real(-1);
    face.feature = static_cast<std::uint32_t>(2 * axis + (positive ? 1 : 0));
    face.flat = true;
    // (u, v, axis) is right-handed: counter-clockwise about +axis, the other way about -axis.
    constexpr std::array<int, 4> kU = {-1, 1, 1, -1};
    constexpr std::array<int, 4> kV = {-1, -1, 1, 1};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t turn = positive ? i : 3 - i;
        Vec3T<Real> corner = core.extents;
        corner[axis] *= face.normal[axis];
        corner[u] *= static_cast<Real>(kU[turn]);
        corner[v] *= static_cast<Real>(kV[turn]);
        const std::uint32_t bits =
            (corner.x() > 0 ? 1u : 0u) | (corner.y() > 0 ? 2u : 0u) | (corner.z() > 0 ? 4u : 0u);
        face.add(corner, bits);
    }
    return face;
}

template <class Real>
SupportFace<Real> hull_face(const ConvexCore<Real>& core, const Vec3T<Real>& direction)
{
    const Hull& hull = *core.hull;
    SupportFace<Real> face;
    if (hull.normals.empty()) {
        const SupportPoint<Real> point = furthest_vertex(hull, direction);
        face.normal = direction;
        face.add(point.position, point.feature);
        return face;
    }
    std::size_t best = 0;
    Real most = -std::numeric_limits<Real>::infinity();
    for (std::size_t i = 0; i < hull.normals.size(); ++i) {
        const Real along = hull.normals[i].cast<Real>().dot(direction);
        if (!(along > most)) continue;
        most = along;
        best = i;
    }
    face.normal = hull.normals[best].template cast<Real>();
    face.feature = static_cast<std::uint32_t>(best);
    face.flat = true;
    const std::size_t begin = hull.face_begin[best];
    const std::size_t corners = hull.face_begin[best + 1] - begin;
    const std::size_t kept = std::min(corners, static_cast<std::size_t>(kMaxFaceCorners));
    for (std::size_t i = 0; i < kept; ++i) {
        const std::uint16_t vertex = hull.face_vertices[begin + i * corners / kept];
        face.add(hull.vertices[vertex].template cast<Real>(), vertex);
    }
    return face;
}

// Four points of a cap's rim and the four between them, all eight or every second one.
//
// The first point follows the direction once the cap leans by more than kLean; standing straighter
// it turns back towards the body's own axes, so that noise does not send it round the rim.
template <class Real>
SupportFace<Real> cap_of(const ConvexCore<Real>& core, const Vec3T<Real>& direction, bool between)
{
    constexpr Real kLean = Real(0.0002);
    const Real side = direction.z() > 0 ? Real(1) : Real(-1);
    const Real lean = std::sqrt(direction.x() * direction.x() + direction.y() * direction.y());
    const bool along_x = std::abs(direction.x()) >= std::abs(direction.y());
    const Real sign = (along_x ? direction.x() : direction.y()) >= 0 ? Real(1) : Real(-1);
    Real x = along_x ? sign : Real(0);
    Real y = along_x ? Real(0) : sign;
    if (lean > 0) {
        const Real weight = std::min(Real(1), lean / kLean);
        x += weight * (direction.x() / lean - x);
        y += weight * (direction.y() / lean - y);
        const Real length = std::sqrt(x * x + y * y);
        x /= length;
        y /= length;
    }
    // The quarter names the points while they stay with the body; the lean does once it leads them.
    std::uint32_t first = 8;
    if (lean < kLean) first = (along_x ? 0u : 2u) + (sign < 0 ? 4u : 0u);
    const std::uint32_t base = side > 0 ? 16 : 0;

    SupportFace<Real> face;
    face.normal = Vec3T<Real>(0, 0, side);
    face.feature = side > 0 ? 1 : 0;
    face.flat = true;
    const Real height = side * core.extents.z();
    const auto add = [&](Real at_x, Real at_y, std::uint32_t step) {
        const std::uint32_t name = first == 8 ? 8 + step : (first + step) % 8;
        face.add(Vec3T<Real>(at_x * core.extents.x(), at_y * core.extents.x(), height),
                 base + name);
    };
    // Counter-clockwise about +z; seen from below that is the other way round.
    for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
        const Real next_x = -side * y;
        const Real next_y = side * x;
        const std::uint32_t step = side > 0 ? 2 * quarter : (8 - 2 * quarter) % 8;
        add(x, y, step);
        if (between) {
            const Real root = kHalfRoot<Real>;
            add((x + next_x) * root, (y + next_y) * root, side > 0 ? step + 1 : (step + 7) % 8);
        }
        x = next_x;
        y = next_y;
    }
    return face;
}

// The line of a cylinder's side, or the core of a capsule: a segment along z.
template <class Real>
SupportFace<Real> side_line(const Vec3T<Real>& direction, Real x, Real y, Real half)
{
    SupportFace<Real> face;
    face.normal = direction;
    face.feature = 2;
    face.add(Vec3T<Real>(x, y, -half), 32);
    face.add(Vec3T<Real>(x, y, half), 33);
    return face;
}

}  // namespace

template <class Real>
ConvexCore<Real> convex_core_of(const Shapes& shapes, ShapeRef shape)
{
    ConvexCore<Real> core;
    core.kind = shape.kind;
    switch (shape.kind) {
    case ShapeKind::sphere:
        core.convex_radius = static_cast<Real>(shapes.spheres[shape.index].radius);
        core.size = core.convex_radius;
        break;
    case ShapeKind::capsule: {
        const Capsule& capsule = shapes.capsules[shape.index];
        core.convex_radius = static_cast<Real>(capsule.radius);
        core.extents.z() = static_cast<Real>(capsule.half_length);
        core.size = core.convex_radius + core.extents.z();
        break;
    }
    case ShapeKind::cylinder: {
        const Cylinder& cylinder = shapes.cylinders[shape.index];
        const Real radius = static_cast<Real>(cylinder.radius);
        core.extents = Vec3T<Real>(radius, radius, static_cast<Real>(cylinder.half_length));
        core.size = radius + core.extents.z();
        break;
    }
    case ShapeKind::box:
        core.extents = shapes.boxes[shape.index].half_extents.template cast<Real>();
        core.size = core.extents.sum();
        break;
    case ShapeKind::hull: {
        core.hull = &shapes.hulls[shape.index];
        core.middle = core.hull->center.template cast<Real>();
        core.size = static_cast<Real>(core.hull->outer_radius) + core.middle.cwiseAbs().maxCoeff();
        core.extents = Vec3T<Real>::Constant(static_cast<Real>(core.hull->outer_radius));
        break;
    }
    default:
        THRONG_CHECK(false, "a core needs a convex shape of finite size");
    }
    return core;
}

template <class Real>
ConvexCore<Real> convex_core_of_points(std::span<const Vec3T<Real>> corners)
{
    ConvexCore<Real> core;
    core.kind = ShapeKind::triangle;
    core.corners = corners.data();
    core.corner_count = static_cast<std::uint32_t>(corners.size());
    for (const Vec3T<Real>& corner : corners)
        core.middle += corner / static_cast<Real>(corners.size());
    for (const Vec3T<Real>& corner : corners) {
        core.extents = core.extents.cwiseMax((corner - core.middle).cwiseAbs());
        core.size = std::max(core.size, corner.norm());
    }
    return core;
}

template <class Real>
SupportPoint<Real> support(const ConvexCore<Real>& core, const Vec3T<Real>& direction)
{
    SupportPoint<Real> point;
    switch (core.kind) {
    case ShapeKind::capsule:
        point.feature = direction.z() >= 0 ? 1 : 0;
        point.position.z() = direction.z() >= 0 ? core.extents.z() : -core.extents.z();
        break;
    case ShapeKind::cylinder:
        return furthest_of_cylinder(core, direction);
    case ShapeKind::box:
        for (int i = 0; i < 3; ++i) {
            point.position[i] = direction[i] >= 0 ? core.extents[i] : -core.extents[i];
            if (direction[i] >= 0) point.feature |= 1u << i;
        }
        break;
    case ShapeKind::hull:
        return furthest_vertex(*core.hull, direction);
    case ShapeKind::triangle:
        for (std::uint32_t i = 1; i < core.corner_count; ++i)
            if (core.corners[i].dot(direction) > core.corners[point.feature].dot(direction))
                point.feature = i;
        point.position = core.corners[point.feature];
        break;
    default:
        break;
    }
    return point;
}

template <class Real>
SupportFace<Real> support_face(const ConvexCore<Real>& core, const Vec3T<Real>& direction)
{
    switch (core.kind) {
    case ShapeKind::box:
        return box_face(core, direction);
    case ShapeKind::hull:
        return hull_face(core, direction);
    case ShapeKind::cylinder: {
        if (std::abs(direction.z()) > kHalfRoot<Real>) {
            return cap_of(core, direction, true);
        }
        const SupportPoint<Real> rim = furthest_of_cylinder(core, direction);
        return side_line(direction, rim.position.x(), rim.position.y(), core.extents.z());
    }
    case ShapeKind::capsule:
        if (std::abs(direction.z()) < Real(0.17)) {
            return side_line(direction, Real(0), Real(0), core.extents.z());
        }
        break;
    default:
        break;
    }
    const SupportPoint<Real> point = support(core, direction);
    SupportFace<Real> face;
    face.normal = direction;
    face.add(point.position, point.feature + 32);
    return face;
}

template <class Real>
SupportFace<Real> rim_points(const ConvexCore<Real>& cylinder, const Vec3T<Real>& direction)
{
    return cap_of(cylinder, direction, false);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template ConvexCore<Real> convex_core_of<Real>(const Shapes&, ShapeRef);                       \
    template ConvexCore<Real> convex_core_of_points<Real>(std::span<const Vec3T<Real>>);           \
    template SupportPoint<Real> support<Real>(const ConvexCore<Real>&, const Vec3T<Real>&);        \
    template SupportFace<Real> support_face<Real>(const ConvexCore<Real>&, const Vec3T<Real>&);    \
    template SupportFace<Real> rim_points<Real>(const ConvexCore<Real>&, const Vec3T<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
