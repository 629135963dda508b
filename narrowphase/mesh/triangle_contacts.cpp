#include "narrowphase/mesh/triangle_contacts.hpp"

#include "kernels/geometry/closest_points.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// Sine by which a neighbor may rise above a direction and still count as level with it: rounding.
constexpr double kLevel = 1e-9;

// A shape's center this part of its radius past an edge still counts as above the face, so that
// rounding on a seam never lets both triangles take it for the other's.
constexpr double kSeam = 1e-4;

// Sine of the angle beyond which what rises by less than the slack rises all the same.
constexpr double kSteep = 0.1;

bool rises(const Vec3& from, const Vec3& to, const Vec3& direction, double slack)
{
    const Vec3 step = to - from;
    const double up = direction.dot(step), sine = up > slack ? kLevel : kSteep;
    return up > 0 && up * up > sine * sine * step.squaredNorm();
}

std::size_t corner_of(const Mesh& mesh, std::uint32_t triangle, std::uint32_t vertex)
{
    const auto& ids = mesh.triangles[triangle];
    return ids[0] == vertex ? 0 : ids[1] == vertex ? 1 : 2;
}

// Visits the triangles round a vertex, over one side or the other; says whether it came all round.
template <class Visitor>
bool walk_round(const Mesh& mesh,
                std::uint32_t start,
                std::uint32_t vertex,
                std::size_t side,
                bool& stop,
                const Visitor& visit)
{
    std::uint32_t here = start;
    for (int steps = 0; steps < 256 && !stop; ++steps) {
        const std::size_t corner = corner_of(mesh, here, vertex);
        stop = visit(here, corner);
        const std::int32_t next = mesh.adjacent[here][(corner + side) % 3];
        if (next < 0) return false;
        here = static_cast<std::uint32_t>(next);
        if (here == start) return true;
    }
    return true;
}

// Whether the feature that a closest point lies on sticks out to the direction.
bool region_sticks_out(const MeshTriangle& triangle, TriangleRegion region, const Vec3& direction)
{
    if (region == TriangleRegion::face) return true;
    const auto number = static_cast<std::size_t>(region);
    if (number <= 3) return edge_sticks_out(triangle, number - 1, direction);
    return corner_sticks_out(triangle, number - 4, direction);
}

// The part of a segment above the triangle, widened a little; false where there is none.
bool clip_to_prism(const MeshTriangle& triangle, double slack, Segment<double>& segment)
{
    double first = 0, last = 1;
    const Vec3 along = segment.to - segment.from;
    for (std::size_t e = 0; e < 3; ++e) {
        const Vec3& corner = triangle.corners[e];
        const Vec3 side =
            (triangle.corners[(e + 1) % 3] - corner).cross(triangle.normal).normalized();
        const double at_from = side.dot(segment.from - corner) - slack;
        const double slope = side.dot(along);
        if (at_from > 0 && at_from + slope > 0) return false;
        // One end is inside: the crossing lies between the two.
        if (at_from > 0) first = std::max(first, -at_from / slope);
        if (at_from <= 0 && at_from + slope > 0) last = std::min(last, -at_from / slope);
    }
    if (first > last) return false;
    segment = {segment.from + first * along, segment.from + last * along};
    return true;
}

struct CapsuleClosest {
    Vec3 on_triangle, on_segment;
    TriangleRegion region;
    double distance2;
};

CapsuleClosest closest_on_capsule(const MeshTriangle& triangle, const Segment<double>& segment)
{
    const auto& corners = triangle.corners;
    CapsuleClosest best{};
    best.distance2 = std::numeric_limits<double>::max();
    for (const Vec3& end : {segment.from, segment.to}) {
        const auto found = closest_on_triangle<double>(end, corners[0], corners[1], corners[2]);
        const double distance2 = (found.point - end).squaredNorm();
        if (distance2 < best.distance2) best = {found.point, end, found.region, distance2};
    }
    for (std::size_t e = 0; e < 3; ++e) {
        const auto found = closest_points<double>({corners[e], corners[(e + 1) % 3]}, segment);
        const double distance2 = (found.on_a - found.on_b).squaredNorm();
        if (distance2 >= best.distance2) continue;
        const std::size_t region = found.at_a <= 0 ? 4 + e
            : found.at_a >= 1                      ? 4 + (e + 1) % 3
                                                   : 1 + e;
        best = {found.on_a, found.on_b, static_cast<TriangleRegion>(region), distance2};
    }
    return best;
}

// The rod's part above the triangle, measured along the triangle's normal.
void add_capsule_points(const MeshTriangle& triangle,
                        const Segment<double>& segment,
                        double radius,
                        double speculative_margin,
                        LocalManifold<double>& out)
{
    Segment<double> part = segment;
    if (!clip_to_prism(triangle, kSeam * radius, part)) return;
    out.normal = triangle.normal;
    std::uint32_t feature = 0;
    for (const Vec3& end : {part.from, part.to}) {
        const double height = triangle.height(end), separation = height - radius;
        const bool second = feature++ == 1;
        if (separation > speculative_margin || (second && part.to == part.from)) continue;
        out.add(end - triangle.normal * ((height + radius) / 2), separation, second ? 2 : 1);
    }
}

}  // namespace

MeshTriangle::MeshTriangle(const Mesh& of, std::uint32_t triangle, bool from_behind)
    : mesh(of), index(triangle), behind(from_behind), normal(of.normals[triangle])
{
    if (behind) normal = -normal;
    for (std::size_t i = 0; i < 3; ++i)
        corners[i] = of.vertices[of.triangles[triangle][own_corner(i)]];
}

bool MeshTriangle::is_crossed(const Vec3& from, const Vec3& to) const
{
    const double first = height(from), last = height(to);
    if ((first > 0) == (last > 0)) return false;
    const Vec3 at = from + (to - from) * (first / (first - last));
    for (std::size_t e = 0; e < 3; ++e) {
        const Vec3 along = corners[(e + 1) % 3] - corners[e];
        if (along.cross(at - corners[e]).dot(normal) < 0) return false;
    }
    return true;
}

bool corner_sticks_out(const MeshTriangle& triangle,
                       std::size_t corner,
                       const Vec3& direction,
                       double slack)
{
    const Mesh& mesh = triangle.mesh;
    const std::uint32_t vertex = mesh.triangles[triangle.index][triangle.own_corner(corner)];
    const Vec3& here = mesh.vertices[vertex];
    bool risen = false;
    const auto look = [&](std::uint32_t other, std::size_t at) {
        const auto& ids = mesh.triangles[other];
        return rises(here, mesh.vertices[ids[(at + 1) % 3]], direction, slack)
            || rises(here, mesh.vertices[ids[(at + 2) % 3]], direction, slack);
    };
    const bool all_round = walk_round(mesh, triangle.index, vertex, 0, risen, look);
    if (!risen && !all_round) walk_round(mesh, triangle.index, vertex, 2, risen, look);
    return !risen;
}

bool edge_sticks_out(const MeshTriangle& triangle,
                     std::size_t edge,
                     const Vec3& direction,
                     double slack)
{
    const Mesh& mesh = triangle.mesh;
    if (!triangle.is_convex(edge)) return false;
    const std::int32_t next = triangle.adjacent(edge);
    if (next < 0) return direction.dot(triangle.normal) >= 0;
    const auto& ids = mesh.triangles[static_cast<std::size_t>(next)];
    const Vec3& here = triangle.corners[edge];
    return !rises(here, mesh.vertices[ids[0]], direction, slack)
        && !rises(here, mesh.vertices[ids[1]], direction, slack)
        && !rises(here, mesh.vertices[ids[2]], direction, slack);
}

void collide_triangle_ball(const MeshTriangle& triangle,
                           const Vec3& center,
                           double radius,
                           double speculative_margin,
                           LocalManifold<double>& out,
                           bool through)
{
    out.count = 0;
    const double height = triangle.height(center);
    if ((height < 0 && !through) || height - radius > speculative_margin) return;
    const auto& corners = triangle.corners;
    const auto closest = closest_on_triangle<double>(center, corners[0], corners[1], corners[2]);
    const Vec3 apart = center - closest.point;
    const Vec3 past = apart - triangle.normal * height;
    double distance = height;
    Vec3 direction = triangle.normal;
    if (height >= 0 && past.norm() > kSeam * radius) {
        distance = apart.norm();
        direction = apart / distance;
        if (distance - radius > speculative_margin) return;
        // Where the mesh goes on past this edge, the triangle there is the one to push.
        if (!region_sticks_out(triangle, closest.region, direction)) return;
    }
    out.normal = direction;
    out.add(center - direction * ((distance + radius) / 2), distance - radius, 1);
}

void collide_triangle_capsule(const MeshTriangle& triangle,
                              const Vec3& from,
                              const Vec3& to,
                              double radius,
                              double speculative_margin,
                              LocalManifold<double>& out,
                              bool through)
{
    out.count = 0;
    const double height_from = triangle.height(from), height_to = triangle.height(to);
    const bool before = height_from + height_to >= 0;
    if ((!before && !through) || std::min(height_from, height_to) - radius > speculative_margin)
        return;
    const Segment<double> segment{from, to};
    // What runs through the face is measured along its normal, however far its ends are.
    if (!before || triangle.is_crossed(from, to))
        return add_capsule_points(triangle, segment, radius, speculative_margin, out);
    const CapsuleClosest closest = closest_on_capsule(triangle, segment);
    const double limit = speculative_margin + radius;
    if (closest.distance2 > limit * limit) return;

    // A rod that lies on the triangle, or leans over a seam, is measured from the face; only an
    // edge or a corner that sticks out pushes along the line to it.
    const Vec3 apart = closest.on_segment - closest.on_triangle;
    const double distance = std::sqrt(closest.distance2);
    const Vec3 past = apart - triangle.normal * triangle.normal.dot(apart);
    const bool over_face = closest.region == TriangleRegion::face || distance <= kSeam * radius
        || past.norm() <= kSeam * radius || triangle.normal.dot(apart) < 0;
    const Vec3 direction = over_face ? triangle.normal : Vec3(apart / distance);
    if (over_face || !region_sticks_out(triangle, closest.region, direction)) {
        add_capsule_points(triangle, segment, radius, speculative_margin, out);
        return;
    }
    out.normal = direction;
    out.add((closest.on_triangle + closest.on_segment - direction * radius) / 2, distance - radius,
            3);
}

}  // namespace throng
