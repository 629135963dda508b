#include "narrowphase/mesh/mesh_sides.hpp"

#include "kernels/geometry/closest_points.hpp"
#include "kernels/geometry/mesh.hpp"
#include "narrowphase/mesh/triangle_contacts.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

// What is hidden is looked for along this share of the way to it: not where it is itself.
constexpr double kNearly = 0.999;

// So far from its nearest place towards the middle of a triangle, as a share of the way there, is
// looked whether it is hidden: what lies on a ridge sees the edge of the far flank.
constexpr double kInward = 0.05;

// Over a seam, by this share of the shape's size, a center is over both triangles.
constexpr double kSeam = 1e-4;

TrianglePoint<double> nearest_to(const Vec3& point, const MeshTriangle& triangle)
{
    const auto& [a, b, c] = triangle.corners;
    return closest_on_triangle<double>(point, a, b, c);
}

}  // namespace

MeshSides::MeshSides(const Mesh& mesh,
                     std::span<const std::uint32_t> near,
                     std::span<const std::uint32_t> held,
                     const Vec3& center,
                     double through)
    : mesh_(mesh), near_(near), held_(held), center_(center), through_(through)
{
    for (const std::uint32_t one : held_) {
        const std::uint32_t triangle = one & ~kBehind;
        const bool behind = (one & kBehind) != 0;
        if ((height(triangle) < 0) != behind && crossed(triangle, behind).through) came_ = true;
    }
}

double MeshSides::height(std::uint32_t triangle) const
{
    return mesh_.normals[triangle].dot(center_ - mesh_.vertices[mesh_.triangles[triangle][0]]);
}

// 0 in front, 1 behind; of the triangle itself, else of one over an edge; -1 of none.
int MeshSides::side_held(std::uint32_t triangle) const
{
    int side = -1;
    for (const std::uint32_t held : held_) {
        const std::uint32_t other = held & ~kBehind;
        const int of_other = (held & kBehind) != 0 ? 1 : 0;
        if (other == triangle) return of_other;
        for (const std::int32_t next : mesh_.adjacent[triangle])
            if (next == static_cast<std::int32_t>(other)) side = of_other;
    }
    return side;
}

// One that was on a side of a triangle and has its center on the other now: come through it, or
// gone round.
MeshSides::Approach MeshSides::crossed(std::uint32_t triangle, bool behind) const
{
    const MeshTriangle seen(mesh_, triangle, behind);
    const Approach went_round{.behind = !behind}, through{true, behind, true, true};
    const auto nearest = nearest_to(center_, seen);
    if (-seen.height(center_) > through_ && is_hidden(nearest.point, triangle)) return went_round;
    const Vec3 apart = center_ - nearest.point;
    const Vec3 past = apart - seen.normal * seen.normal.dot(apart);
    if (past.norm() <= kSeam * through_) return through;
    const auto [first, last] = edges_at(nearest.region);
    if (seen.adjacent(first) < 0 || seen.adjacent(last) < 0) return went_round;
    // Over an edge within: the triangle that the center is over pushes.
    return {.any = false};
}

// Whether the center is within the volume that a closed piece encloses, with this triangle the
// nearest that is near.
bool MeshSides::is_inside_of(std::uint32_t triangle) const
{
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = triangle;
    std::size_t region = 0;
    for (const std::uint32_t other : near_) {
        const auto found = nearest_to(center_, MeshTriangle(mesh_, other));
        const double distance2 = (found.point - center_).squaredNorm();
        if (!(distance2 < least)) continue;
        least = distance2;
        nearest = other;
        region = static_cast<std::size_t>(found.region);
    }
    if (nearest != triangle || region > 3) return false;
    if (region == 0) return true;
    const std::int32_t next = mesh_.adjacent[triangle][region - 1];
    return next >= 0 && height(static_cast<std::uint32_t>(next)) < 0;
}

MeshSides::Approach MeshSides::approach(std::uint32_t triangle) const
{
    const bool behind = height(triangle) < 0;
    const bool open = (mesh_.convex_edges[triangle] & kOpenPiece) != 0;
    const int held = held_.empty() ? -1 : side_held(triangle);
    if (open) {
        const bool known = held == (behind ? 1 : 0);
        // Of those that it has come through, the one that it is over pushes for all.
        if (held < 0 && came_) return {.any = false};
        if (known || held < 0) return {.behind = behind, .known = known};
        return crossed(triangle, held == 1);
    }
    if (!behind) return {};
    if (held == 0) {
        const Approach came = crossed(triangle, false);
        return came.through ? came : Approach{.any = false};
    }
    const bool inside = held_.empty() && is_inside_of(triangle);
    return {.any = inside, .through = inside};
}

bool MeshSides::is_hidden(const Vec3& point, std::uint32_t triangle) const
{
    const MeshTriangle seen(mesh_, triangle);
    const Vec3 place = nearest_to(point, seen).point;
    const auto& [a, b, c] = seen.corners;
    const Vec3 inward = kInward * ((a + b + c) / 3 - place);
    const double most = through_ / std::max(inward.norm(), through_);
    const Vec3 way = kNearly * (place + most * inward - center_);
    return std::any_of(near_.begin(), near_.end(), [&](std::uint32_t other) {
        return other != triangle && MeshTriangle(mesh_, other).is_crossed(center_, center_ + way);
    });
}

}  // namespace throng
