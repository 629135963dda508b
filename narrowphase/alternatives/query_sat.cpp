#include "narrowphase/alternatives/query_sat.hpp"

#include "kernels/geometry/hill_climbing.hpp"
#include "kernels/geometry/separating_axes.hpp"

#include <algorithm>
#include <limits>

namespace throng {
namespace {

// What the features remembered are: a face and the other's vertex under it, or two edges.
enum class Axis : std::uint32_t { none, face_a, face_b, edges };

struct BestAxis {
    double separation = -std::numeric_limits<double>::infinity();
    Vec3 normal = Vec3::UnitZ();
    Axis kind = Axis::none;
    std::uint16_t a = 0, b = 0;

    void offer(const BestAxis& other)
    {
        if (other.separation > separation) *this = other;
    }
};

BestAxis of_face_a(const PolytopePair& pair, const FaceAxis& axis)
{
    return {axis.separation, pair.a.normals[axis.face], Axis::face_a, axis.face, axis.vertex};
}

BestAxis of_face_b(const PolytopePair& pair, const FaceAxis& axis)
{
    return {axis.separation, -(pair.turn * pair.b.normals[axis.face]), Axis::face_b, axis.vertex,
            axis.face};
}

// How far apart the two are along a unit direction from a to b; climbs from these vertices and
// leaves there the ones found.
double room_along(const PolytopePair& pair,
                  const Vec3& normal,
                  std::uint16_t& vertex_a,
                  std::uint16_t& vertex_b)
{
    HillClimbingCount count;
    const Vec3 local = -(pair.turn.transpose() * normal);
    vertex_a = furthest_vertex(HillClimbingShape(pair.a), normal, vertex_a, count);
    vertex_b = furthest_vertex(HillClimbingShape(pair.b), local, vertex_b, count);
    return normal.dot(pair.turn * pair.b.vertices[vertex_b] + pair.shift
                      - pair.a.vertices[vertex_a]);
}

// The axis remembered, as it is now; of kind none where there is none.
BestAxis recall(const PolytopePair& pair, const MethodMemory& memory)
{
    BestAxis axis;
    const std::uint32_t a = memory.a[0], b = memory.b[0];
    HillClimbingCount count;
    switch (static_cast<Axis>(memory.kind)) {
    case Axis::face_a: {
        if (a >= pair.a.normals.size() || b >= pair.b.vertices.size()) return axis;
        axis.normal = pair.a.normals[a];
        const Vec3 local = -(pair.turn.transpose() * axis.normal);
        axis.a = static_cast<std::uint16_t>(a);
        axis.b =
            furthest_vertex(HillClimbingShape(pair.b), local, static_cast<std::uint16_t>(b), count);
        axis.separation =
            axis.normal.dot(pair.turn * pair.b.vertices[axis.b] + pair.shift) - pair.a.offsets[a];
        break;
    }
    case Axis::face_b: {
        if (a >= pair.a.vertices.size() || b >= pair.b.normals.size()) return axis;
        axis.normal = -(pair.turn * pair.b.normals[b]);
        axis.b = static_cast<std::uint16_t>(b);
        axis.a = furthest_vertex(HillClimbingShape(pair.a), axis.normal,
                                 static_cast<std::uint16_t>(a), count);
        axis.separation = axis.normal.dot(pair.shift - pair.a.vertices[axis.a]) - pair.b.offsets[b];
        break;
    }
    case Axis::edges: {
        if (a >= pair.a.edges.size() || b >= pair.b.edges.size()) return axis;
        const Hull::Edge& edge_a = pair.a.edges[a];
        const Hull::Edge& edge_b = pair.b.edges[b];
        const Vec3 along_a = pair.a.vertices[edge_a.to] - pair.a.vertices[edge_a.from];
        const Vec3 along_b = pair.b.vertices[edge_b.to] - pair.b.vertices[edge_b.from];
        const Vec3 across = along_a.cross(pair.turn * along_b);
        // Of the two ways the one it had.
        axis.normal =
            unit_or<double>(across.dot(memory.axis) < 0 ? Vec3(-across) : across, memory.axis);
        axis.a = static_cast<std::uint16_t>(a);
        axis.b = static_cast<std::uint16_t>(b);
        std::uint16_t vertex_a = edge_a.from, vertex_b = edge_b.from;
        axis.separation = room_along(pair, axis.normal, vertex_a, vertex_b);
        break;
    }
    default:
        return axis;
    }
    axis.kind = static_cast<Axis>(memory.kind);
    return axis;
}

// Goes through sets of axes until one parts the two or all have been seen.
BestAxis search(const PolytopePair& pair, const BestAxis& remembered, int& rounds)
{
    BestAxis best = remembered;
    const PolytopePair turned = pair.mirrored();
    FaceAxis guess_a{best.separation, best.a, best.b}, guess_b{best.separation, best.b, best.a};
    ++rounds;
    if (best.kind != Axis::face_a) {
        guess_a = likely_face_axis(pair);
        best.offer(of_face_a(pair, guess_a));
        if (best.separation > 0) return best;
    }
    if (best.kind != Axis::face_b) {
        guess_b = likely_face_axis(turned);
        best.offer(of_face_b(pair, guess_b));
        if (best.separation > 0) return best;
    }
    ++rounds;
    best.offer(of_face_a(pair, best_face_axis(pair, guess_a, best.separation)));
    if (best.separation > 0) return best;
    ++rounds;
    best.offer(of_face_b(pair, best_face_axis(turned, guess_b, best.separation)));
    if (best.separation > 0) return best;
    ++rounds;
    const EdgeAxis edges = best_edge_axis(pair, best.separation);
    if (!edges.normal.isZero(0))
        best.offer({edges.separation, edges.normal, Axis::edges, edges.edge_a, edges.edge_b});
    return best;
}

MethodAnswer answer_of(double separation, const Vec3& normal, int rounds)
{
    MethodAnswer answer;
    answer.separation = separation;
    answer.overlap = separation > 0 ? OverlapState::apart : OverlapState::touching;
    answer.normal = normal;
    answer.rounds = rounds;
    return answer;
}

}  // namespace

MethodAnswer query_sat(const ConvexPair& pair, double, MethodStart start, MethodMemory& memory)
{
    const PolytopePair& shapes = *pair.polytopes();
    if (start == MethodStart::plain) {
        Vec3 normal;
        const double separation =
            polytope_separation(shapes.a, shapes.b, {shapes.shift, Quat(shapes.turn)}, &normal);
        return answer_of(separation, normal, 1);
    }
    int rounds = 0;
    BestAxis best;
    if (start == MethodStart::cached && memory.kind != 0 && memory.has_direction()) {
        best = recall(shapes, memory);
        ++rounds;
    }
    if (!(best.separation > 0)) best = search(shapes, best, rounds);
    memory.kind = static_cast<std::uint32_t>(best.kind);
    memory.a[0] = best.a;
    memory.b[0] = best.b;
    memory.axis = best.normal;
    return answer_of(best.separation, best.normal, rounds);
}

}  // namespace throng
