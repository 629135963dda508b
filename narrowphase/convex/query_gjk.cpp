#include "narrowphase/convex/query_gjk.hpp"

#include "kernels/geometry/epa.hpp"

#include <algorithm>

namespace throng {
namespace {

// Nearer than this, of the size, the direction from one nearest point to the other has lost so many
// digits that it is told from the features they lie on.
constexpr double kNear = 1e-4;
// By how much, of the size, a direction may fall short of the distance and still prove it.
constexpr double kProof = 1e-12;

// What a core shows at a feature named by support(); the nearest there is where the name is wrong.
Vec3 point_of(const ConvexCore<double>& core, std::uint32_t feature)
{
    switch (core.kind) {
    case ShapeKind::capsule:
        return {0, 0, feature != 0 ? core.extents.z() : -core.extents.z()};
    case ShapeKind::box:
        return {feature & 1 ? core.extents.x() : -core.extents.x(),
                feature & 2 ? core.extents.y() : -core.extents.y(),
                feature & 4 ? core.extents.z() : -core.extents.z()};
    case ShapeKind::hull: {
        const std::vector<Vec3>& vertices = core.hull->vertices;
        return vertices[std::min<std::size_t>(feature, vertices.size() - 1)];
    }
    default:
        return Vec3::Zero();
    }
}

// Whether the points of a core can be told from their features.
bool has_names(const ConvexCore<double>& core) { return core.kind != ShapeKind::cylinder; }

void remember(const Simplex& simplex, MethodMemory& memory)
{
    memory.kind = 1;
    memory.count = static_cast<std::uint32_t>(simplex.count);
    for (std::size_t i = 0; i < memory.count; ++i) {
        memory.a[i] = simplex.corners[i].feature_a;
        memory.b[i] = simplex.corners[i].feature_b;
    }
}

// The differences remembered, where they are now.
Simplex recall(const ConvexCorePair& cores, const MethodMemory& memory)
{
    Simplex simplex;
    if (!has_names(cores.a) || !has_names(cores.b)) return simplex;
    simplex.count = static_cast<int>(std::min(memory.count, 4u));
    for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i) {
        MinkowskiVertex& corner = simplex.corners[i];
        corner.feature_a = memory.a[i];
        corner.feature_b = memory.b[i];
        corner.on_a = point_of(cores.a, memory.a[i]);
        corner.on_b = cores.b_turn * point_of(cores.b, memory.b[i]) + cores.b_position;
        corner.point = corner.on_a - corner.on_b;
    }
    return simplex;
}

// The direction at right angles to the edge or face that the nearest difference lies on.
Vec3 square_to(const Simplex& simplex, const Vec3& normal)
{
    const Vec3& a = simplex.corners[0].point;
    if (simplex.count < 2) return normal;
    const Vec3 along = simplex.corners[1].point - a;
    if (simplex.count == 2) {
        return unit_or<double>(normal - along * (along.dot(normal) / along.squaredNorm()), normal);
    }
    const Vec3 across = along.cross(simplex.corners[2].point - a);
    return unit_or<double>(across.dot(normal) < 0 ? Vec3(-across) : across, normal);
}

// The points of the two that the walk ended on. False where it left none.
bool weigh(const Simplex& simplex, Vec3& on_a, Vec3& on_b)
{
    double sum = 0;
    on_a.setZero();
    on_b.setZero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i) {
        sum += simplex.weights[i];
        on_a += simplex.corners[i].on_a * simplex.weights[i];
        on_b += simplex.corners[i].on_b * simplex.weights[i];
    }
    return std::abs(sum - 1) < 1e-9;
}

// Of two answers about cores the one that shows more room: no direction shows too much.
struct CoreAnswer {
    double separation;
    Vec3 normal, on_a, on_b;
};

class Question {
public:
    Question(const ConvexCorePair& cores, bool climbs) : cores_(cores), supports_(cores, climbs) { }

    /// False where the direction remembered shows no more than the limit.
    bool still_beyond(double limit, MethodMemory& memory, CoreAnswer& answer)
    {
        supports_.start_at(memory.a[0], memory.b[0]);
        const MinkowskiVertex further = furthest(memory.axis);
        const double separation = -memory.axis.dot(further.point);
        if (!(separation > limit)) return false;
        memory.count = 1;
        memory.a[0] = further.feature_a;
        memory.b[0] = further.feature_b;
        answer = {separation, memory.axis, further.on_a, further.on_b};
        return true;
    }

    CoreAnswer measure(double limit, const Simplex& beginning, MethodMemory& memory)
    {
        const Distance found = gjk(cores_, limit, supports_, beginning);
        rounds += found.iterations;
        cut_short = found.iterations > kMostRounds;
        CoreAnswer answer{found.distance, found.normal, found.on_a, found.on_b};
        remember(found.simplex, memory);
        const bool settled = found.apart && (found.beyond || prove(found, answer));
        if (!settled) dig(found, answer, memory);
        if (!has_names(cores_.a) || !has_names(cores_.b)) face(answer);
        memory.axis = answer.normal;
        return answer;
    }

    const HillClimbingCount& climbed() const { return supports_.count(); }

    int rounds = 0;
    bool cut_short = false;

private:
    MinkowskiVertex furthest(const Vec3& direction)
    {
        ++rounds;
        return supports_(direction);
    }

    // Squares the normal to what lies further back than it shows.
    void straighten(double enough, CoreAnswer& answer)
    {
        const Vec3 nearest = answer.normal * -answer.separation;
        MinkowskiVertex further = furthest(answer.normal);
        for (int round = 0; round < 4; ++round) {
            const double shown = -answer.normal.dot(further.point);
            if (shown >= answer.separation - enough) return;
            const Vec3 along = further.point - nearest;
            const Vec3 straight = unit_or<double>(
                answer.normal - along * (along.dot(answer.normal) / along.squaredNorm()),
                answer.normal);
            further = furthest(straight);
            if (!(-straight.dot(further.point) > shown)) return;
            answer.normal = straight;
        }
    }

    // Whether the normal, squared where they are near, parts the two by what was measured.
    bool prove(const Distance& found, CoreAnswer& answer)
    {
        const double size = cores_.size + cores_.b_position.norm();
        if (found.distance > kNear * size) {
            if (found.stalled) straighten(kProof * size, answer);
            return true;
        }
        answer.normal = square_to(found.simplex, found.normal);
        answer.separation = -answer.normal.dot(found.simplex.corners[0].point);
        const double shown = -answer.normal.dot(furthest(answer.normal).point);
        if (shown >= answer.separation - kProof * size) return true;
        answer.separation = shown;
        return false;
    }

    void dig(const Distance& walked, CoreAnswer& answer, MethodMemory& memory)
    {
        const PenetrationDepth found =
            epa(cores_, supports_, walked.apart ? Simplex{} : walked.simplex);
        rounds += found.iterations;
        cut_short = cut_short || found.cut_short;
        if (walked.apart && answer.separation >= -found.depth) return;
        answer = {-found.depth, found.normal, found.on_a, found.on_b};
        // Where the two are a hair apart or deep, 0 may lie beside the face that is nearest, over
        // another in the same plane: the walk's own points then fit the depth better.
        const auto misfit = [&](const Vec3& on_a, const Vec3& on_b) {
            return (on_b - on_a + found.normal * found.depth).squaredNorm();
        };
        Vec3 on_a, on_b;
        if (weigh(walked.simplex, on_a, on_b)
            && misfit(on_a, on_b) < misfit(found.on_a, found.on_b)) {
            answer.on_a = on_a;
            answer.on_b = on_b;
        }
        if (!found.has_face) return;
        // With its far side the face is likely to enclose 0 again.
        Simplex likely;
        likely.count = 4;
        std::copy(found.face.begin(), found.face.end(), likely.corners.begin());
        likely.corners[3] = furthest(-found.normal);
        remember(likely, memory);
    }

    // Round cores have no corners that the normal was told from: their points go sideways until
    // they lie along it.
    static void face(CoreAnswer& answer)
    {
        const Vec3 off = answer.on_b - answer.on_a;
        const Vec3 sideways = off - answer.normal * answer.normal.dot(off);
        answer.on_a += sideways / 2;
        answer.on_b -= sideways / 2;
    }

    const ConvexCorePair& cores_;
    HillClimbingSupports supports_;
};

}  // namespace

MethodAnswer query_gjk(const ConvexPair& pair,
                       double speculative_margin,
                       MethodStart start,
                       MethodMemory& memory)
{
    HillClimbingCount count;
    return query_gjk(pair, speculative_margin, start, memory, count);
}

MethodAnswer query_gjk(const ConvexPair& pair,
                       double speculative_margin,
                       MethodStart start,
                       MethodMemory& memory,
                       HillClimbingCount& count)
{
    const ConvexCorePair& cores = pair.cores();
    const double convex_radius = cores.a.convex_radius + cores.b.convex_radius;
    const double limit = speculative_margin + convex_radius;
    const bool knows = start == MethodStart::cached && memory.kind == 1 && memory.has_direction();
    Question question(cores, start != MethodStart::plain);
    CoreAnswer found;
    if (!knows || !question.still_beyond(limit, memory, found))
        found = question.measure(limit, knows ? recall(cores, memory) : Simplex{}, memory);

    MethodAnswer answer;
    answer.separation = found.separation - convex_radius;
    answer.overlap = answer.separation > 0 ? OverlapState::apart : OverlapState::touching;
    answer.normal = found.normal;
    answer.on_a = found.on_a + found.normal * cores.a.convex_radius;
    answer.on_b = found.on_b - found.normal * cores.b.convex_radius;
    answer.rounds = question.rounds;
    answer.cut_short = question.cut_short;
    count += question.climbed();
    return answer;
}

}  // namespace throng
