#include "cost/hard_cases/quad_truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

// Two directions whose sine is below this are one: their cross product is rounding.
constexpr double kParallel = 1e-24;

QuadVec operator+(const QuadVec& a, const QuadVec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
QuadVec operator-(const QuadVec& a, const QuadVec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
QuadVec operator*(const QuadVec& a, Quad s) { return {a.x * s, a.y * s, a.z * s}; }
Quad dot(const QuadVec& a, const QuadVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
QuadVec cross(const QuadVec& a, const QuadVec& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Newton from what double knows: each step doubles its digits.
Quad root(Quad square)
{
    const double guess = std::sqrt(static_cast<double>(square));
    if (!(guess > 0)) return 0;
    Quad value = guess;
    for (int i = 0; i < 2; ++i) value = (value + square / value) / 2;
    return value;
}

QuadVec quad(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 in_double(const QuadVec& v)
{
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
QuadVec turned(const QuadPose& pose, const QuadVec& v)
{
    return {dot(pose.rows[0], v), dot(pose.rows[1], v), dot(pose.rows[2], v)};
}
QuadVec placed(const QuadPose& pose, const QuadVec& v) { return turned(pose, v) + pose.position; }

struct Extent {
    Quad least, most;
};

Extent extent_along(const QuadSolid& solid, const QuadVec& axis)
{
    Extent extent{dot(solid.corners[0], axis), 0};
    extent.most = extent.least;
    for (const QuadVec& corner : solid.corners) {
        const Quad projection = dot(corner, axis);
        extent.least = std::min(extent.least, projection);
        extent.most = std::max(extent.most, projection);
    }
    return extent;
}

// The best axis of those offered, each both ways.
struct BestAxis {
    const QuadSolid &a, &b;
    Quad separation = -std::numeric_limits<double>::max();
    QuadVec normal = {0, 0, 1};

    void offer(const QuadVec& axis)
    {
        const Quad length = root(dot(axis, axis));
        if (!(length > 0)) return;
        const QuadVec unit = axis * (1 / length);
        const Extent of_a = extent_along(a, unit), of_b = extent_along(b, unit);
        keep(of_b.least - of_a.most, unit);
        keep(of_a.least - of_b.most, unit * -1);
    }
    void keep(Quad candidate, const QuadVec& unit)
    {
        if (!(candidate > separation)) return;
        separation = candidate;
        normal = unit;
    }
};

BestAxis best_axis(const QuadSolid& a, const QuadSolid& b)
{
    BestAxis best{a, b};
    for (const QuadVec& normal : a.normals) best.offer(normal);
    for (const QuadVec& normal : b.normals) best.offer(normal);
    for (const QuadVec& along_a : a.directions)
        for (const QuadVec& along_b : b.directions) {
            const QuadVec across = cross(along_a, along_b);
            const Quad scale = dot(along_a, along_a) * dot(along_b, along_b);
            if (dot(across, across) > scale * (kParallel * kParallel)) best.offer(across);
        }
    return best;
}

// The least of the squared distances offered.
struct Nearest {
    Quad square = std::numeric_limits<double>::max();
    QuadVec from_a;  // to b

    void offer(const QuadVec& between)
    {
        const Quad candidate = dot(between, between);
        if (!(candidate < square)) return;
        square = candidate;
        from_a = between;
    }
};

QuadVec to_segment(const QuadVec& point, const QuadVec& from, const QuadVec& along)
{
    const Quad length2 = dot(along, along);
    Quad at = length2 > 0 ? dot(point - from, along) / length2 : 0;
    at = std::max(Quad(0), std::min(Quad(1), at));
    return from + along * at - point;
}

// Where the lines of both come nearest, if that is inside both; ends are looked at elsewhere.
void offer_lines(const QuadVec& from_a,
                 const QuadVec& along_a,
                 const QuadVec& from_b,
                 const QuadVec& along_b,
                 Nearest& nearest)
{
    const QuadVec across = cross(along_a, along_b), between = from_b - from_a;
    const Quad det = dot(across, across);
    if (!(det > dot(along_a, along_a) * dot(along_b, along_b) * (kParallel * kParallel))) return;
    const Quad at_a = dot(cross(between, along_b), across) / det;
    const Quad at_b = dot(cross(between, along_a), across) / det;
    if (at_a < 0 || at_a > 1 || at_b < 0 || at_b > 1) return;
    nearest.offer(across * (dot(between, across) / det));
}

// The foot of a point on a triangle's plane, if that is inside the triangle. The difference from
// the point to the foot, times `sign`.
void offer_foot(const QuadSolid& solid,
                const std::array<std::uint16_t, 3>& triangle,
                const QuadVec& point,
                Quad sign,
                Nearest& nearest)
{
    const QuadVec& v0 = solid.corners[triangle[0]];
    const QuadVec ab = solid.corners[triangle[1]] - v0, ac = solid.corners[triangle[2]] - v0;
    const QuadVec normal = cross(ab, ac), to = point - v0;
    const Quad det = dot(normal, normal);
    if (!(det > dot(ab, ab) * dot(ac, ac) * (kParallel * kParallel))) return;
    // By this share outside counts as in: a foot on a side must not slip between two triangles.
    const Quad slip = -1e-28;
    const Quad on_c = dot(cross(ab, to), normal) / det, on_b = dot(cross(to, ac), normal) / det;
    if (on_b < slip || on_c < slip || on_b + on_c > 1 - slip) return;
    nearest.offer(normal * (-sign * dot(to, normal) / det));
}

void offer_points(const QuadSolid& points, const QuadSolid& solid, Quad sign, Nearest& nearest)
{
    for (const QuadVec& point : points.corners) {
        for (const auto& [i, j] : solid.segments) {
            const QuadVec& from = solid.corners[i];
            nearest.offer(to_segment(point, from, solid.corners[j] - from) * sign);
        }
        for (const auto& triangle : solid.triangles)
            offer_foot(solid, triangle, point, sign, nearest);
    }
}

Nearest nearest_features(const QuadSolid& a, const QuadSolid& b)
{
    Nearest nearest;
    offer_points(a, b, 1, nearest);
    offer_points(b, a, -1, nearest);
    for (const auto& [i, j] : a.segments)
        for (const auto& [k, l] : b.segments)
            offer_lines(a.corners[i], a.corners[j] - a.corners[i], b.corners[k],
                        b.corners[l] - b.corners[k], nearest);
    return nearest;
}

}  // namespace

QuadPose::QuadPose(const Pose& pose, const Vec3& origin)
    : position(quad(pose.position) - quad(origin))
{
    const Quad w = pose.orientation.w();
    const QuadVec v = quad(pose.orientation.vec());
    const Quad two = 2 / (w * w + dot(v, v));
    rows = {{{1 - two * (v.y * v.y + v.z * v.z), two * (v.x * v.y - w * v.z),
              two * (v.x * v.z + w * v.y)},
             {two * (v.x * v.y + w * v.z), 1 - two * (v.x * v.x + v.z * v.z),
              two * (v.y * v.z - w * v.x)},
             {two * (v.x * v.z - w * v.y), two * (v.y * v.z + w * v.x),
              1 - two * (v.x * v.x + v.y * v.y)}}};
}

QuadPose::QuadPose(const Mat3& turn, const Vec3& place) : position(quad(place))
{
    for (Eigen::Index i = 0; i < 3; ++i)
        rows[static_cast<std::size_t>(i)] = quad(turn.row(i).transpose());
}

QuadSolid quad_box(const Vec3& half_extents, const QuadPose& pose)
{
    QuadSolid solid;
    for (unsigned i = 0; i < 8; ++i) {
        Vec3 corner = half_extents;
        for (unsigned axis = 0; axis < 3; ++axis)
            if ((i >> axis & 1) == 0) corner[axis] = -corner[axis];
        solid.corners.push_back(placed(pose, quad(corner)));
    }
    for (unsigned axis = 0; axis < 3; ++axis) {
        solid.directions.push_back(turned(pose, quad(Vec3::Unit(axis))));
        const unsigned next = 1u << (axis + 1) % 3, last = 1u << (axis + 2) % 3, up = 1u << axis;
        const auto name = [](unsigned corner) { return static_cast<std::uint16_t>(corner); };
        for (const unsigned side : {0u, next, last, next | last})
            solid.segments.push_back({name(side), name(side | up)});
        for (const unsigned side : {0u, up}) {
            solid.triangles.push_back({name(side), name(side | next), name(side | last)});
            solid.triangles.push_back(
                {name(side | next), name(side | last), name(side | next | last)});
        }
    }
    // Exact face normals: those of the turned box, sheared or not.
    for (std::size_t axis = 0; axis < 3; ++axis)
        solid.normals.push_back(
            cross(solid.directions[(axis + 1) % 3], solid.directions[(axis + 2) % 3]));
    return solid;
}

QuadSolid quad_cloud(std::span<const Vec3> points, const QuadPose& pose)
{
    QuadSolid solid;
    for (const Vec3& point : points) solid.corners.push_back(placed(pose, quad(point)));
    const auto count = static_cast<std::uint16_t>(points.size());
    for (std::uint16_t i = 0; i < count; ++i)
        for (std::uint16_t j = 0; j < i; ++j) {
            const QuadVec side = solid.corners[i] - solid.corners[j];
            solid.segments.push_back({i, j});
            solid.directions.push_back(side);
            for (std::uint16_t k = 0; k < j; ++k) {
                solid.triangles.push_back({i, j, k});
                solid.normals.push_back(cross(side, solid.corners[i] - solid.corners[k]));
            }
        }
    return solid;
}

QuadTruth quad_truth(const QuadSolid& a, const QuadSolid& b)
{
    const BestAxis best = best_axis(a, b);
    if (!(best.separation > 0))
        return {static_cast<double>(best.separation), in_double(best.normal)};
    const Nearest nearest = nearest_features(a, b);
    const Quad distance = root(nearest.square);
    return {static_cast<double>(distance), in_double(nearest.from_a * (1 / distance))};
}

double quad_separation_along(const QuadSolid& a, const QuadSolid& b, const Vec3& direction)
{
    const QuadVec along = quad(direction);
    const Quad length = root(dot(along, along));
    const QuadVec unit = along * (1 / length);
    return static_cast<double>(extent_along(b, unit).least - extent_along(a, unit).most);
}

double quad_outside(const QuadSolid& solid, const Vec3& point)
{
    const QuadVec at = quad(point);
    Quad outside = -std::numeric_limits<double>::max();
    for (const QuadVec& normal : solid.normals) {
        const Quad length = root(dot(normal, normal));
        if (!(length > 0)) continue;
        const QuadVec unit = normal * (1 / length);
        const Extent extent = extent_along(solid, unit);
        const Quad projection = dot(at, unit);
        outside = std::max({outside, projection - extent.most, extent.least - projection});
    }
    return static_cast<double>(outside);
}

}  // namespace throng
