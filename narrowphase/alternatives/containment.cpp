#include "narrowphase/alternatives/containment.hpp"

#include "kernels/geometry/closest_points.hpp"
#include "narrowphase/alternatives/polytope_side.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

enum class Remembered : std::uint32_t { nothing, parted, vertex, edge, between };

// What is remembered of a body: its face, its vertex beneath the other's face, and its edge's ends.
constexpr std::size_t kFace = 0, kVertex = 1, kFrom = 2, kTo = 3;

struct Side : PolytopeSide {
    bool mirrored = false;
    std::uint32_t* of_planes = nullptr;  // what is remembered of the body with the planes
    std::uint32_t* of_edges = nullptr;   // ... and of the other
};

bool passes_by(const PolytopeSide& side, const Vec3& from, const Vec3& to)
{
    ++side.rounds;
    const PolytopeView& ball = side.pair.a;
    const Vec3 nearest = closest_on_segment<double>(ball.center, {from, to}).point;
    const double limit = ball.outer_radius + side.noise;
    return (nearest - ball.center).squaredNorm() > limit * limit;
}

// Whether an edge goes through the other body; it is remembered.
bool any_edge_meets(const Side& side)
{
    EdgePart part{0, 1, side.best.face, side.best.face};
    const auto no = [](std::uint16_t) { return false; };
    return any_below(side, no, [&](std::uint16_t from, std::uint16_t to) {
        const Vec3 start = side.place(from), end = side.place(to);
        if (passes_by(side, start, end) || !meets(side, start, end, part)) return false;
        side.of_edges[kFrom] = from;
        side.of_edges[kTo] = to;
        return true;
    });
}

// Every vertex and every edge against every face.
bool meets_at_all(const PolytopeSide& side)
{
    bool touching = false;
    for (std::size_t vertex = 0; vertex < side.pair.b.vertices.size(); ++vertex) {
        const Vec3 point = side.place(vertex);
        touching |= has_inside(side, point, nearest_face(side, point));
    }
    for (const Hull::Edge& edge : side.pair.b.edges) {
        const Vec3 from = side.place(edge.from), to = side.place(edge.to);
        EdgePart part;
        bool left = true;
        for (std::size_t face = 0; face < side.pair.a.normals.size(); ++face) {
            left &= cut(side, face, from, to, part);
        }
        touching |= left && is_inside(side, from, to, part);
    }
    return touching;
}

bool fits(const PolytopeView& shape, const std::uint32_t* indices)
{
    const std::size_t vertices = shape.vertices.size();
    return indices[kFace] < shape.normals.size() && indices[kVertex] < vertices
        && indices[kFrom] < vertices && indices[kTo] < vertices;
}

bool still_has_inside(const PolytopeSide& side, const Vec3& point)
{
    ++side.rounds;
    const double within = side.pair.a.inner_radius;
    return (point - side.pair.a.center).squaredNorm() < within * within
        || has_inside(side, point, nearest_face(side, point));
}

// Whether what was found the last time still is so.
WalkEnd recall(Side& side, Remembered kind)
{
    const auto face = static_cast<std::uint16_t>(side.of_planes[kFace]);
    const auto vertex = static_cast<std::uint16_t>(side.of_edges[kVertex]);
    if (kind == Remembered::parted || kind == Remembered::between) {
        side.best = lowest_vertex(side, face, vertex);
        return side.best.separation > side.noise ? WalkEnd::parted : WalkEnd::open;
    }
    side.best = {0, face, vertex};
    if (kind == Remembered::vertex)
        return still_has_inside(side, side.place(vertex)) ? WalkEnd::inside : WalkEnd::open;
    EdgePart part{0, 1, face, face};
    const Vec3 from = side.place(side.of_edges[kFrom]), to = side.place(side.of_edges[kTo]);
    return meets(side, from, to, part) ? WalkEnd::inside : WalkEnd::open;
}

// Of the face that parts the two, from a to b in a's frame, whichever of them has it.
Vec3 normal_of(const Side& side)
{
    const Vec3& normal = side.pair.a.normals[side.best.face];
    return side.mirrored ? Vec3(-(side.pair.turn.transpose() * normal)) : normal;
}

// Looks for a face that parts the two or for a vertex inside, from the face nearest the other's
// center onwards.
WalkEnd look_round(PolytopeSide& side)
{
    const Vec3 center = side.pair.turn * side.pair.b.center + side.pair.shift;
    return walk(side, nearest_face(side, center).face, side.best.vertex);
}

void remember(const Side& side, Remembered kind, MethodMemory& memory)
{
    side.of_planes[kFace] = side.best.face;
    side.of_edges[kVertex] = side.best.vertex;
    memory.kind = static_cast<std::uint32_t>(kind) * 2 + (side.mirrored ? 1 : 0);
}

// What the balls round the two and inside them tell, and the direction between them if that parts
// the two.
OverlapState touch_of_balls(const PolytopePair& pair, double noise, Vec3& normal)
{
    const double square = pair.offset.squaredNorm();
    const double outer = pair.a.outer_radius + pair.b.outer_radius + noise;
    if (square > outer * outer) {
        normal = pair.offset / std::sqrt(square);
        return OverlapState::apart;
    }
    const double inner = pair.a.inner_radius + pair.b.inner_radius - noise;
    return inner > 0 && square < inner * inner ? OverlapState::touching : OverlapState::undecided;
}

OverlapState touch_by_looking(const PolytopePair& pair, int& rounds)
{
    const PolytopePair mirrored = pair.mirrored();
    const PolytopeSide side{pair, pair.noise(), rounds};
    const PolytopeSide other{mirrored, pair.noise(), rounds};
    const bool either = meets_at_all(side), or_other = meets_at_all(other);
    return either || or_other ? OverlapState::touching : OverlapState::apart;
}

OverlapState touch_by_walking(
    const PolytopePair& pair, bool cached, MethodMemory& memory, int& rounds, Vec3& normal)
{
    const double noise = pair.noise();
    ++rounds;
    const OverlapState of_balls = touch_of_balls(pair, noise, normal);
    if (of_balls != OverlapState::undecided) return of_balls;

    auto kind = static_cast<Remembered>(memory.kind / 2);
    if (!cached || !fits(pair.a, memory.a) || !fits(pair.b, memory.b)) kind = Remembered::nothing;
    // The side that answered the last time goes first.
    const bool turned = kind != Remembered::nothing && memory.kind % 2 == 1;
    std::optional<PolytopePair> mirrored;
    const auto side_of = [&](bool of_mirrored) -> Side {
        if (!of_mirrored) return {{pair, noise, rounds}, false, memory.a, memory.b};
        if (!mirrored) mirrored = pair.mirrored();
        return {{*mirrored, noise, rounds}, true, memory.b, memory.a};
    };
    const auto settled = [&](const Side& side, WalkEnd outcome, Remembered inside) {
        if (outcome == WalkEnd::open) return OverlapState::undecided;
        const bool parted = outcome == WalkEnd::parted;
        remember(side, parted ? Remembered::parted : inside, memory);
        if (parted) normal = normal_of(side);
        return parted ? OverlapState::apart : OverlapState::touching;
    };

    Side first = side_of(turned);
    WalkEnd outcome = WalkEnd::open;
    if (kind != Remembered::nothing) outcome = recall(first, kind);
    if (outcome != WalkEnd::open) return settled(first, outcome, kind);
    if (kind == Remembered::parted)
        outcome = walk(first, first.best.face, first.best.vertex);
    else if (kind != Remembered::between)
        outcome = look_round(first);
    if (outcome != WalkEnd::open) return settled(first, outcome, Remembered::vertex);

    Side second = side_of(!turned);
    outcome = kind == Remembered::between ? recall(second, kind) : look_round(second);
    if (outcome != WalkEnd::open) return settled(second, outcome, Remembered::vertex);

    if (any_edge_meets(first)) return settled(first, WalkEnd::inside, Remembered::edge);
    if (any_edge_meets(second)) return settled(second, WalkEnd::inside, Remembered::edge);
    remember(second, Remembered::between, memory);
    remember(first, Remembered::between, memory);
    return OverlapState::apart;
}

void add(ContainmentPoints& out, const ContainmentPoints::Point& point)
{
    if (out.count == ContainmentPoints::kCapacity)
        ++out.dropped;
    else
        out.points[out.count++] = point;
}

// The corners that vertices and edges of the one side make. False where a face parts the two.
bool add_points(Side& side, ContainmentPoints& out)
{
    using Kind = ContainmentPoints::Kind;
    if (look_round(side) == WalkEnd::parted) return false;
    EdgePart part{0, 1, side.best.face, side.best.face};
    const auto add_vertex = [&](std::uint16_t vertex) {
        const Vec3 point = side.place(vertex);
        const NearestFace nearest = nearest_face(side, point);
        if (has_inside(side, point, nearest)) {
            add(out,
                {point, Kind::vertex, !side.mirrored, vertex, vertex, nearest.face,
                 -nearest.height});
        }
        return false;
    };
    const auto add_crossings = [&](std::uint16_t from, std::uint16_t to) {
        const Vec3 start = side.place(from), along = side.place(to) - start;
        if (!meets(side, start, start + along, part)) return false;
        const std::uint16_t lower = std::min(from, to), upper = std::max(from, to);
        const auto add_crossing = [&](double at, std::size_t face) {
            add(out,
                {start + along * at, Kind::edge, !side.mirrored, lower, upper,
                 static_cast<std::uint16_t>(face), 0});
        };
        if (part.from > 0) add_crossing(part.from, part.enters);
        if (part.to < 1) add_crossing(part.to, part.leaves);
        return false;
    };
    any_below(side, add_vertex, add_crossings);
    return true;
}

}  // namespace

MethodAnswer
query_containment(const ConvexPair& pair, double, MethodStart start, MethodMemory& memory)
{
    MethodAnswer answer;
    const PolytopePair& shapes = *pair.polytopes();
    if (!shapes.offset.allFinite()) return answer;
    answer.overlap = start == MethodStart::plain
        ? touch_by_looking(shapes, answer.rounds)
        : touch_by_walking(shapes, start == MethodStart::cached, memory, answer.rounds,
                           answer.normal);
    return answer;
}

void containment_points(const PolytopePair& pair, ContainmentPoints& out)
{
    out.count = out.dropped = 0;
    int rounds = 0;
    const PolytopePair mirrored = pair.mirrored();
    Side side{{pair, pair.noise(), rounds}, false};
    Side other{{mirrored, pair.noise(), rounds}, true};
    if (!add_points(side, out)) return;
    const std::size_t own = out.count;
    if (!add_points(other, out)) {
        out.count = out.dropped = 0;
        return;
    }
    for (std::size_t i = own; i < out.count; ++i) {
        out.points[i].position = pair.turn * out.points[i].position + pair.shift;
    }
}

}  // namespace throng
