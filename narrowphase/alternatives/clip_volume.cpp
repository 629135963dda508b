#include "narrowphase/alternatives/clip_volume.hpp"

#include "kernels/geometry/cut_polyhedron.hpp"
#include "narrowphase/alternatives/polytope_side.hpp"

#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace throng {
namespace {

// Beyond a plane by this much of the pair's noise is still on it: some twenty roundings of the
// coordinates. Ten times more would show in the volumes.
constexpr double kSlack = 0.02;
// Of two shapes the one this many times smaller is cut, whatever the number of faces: its vertices
// are known that much better.
constexpr double kSmaller = 4;
// Of the surface: what is left of areas that cancel.
constexpr double kNoArea = 1e-13;

// What the axis of a pair belongs to, as it is remembered.
constexpr std::uint32_t kFaceOfA = 1, kFaceOfB = 2;

struct Scratch {
    CutPolyhedron rest;
    std::vector<CutPlane> planes;
    std::vector<std::uint32_t> order;
};

// The pair, and the same seen from b.
struct BothWays {
    const PolytopePair& ab;
    PolytopePair ba;

    // From a to b, in a's frame.
    Vec3 normal_of(std::uint32_t side, const FaceAxis& axis) const
    {
        if (side == kFaceOfA) return ab.a.normals[axis.face];
        return -(ab.turn * ab.b.normals[axis.face]);
    }
};

void remember(std::uint32_t side, const FaceAxis& axis, MethodMemory& memory)
{
    memory.kind = side;
    memory.a[0] = axis.face;
    memory.b[0] = axis.vertex;
}

// Whether the face that parted them the last time still does.
bool still_parted(const BothWays& pair, double slack, const MethodMemory& memory, Vec3& normal)
{
    if (memory.kind != kFaceOfA && memory.kind != kFaceOfB) return false;
    const PolytopePair& seen = memory.kind == kFaceOfA ? pair.ab : pair.ba;
    if (memory.a[0] >= seen.a.normals.size() || memory.b[0] >= seen.b.vertices.size()) return false;
    const FaceAxis axis = face_axis(seen, static_cast<std::uint16_t>(memory.a[0]),
                                    static_cast<std::uint16_t>(memory.b[0]));
    normal = pair.normal_of(memory.kind, axis);
    return axis.separation > slack;
}

// The likely face of either that comes nearest to parting them, or parts them.
double likely_axis(const BothWays& pair, Vec3& normal, MethodMemory& memory)
{
    const FaceAxis of_a = likely_face_axis(pair.ab), of_b = likely_face_axis(pair.ba);
    const bool is_a = of_a.separation >= of_b.separation;
    const FaceAxis& axis = is_a ? of_a : of_b;
    normal = pair.normal_of(is_a ? kFaceOfA : kFaceOfB, axis);
    remember(is_a ? kFaceOfA : kFaceOfB, axis, memory);
    return axis.separation;
}

// Nothing is left of them, though no likely face parts them: perhaps another does, and will.
void seek_parting_face(const BothWays& pair,
                       double slack,
                       MethodAnswer& answer,
                       MethodMemory& memory)
{
    for (const std::uint32_t side : {kFaceOfA, kFaceOfB}) {
        const PolytopePair& seen = side == kFaceOfA ? pair.ab : pair.ba;
        const FaceAxis axis = best_face_axis(seen, likely_face_axis(seen), 0);
        if (!(axis.separation > slack)) continue;
        answer.normal = pair.normal_of(side, axis);
        remember(side, axis, memory);
        return;
    }
}

// The planes of b about a's center, in a's axes.
void place_planes(const PolytopePair& pair, double slack, std::vector<CutPlane>& planes)
{
    collect_planes(pair.b, slack, planes);
    const Vec3 shift = pair.shift - pair.a.center;
    for (CutPlane& plane : planes) {
        plane.normal = pair.turn * plane.normal;
        plane.offset += plane.normal.dot(shift);
    }
}

// Those planes that reach the polyhedron, first the one that its center is furthest beyond, for
// what that cuts off need not be cut again. The others stay with their neighbors: in order of depth
// they take as long.
void order_planes(Scratch& scratch)
{
    const std::vector<CutPlane>& planes = scratch.planes;
    std::vector<std::uint32_t>& order = scratch.order;
    order.clear();
    for (std::uint32_t i = 0; i < planes.size(); ++i) {
        if (scratch.rest.spared_by(planes[i])) continue;
        order.push_back(i);
        if (planes[i].offset < planes[order.front()].offset) std::swap(order.front(), order.back());
    }
}

bool is_cut_better(const PolytopeView& shape, const PolytopeView& other)
{
    if (shape.outer_radius * kSmaller < other.outer_radius) return true;
    if (shape.outer_radius > other.outer_radius * kSmaller) return false;
    return shape.normals.size() > other.normals.size();
}

// Whether anything is left of a.
bool cut_all(const PolytopePair& pair, bool plain, double slack, Scratch& scratch, int& rounds)
{
    place_planes(pair, slack, scratch.planes);
    scratch.rest.start(pair.a, slack, scratch.planes.size());
    if (plain) {
        scratch.order.resize(scratch.planes.size());
        std::iota(scratch.order.begin(), scratch.order.end(), 0U);
    } else {
        order_planes(scratch);
    }
    for (const std::uint32_t i : scratch.order) {
        if (!plain && scratch.rest.spared_by(scratch.planes[i])) continue;
        ++rounds;
        if (scratch.rest.cut(scratch.planes[i]) == CutPolyhedron::Cut::gone) return false;
    }
    return true;
}

// Whether what is left of a, and has no volume, is where b is, and not only beneath its planes.
bool is_left_at(const PolytopePair& pair, const CutPolyhedron& rest)
{
    const PolytopePair mirrored = pair.mirrored();
    int looks = 0;
    const PolytopeSide side{mirrored, pair.noise(), looks};
    const auto in_b = [&](const Vec3& x) -> Vec3 {
        return mirrored.turn * (x + pair.a.center) + mirrored.shift;
    };
    return rest.any_edge([&](const Vec3& from, const Vec3& to) {
        return is_inside(side, in_b(from), in_b(to), {});
    });
}

// What is left of a; none where that is nothing.
std::optional<Enclosed>
left_of(const PolytopePair& pair, bool plain, double slack, Scratch& scratch, int& rounds)
{
    if (!cut_all(pair, plain, slack, scratch, rounds)) return {};
    const Enclosed left = scratch.rest.enclosed();
    if (left.volume > 0 || is_left_at(pair, scratch.rest)) return left;
    return {};
}

}  // namespace

MethodAnswer
query_clip_volume(const ConvexPair& pair, double, MethodStart start, MethodMemory& memory)
{
    thread_local Scratch scratch;
    const BothWays shapes{*pair.polytopes(), pair.polytopes()->mirrored()};
    const double slack = kSlack * shapes.ab.noise();
    const bool plain = start == MethodStart::plain;
    MethodAnswer answer;
    answer.overlap = OverlapState::apart;
    if (start == MethodStart::cached && still_parted(shapes, slack, memory, answer.normal)) {
        answer.rounds = 1;
        return answer;
    }
    memory = {};
    MethodMemory likely;
    if (!plain) {
        answer.rounds = 2;
        if (likely_axis(shapes, answer.normal, likely) > slack) {
            memory = likely;
            return answer;
        }
    }

    const bool cut_b = !plain && is_cut_better(shapes.ab.b, shapes.ab.a);
    const PolytopePair& seen = cut_b ? shapes.ba : shapes.ab;
    const auto shared = left_of(seen, plain, slack, scratch, answer.rounds);
    if (!shared) {
        if (start == MethodStart::cached) seek_parting_face(shapes, slack, answer, memory);
        return answer;
    }
    answer.cut_short = scratch.rest.cut_short();
    answer.overlap = OverlapState::touching;
    answer.volume = shared->volume;
    answer.surface = shared->surface;
    const Vec3 center = shared->center + seen.a.center;
    answer.center = cut_b ? Vec3(shapes.ab.turn * center + shapes.ab.shift) : center;
    const double length = shared->own.norm();
    if (length > kNoArea * shared->surface) {
        answer.normal = (cut_b ? Vec3(shapes.ab.turn * -shared->own) : shared->own) / length;
    } else if (plain) {
        likely_axis(shapes, answer.normal, likely);
    }
    return answer;
}

double depth_along(const ConvexPair& pair, const Vec3& direction)
{
    return -separation_along(pair.cores(), direction);
}

}  // namespace throng
