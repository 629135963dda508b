#include "narrowphase/methods/polytope_side.hpp"

#include "narrowphase/methods/climbing_support.hpp"

#include <algorithm>
#include <array>

namespace throng {
namespace {

// Steps from face to vertex to face; most walks end within three.
constexpr int kSteps = 8;

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
    return true;
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

FaceAxis lowest_vertex(const PolytopeSide& side, std::uint16_t face, std::uint16_t start)
{
    const Vec3 down = -(side.pair.turn.transpose() * side.pair.a.normals[face]);
    ClimbCount count;
    const std::uint16_t vertex =
        furthest_vertex_near(ClimbingShape(side.pair.b), down, start, count);
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
        if (nearest.height <= side.noise) {
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
