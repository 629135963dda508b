#include "narrowphase/methods/containment.hpp"

#include "kernels/geometry/closest_points.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace throng {
namespace {

// Steps from face to vertex to face; most walks end within three.
constexpr int kSteps = 8;

enum class Remembered : std::uint32_t { nothing, parted, vertex, edge, between };

// What is remembered of a body: its face, its vertex beneath the other's face, and its edge's ends.
enum Slot : std::size_t { kFace, kVertex, kFrom, kTo };

enum class Outcome : std::uint8_t { open, parted, inside };

// One body as planes, the other as vertices and edges. The one with the planes is the pair's a.
struct Side {
    const PolytopePair& pair;
    bool mirrored;
    double noise;
    int& rounds;
    std::uint32_t* of_planes;  // what is remembered of the one
    std::uint32_t* of_edges;   // ... and of the other
    FaceAxis best{};           // of the faces looked at, that with most of the other outside

    Vec3 place(std::size_t vertex) const
    {
        return pair.turn * pair.b.vertices[vertex] + pair.shift;
    }
    double height(std::size_t face, const Vec3& point) const
    {
        ++rounds;
        return pair.a.normals[face].dot(point) - pair.a.offsets[face];
    }
};

// The part of an edge that is left, from 0 at one end to 1 at the other, and the faces that cut it.
struct Part {
    double from = 0, to = 1;
    std::size_t enters = 0, leaves = 0;
};

// Cuts by the half-space of a face; false where nothing is left.
bool cut(const Side& side, std::size_t face, const Vec3& from, const Vec3& to, Part& part)
{
    const double here = side.height(face, from) - side.noise;
    const double there = side.height(face, to) - side.noise;
    --side.rounds;
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

// What is inside of an edge, if anything. The faces that ended the last edge are likely to end
// this.
bool meets(const Side& side, const Vec3& from, const Vec3& to, Part& part)
{
    const Part last = part;
    part = {0, 1, last.enters, last.leaves};
    if (!cut(side, last.enters, from, to, part)) return false;
    if (last.leaves != last.enters && !cut(side, last.leaves, from, to, part)) return false;
    for (std::size_t face = 0; face < side.pair.a.normals.size(); ++face) {
        if (face == last.enters || face == last.leaves) continue;
        if (!cut(side, face, from, to, part)) return false;
    }
    return true;
}

bool passes_by(const Side& side, const Vec3& from, const Vec3& to)
{
    ++side.rounds;
    const PolytopeView& ball = side.pair.a;
    const Vec3 nearest = closest_on_segment<double>(ball.center, {from, to}).point;
    const double limit = ball.outer_radius + side.noise;
    return (nearest - ball.center).squaredNorm() > limit * limit;
}

struct Nearest {
    std::uint16_t face = 0;
    double height = -std::numeric_limits<double>::max();
};

// The face that a point is furthest beyond, or least far beneath.
Nearest nearest_face(const Side& side, const Vec3& point)
{
    Nearest nearest;
    for (std::size_t face = 0; face < side.pair.a.normals.size(); ++face) {
        const double height = side.height(face, point);
        if (height > nearest.height) nearest = {static_cast<std::uint16_t>(face), height};
    }
    return nearest;
}

FaceAxis lowest_vertex(const Side& side, std::uint16_t face, std::uint16_t start)
{
    const Vec3 down = -(side.pair.turn.transpose() * side.pair.a.normals[face]);
    std::uint16_t vertex = climb_to_vertex(side.pair.b, down, start, &side.rounds);
    double height = side.height(face, side.place(vertex));
    // Only who has looked at every vertex may say that none is beneath by so little.
    if (height > side.noise && height < kClimbError * side.pair.b.outer_radius) {
        vertex = look_for_vertex(side.pair.b, down);
        side.rounds += static_cast<int>(side.pair.b.vertices.size());
        height = side.height(face, side.place(vertex));
    }
    return {height, face, vertex};
}

// From the face to the vertex lowest beneath it, from there to the face furthest beneath that.
Outcome walk(Side& side, std::uint16_t face, std::uint16_t start)
{
    std::array<std::uint16_t, kSteps> seen;
    std::uint16_t vertex = start;
    for (std::size_t step = 0; step < kSteps; ++step) {
        const auto end = seen.begin() + static_cast<std::ptrdiff_t>(step);
        if (std::find(seen.begin(), end, face) != end) break;
        seen[step] = face;
        const FaceAxis axis = lowest_vertex(side, face, vertex);
        if (step == 0 || axis.separation > side.best.separation) side.best = axis;
        if (axis.separation > side.noise) return Outcome::parted;
        vertex = axis.vertex;
        const Nearest nearest = nearest_face(side, side.place(vertex));
        if (nearest.height <= side.noise) {
            side.best = axis;
            return Outcome::inside;
        }
        face = nearest.face;
    }
    return Outcome::open;
}

enum class Below : std::uint8_t { unknown, yes, no };

struct Scratch {
    std::vector<Below> below;  // [vertices] all unknown between uses
    std::vector<std::uint16_t> looked, open;
};

// Shows the vertices that lie beneath the plane of side.best, and the edges with an end there: all
// others are outside. They hang together, and the lowest is among them; a little above the plane is
// beneath it too, so that they do so for faces whose corners stray. Ends once shown enough.
template <class OnVertex, class OnEdge>
bool any_below(const Side& side, OnVertex&& on_vertex, OnEdge&& on_edge)
{
    thread_local Scratch scratch;
    const PolytopeView& shape = side.pair.b;
    const double level = side.noise + kClimbError * shape.outer_radius;
    auto& [below, looked, open] = scratch;
    if (below.size() < shape.vertices.size()) below.resize(shape.vertices.size(), Below::unknown);
    const auto is_below = [&](std::uint16_t vertex) {
        if (below[vertex] == Below::unknown) {
            const bool yes = side.height(side.best.face, side.place(vertex)) <= level;
            below[vertex] = yes ? Below::yes : Below::no;
            looked.push_back(vertex);
            if (yes) open.push_back(vertex);
        }
        return below[vertex] == Below::yes;
    };
    bool enough = false;
    is_below(side.best.vertex);
    while (!enough && !open.empty()) {
        const std::uint16_t vertex = open.back();
        open.pop_back();
        enough = on_vertex(vertex);
        const std::uint32_t end = shape.neighbor_begin[vertex + 1u];
        for (std::uint32_t i = shape.neighbor_begin[vertex]; !enough && i < end; ++i) {
            const std::uint16_t next = shape.neighbors[i];
            // An edge with both ends beneath is seen from both: once is enough.
            if (is_below(next) && next < vertex) continue;
            enough = on_edge(vertex, next);
        }
    }
    for (const std::uint16_t vertex : looked) below[vertex] = Below::unknown;
    looked.clear();
    open.clear();
    return enough;
}

// Whether an edge goes through the other body; it is remembered.
bool any_edge_meets(const Side& side)
{
    Part part{0, 1, side.best.face, side.best.face};
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
bool meets_at_all(const Side& side)
{
    bool touching = false;
    for (std::size_t vertex = 0; vertex < side.pair.b.vertices.size(); ++vertex) {
        touching |= nearest_face(side, side.place(vertex)).height <= side.noise;
    }
    for (const Hull::Edge& edge : side.pair.b.edges) {
        const Vec3 from = side.place(edge.from), to = side.place(edge.to);
        Part part;
        bool left = true;
        for (std::size_t face = 0; face < side.pair.a.normals.size(); ++face) {
            left &= cut(side, face, from, to, part);
        }
        touching |= left;
    }
    return touching;
}

bool fits(const PolytopeView& shape, const std::uint32_t* slots)
{
    const std::size_t vertices = shape.vertices.size();
    return slots[kFace] < shape.normals.size() && slots[kVertex] < vertices
        && slots[kFrom] < vertices && slots[kTo] < vertices;
}

bool has_inside(const Side& side, const Vec3& point)
{
    ++side.rounds;
    const double within = side.pair.a.inner_radius;
    return (point - side.pair.a.center).squaredNorm() < within * within
        || nearest_face(side, point).height <= side.noise;
}

// Whether what was found the last time still is so.
Outcome recall(Side& side, Remembered kind)
{
    const auto face = static_cast<std::uint16_t>(side.of_planes[kFace]);
    const auto vertex = static_cast<std::uint16_t>(side.of_edges[kVertex]);
    if (kind == Remembered::parted || kind == Remembered::between) {
        side.best = lowest_vertex(side, face, vertex);
        return side.best.separation > side.noise ? Outcome::parted : Outcome::open;
    }
    side.best = {0, face, vertex};
    if (kind == Remembered::vertex)
        return has_inside(side, side.place(vertex)) ? Outcome::inside : Outcome::open;
    Part part{0, 1, face, face};
    const Vec3 from = side.place(side.of_edges[kFrom]), to = side.place(side.of_edges[kTo]);
    return meets(side, from, to, part) ? Outcome::inside : Outcome::open;
}

// Looks for a face that parts the two or for a vertex inside, from the face nearest the other's
// center onwards.
Outcome look_round(Side& side)
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

// What the balls round the two and inside them tell.
Touch touch_of_balls(const PolytopePair& pair, double noise)
{
    const double square = pair.offset.squaredNorm();
    const double outer = pair.a.outer_radius + pair.b.outer_radius + noise;
    if (square > outer * outer) return Touch::apart;
    const double inner = pair.a.inner_radius + pair.b.inner_radius - noise;
    return inner > 0 && square < inner * inner ? Touch::touching : Touch::undecided;
}

Touch touch_by_looking(const PolytopePair& pair, int& rounds)
{
    const PolytopePair mirrored = pair.mirrored();
    const Side side{pair, false, pair.noise(), rounds, nullptr, nullptr};
    const Side other{mirrored, true, pair.noise(), rounds, nullptr, nullptr};
    const bool either = meets_at_all(side), or_other = meets_at_all(other);
    return either || or_other ? Touch::touching : Touch::apart;
}

Touch touch_by_walking(const PolytopePair& pair, bool cached, MethodMemory& memory, int& rounds)
{
    const double noise = pair.noise();
    ++rounds;
    if (const Touch touch = touch_of_balls(pair, noise); touch != Touch::undecided) return touch;

    auto kind = static_cast<Remembered>(memory.kind / 2);
    if (!cached || !fits(pair.a, memory.a) || !fits(pair.b, memory.b)) kind = Remembered::nothing;
    // The side that answered the last time goes first.
    const bool turned = kind != Remembered::nothing && memory.kind % 2 == 1;
    std::optional<PolytopePair> mirrored;
    const auto side_of = [&](bool of_mirrored) -> Side {
        if (!of_mirrored) return {pair, false, noise, rounds, memory.a, memory.b};
        if (!mirrored) mirrored = pair.mirrored();
        return {*mirrored, true, noise, rounds, memory.b, memory.a};
    };
    const auto settled = [&](const Side& side, Outcome outcome, Remembered inside) {
        if (outcome == Outcome::open) return Touch::undecided;
        const bool parted = outcome == Outcome::parted;
        remember(side, parted ? Remembered::parted : inside, memory);
        return parted ? Touch::apart : Touch::touching;
    };

    Side first = side_of(turned);
    Outcome outcome = Outcome::open;
    if (kind != Remembered::nothing) outcome = recall(first, kind);
    if (outcome != Outcome::open) return settled(first, outcome, kind);
    if (kind == Remembered::parted)
        outcome = walk(first, first.best.face, first.best.vertex);
    else if (kind != Remembered::between)
        outcome = look_round(first);
    if (outcome != Outcome::open) return settled(first, outcome, Remembered::vertex);

    Side second = side_of(!turned);
    outcome = kind == Remembered::between ? recall(second, kind) : look_round(second);
    if (outcome != Outcome::open) return settled(second, outcome, Remembered::vertex);

    if (any_edge_meets(first)) return settled(first, Outcome::inside, Remembered::edge);
    if (any_edge_meets(second)) return settled(second, Outcome::inside, Remembered::edge);
    remember(second, Remembered::between, memory);
    remember(first, Remembered::between, memory);
    return Touch::apart;
}

void add(ContainmentPoints& out, const ContainmentPoints::Point& point)
{
    if (out.count == ContainmentPoints::kRoom)
        ++out.dropped;
    else
        out.points[out.count++] = point;
}

// The corners that vertices and edges of the one side make. False where a face parts the two.
bool add_points(Side& side, ContainmentPoints& out)
{
    using Kind = ContainmentPoints::Kind;
    if (look_round(side) == Outcome::parted) return false;
    Part part{0, 1, side.best.face, side.best.face};
    const auto add_vertex = [&](std::uint16_t vertex) {
        const Vec3 point = side.place(vertex);
        const Nearest nearest = nearest_face(side, point);
        if (nearest.height <= side.noise) {
            add(out,
                {point, Kind::vertex, !side.mirrored, vertex, vertex, nearest.face,
                 -nearest.height});
        }
        return false;
    };
    const auto add_crossings = [&](std::uint16_t from, std::uint16_t to) {
        const Vec3 start = side.place(from), along = side.place(to) - start;
        if (!meets(side, start, start + along, part)) return false;
        const auto [lower, upper] = std::minmax(from, to);
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
ask_containment(const ConvexPair& pair, double, MethodStart start, MethodMemory& memory)
{
    MethodAnswer answer;
    const PolytopePair& shapes = *pair.polytopes();
    answer.touch = start == MethodStart::plain
        ? touch_by_looking(shapes, answer.rounds)
        : touch_by_walking(shapes, start == MethodStart::cached, memory, answer.rounds);
    return answer;
}

void containment_points(const PolytopePair& pair, ContainmentPoints& out)
{
    out.count = out.dropped = 0;
    int rounds = 0;
    const PolytopePair mirrored = pair.mirrored();
    Side side{pair, false, pair.noise(), rounds, nullptr, nullptr};
    Side other{mirrored, true, pair.noise(), rounds, nullptr, nullptr};
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
