#include "narrowphase/alternatives/polytope_side.hpp"

#include "kernels/geometry/closest_points.hpp"
#include "kernels/geometry/flat_faces.hpp"
#include "kernels/geometry/hill_climbing.hpp"

#include <algorithm>
#include <array>

namespace throng {
namespace {

// Steps from face to vertex to face; most walks end within three.
constexpr int kSteps = 8;
// How near a face, against the noise, is on it: some for the noise itself, some for measuring.
constexpr double kOnFace = 4;

using Line = Segment<double>;
using Corners = std::array<Vec3, 3>;

bool comes_near(const Line& line, const Corners& corners, double near)
{
    const auto is_near = [&](const Vec3& point) {
        const Vec3 on =
            closest_on_triangle<double>(point, corners[0], corners[1], corners[2]).point;
        return (point - on).squaredNorm() <= near * near;
    };
    if (is_near(line.from) || is_near(line.to)) return true;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto between = closest_points<double>(line, {corners[i], corners[(i + 1) % 3]});
        if ((between.on_a - between.on_b).squaredNorm() <= near * near) return true;
    }
    const Vec3 across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double here = across.dot(line.from - corners[0]);
    const double there = across.dot(line.to - corners[0]);
    return here * there < 0 && is_near(line.from + (line.to - line.from) * (here / (here - there)));
}

// Whether a line that is beneath all planes, to the noise, and not well beneath them, comes near a
// face. Only those whose planes it comes near can be.
bool comes_near_surface(const PolytopeSide& side, const Line& line)
{
    thread_local std::vector<FaceTriangle> triangles;
    const PolytopeView& shape = side.pair.a;
    for (std::size_t face = 0; face < shape.normals.size(); ++face) {
        const double highest = std::max(side.height(face, line.from), side.over(face, line.to));
        if (highest < -side.noise) continue;
        const auto corners = shape.face(face);
        const auto corner = [&](std::size_t i) { return shape.vertices[corners[i]]; };
        collect_triangles(shape, face, triangles);
        for (const FaceTriangle& t : triangles) {
            if (comes_near(line, {corner(t.first), corner(t.middle), corner(t.last)},
                           kOnFace * side.noise))
                return true;
        }
    }
    return false;
}

}  // namespace

bool cut(
    const PolytopeSide& side, std::size_t face, const Vec3& from, const Vec3& to, EdgePart& part)
{
    ++side.rounds;
    const double here = side.over(face, from) - side.noise;
    const double there = side.over(face, to) - side.noise;
    if (here > 0 && there > 0) {
        part.enters = part.leaves = face;
        return false;
    }
    if (here > 0 && here > part.from * (here - there)) {
        part.from = here / (here - there);
        part.enters = face;
    } else if (there > 0 && here > part.to * (here - there)) {
        part.to = here / (here - there);
        part.leaves = face;
    }
    return part.from <= part.to;
}

bool is_inside(const PolytopeSide& side, const Vec3& from, const Vec3& to, const EdgePart& part)
{
    const auto at = [&](double along) -> Vec3 { return from + (to - from) * along; };
    return nearest_face(side, at((part.from + part.to) / 2)).height < -side.noise
        || comes_near_surface(side, {at(part.from), at(part.to)});
}

bool meets(const PolytopeSide& side, const Vec3& from, const Vec3& to, EdgePart& part)
{
    const EdgePart last = part;
    part = {0, 1, last.enters, last.leaves};
    if (!cut(side, last.enters, from, to, part)) return false;
    if (last.leaves != last.enters && !cut(side, last.leaves, from, to, part)) return false;
    for (std::size_t face = 0; face < side.pair.a.normals.size(); ++face) {
        if (face == last.enters || face == last.leaves) continue;
        if (!cut(side, face, from, to, part)) return false;
    }
    return is_inside(side, from, to, part);
}

NearestFace nearest_face(const PolytopeSide& side, const Vec3& point)
{
    NearestFace nearest;
    for (std::size_t face = 0; face < side.pair.a.normals.size(); ++face) {
        const double height = side.height(face, point);
        if (height > nearest.height) nearest = {static_cast<std::uint16_t>(face), height};
    }
    return nearest;
}

bool has_inside(const PolytopeSide& side, const Vec3& point, const NearestFace& nearest)
{
    return nearest.height < -side.noise
        || (nearest.height <= side.noise && comes_near_surface(side, {point, point}));
}

FaceAxis lowest_vertex(const PolytopeSide& side, std::uint16_t face, std::uint16_t start)
{
    const Vec3 down = -(side.pair.turn.transpose() * side.pair.a.normals[face]);
    HillClimbingCount count;
    const std::uint16_t vertex =
        furthest_vertex_near(HillClimbingShape(side.pair.b), down, start, count);
    side.rounds += static_cast<int>(count.looked);
    return {side.height(face, side.place(vertex)), face, vertex};
}

WalkEnd walk(PolytopeSide& side, std::uint16_t face, std::uint16_t start)
{
    std::array<std::uint16_t, kSteps> seen;
    std::uint16_t vertex = start;
    for (std::size_t step = 0; step < kSteps; ++step) {
        const auto end = seen.begin() + static_cast<std::ptrdiff_t>(step);
        if (std::find(seen.begin(), end, face) != end) break;
        seen[step] = face;
        const FaceAxis axis = lowest_vertex(side, face, vertex);
        if (step == 0 || axis.separation > side.best.separation) side.best = axis;
        if (axis.separation > side.noise) return WalkEnd::parted;
        vertex = axis.vertex;
        const NearestFace nearest = nearest_face(side, side.place(vertex));
        if (has_inside(side, side.place(vertex), nearest)) {
            side.best = axis;
            return WalkEnd::inside;
        }
        face = nearest.face;
    }
    return WalkEnd::open;
}

BelowScratch& BelowScratch::of_thread()
{
    thread_local BelowScratch scratch;
    return scratch;
}

}  // namespace throng
