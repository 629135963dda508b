#include "narrowphase/alternatives/chung_wang.hpp"

#include "kernels/geometry/hill_climbing.hpp"
#include "narrowphase/alternatives/direction_cone.hpp"

#include <cmath>

namespace throng {
namespace {

constexpr int kRounds = DirectionCone::kCapacity;
constexpr double kTolerance = 1e-14;  // of the size; some fifty times double's spacing

// What the memory's numbers are: a direction with the vertices furthest along it, or besides that
// the pairs of vertices that show that the two touch.
enum class Remembered : std::uint32_t { nothing, direction, witness };

// The differences of any two shapes, by looking at every point of theirs.
struct FurthestPoints {
    const ConvexCorePair& pair;

    Vec3 difference(const Vec3& s) const
    {
        return -minkowski_support(pair, s).point
            - s * (pair.a.convex_radius + pair.b.convex_radius);
    }
    void begin_at(const MethodMemory&) { }
    bool still_touch(const MethodMemory&) const { return false; }
    void note(int) { }
    void remember_direction(MethodMemory&) const { }
    void remember_witness(const DirectionCone::Witness&, MethodMemory&) const { }
};

// The differences of two polytopes, by climbing from the vertices of the round before.
struct FurthestVertices {
    FurthestVertices(const PolytopePair& polytopes, const ConvexCorePair& cores)
        : pair(polytopes), supports(cores)
    { }

    const PolytopePair& pair;
    HillClimbingSupports supports;
    std::uint32_t a = 0, b = 0;
    // By round, so that a witness can be told by its vertices.
    std::array<std::uint32_t, kRounds> seen_a, seen_b;

    Vec3 between(std::uint32_t vertex_a, std::uint32_t vertex_b) const
    {
        return pair.turn * pair.b.vertices[vertex_b] + pair.shift - pair.a.vertices[vertex_a];
    }
    Vec3 difference(const Vec3& s)
    {
        const MinkowskiVertex furthest = supports(s);
        a = furthest.feature_a;
        b = furthest.feature_b;
        return -furthest.point;
    }
    bool has(std::uint32_t vertex_a, std::uint32_t vertex_b) const
    {
        return vertex_a < pair.a.vertices.size() && vertex_b < pair.b.vertices.size();
    }
    void begin_at(const MethodMemory& memory) { supports.start_at(memory.a[0], memory.b[0]); }
    bool still_touch(const MethodMemory& memory) const
    {
        DirectionCone cone;
        for (std::uint32_t i = 0; i < memory.count && i < 4; ++i) {
            if (!has(memory.a[i], memory.b[i])) return false;
            const Vec3 r = between(memory.a[i], memory.b[i]);
            const double length = std::sqrt(r.squaredNorm());
            if (!(length > 0) || !cone.add(r / length)) return true;
        }
        return false;
    }
    void note(int round)
    {
        seen_a[static_cast<std::size_t>(round)] = a;
        seen_b[static_cast<std::size_t>(round)] = b;
    }
    void remember_direction(MethodMemory& memory) const
    {
        memory.a[0] = a;
        memory.b[0] = b;
    }
    void remember_witness(const DirectionCone::Witness& witness, MethodMemory& memory) const
    {
        memory.kind = static_cast<std::uint32_t>(Remembered::witness);
        memory.count = static_cast<std::uint32_t>(witness.count);
        for (std::size_t i = 0; i < memory.count; ++i) {
            const auto round = static_cast<std::size_t>(witness.differences[i]);
            memory.a[i] = seen_a[round];
            memory.b[i] = seen_b[round];
        }
    }
};

// Letters as in the header.
template <class Points>
void search(Points& points, Vec3 s, double slack, MethodMemory& memory, MethodAnswer& answer)
{
    DirectionCone cone;
    memory.kind = static_cast<std::uint32_t>(Remembered::direction);
    while (answer.rounds < kRounds) {
        const Vec3 r = points.difference(s);
        points.note(answer.rounds++);
        memory.axis = s;
        const double along = s.dot(r);
        if (along > slack) {
            answer.overlap = OverlapState::apart;
            answer.normal = s;
            points.remember_direction(memory);
            return;
        }
        const double length = std::sqrt(r.squaredNorm());
        if (length <= slack) {
            answer.overlap = OverlapState::touching;
            points.remember_direction(memory);
            return;
        }
        const Vec3 unit = r / length;
        if (!cone.add(unit)) {
            answer.overlap = OverlapState::touching;
            points.remember_witness(cone.witness(), memory);
            return;
        }
        const Vec3 mirrored = s - unit * (2 * unit.dot(s));
        s = cone.holds(mirrored) ? unit_or(mirrored, unit) : cone.middle();
    }
    answer.cut_short = true;
    memory.kind = static_cast<std::uint32_t>(Remembered::nothing);
}

template <class Points>
void ask(Points& points,
         const ConvexCorePair& cores,
         MethodStart start,
         MethodMemory& memory,
         MethodAnswer& answer)
{
    Vec3 s = memory.axis;
    const auto kind = static_cast<Remembered>(memory.kind);
    const bool known =
        start == MethodStart::cached && kind != Remembered::nothing && memory.has_direction();
    if (known) {
        if (kind == Remembered::witness && points.still_touch(memory)) {
            answer.rounds = 1;
            answer.overlap = OverlapState::touching;
            return;
        }
        points.begin_at(memory);
    } else {
        s = unit_or<double>(cores.b_turn * cores.b.middle + cores.b_position - cores.a.middle,
                            Vec3::UnitX());
    }
    const double slack = kTolerance * (cores.size + std::sqrt(cores.b_position.squaredNorm()));
    search(points, s, slack, memory, answer);
}

}  // namespace

MethodAnswer
query_chung_wang(const ConvexPair& pair, double, MethodStart start, MethodMemory& memory)
{
    MethodAnswer answer;
    const ConvexCorePair& cores = pair.cores();
    if (pair.polytopes() && start != MethodStart::plain) {
        FurthestVertices points(*pair.polytopes(), cores);
        ask(points, cores, start, memory, answer);
    } else {
        FurthestPoints points{cores};
        ask(points, cores, start, memory, answer);
    }
    return answer;
}

}  // namespace throng
