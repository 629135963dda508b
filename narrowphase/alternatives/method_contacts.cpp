#include "narrowphase/alternatives/method_contacts.hpp"

#include "kernels/geometry/closest_points.hpp"
#include "kernels/geometry/separating_axes.hpp"
#include "narrowphase/convex/pair_functions.hpp"
#include "narrowphase/convex/support_contacts.hpp"

namespace throng {

namespace {

// The separating axes and the clipping that `auto` uses for small hulls, with a box seen as one.
bool collide_by_axes(const PairInput<double>& in,
                     MethodStart start,
                     MethodMemory& memory,
                     LocalManifold<double>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    PairCache cache;
    if (start == MethodStart::cached) cache = {memory.a[0], memory.b[0], memory.kind};
    hull_hull_by_axes({shapes, a, b, b_in_a, speculative_margin}, cache, out);
    memory.a[0] = cache.feature_a;
    memory.b[0] = cache.feature_b;
    memory.kind = cache.kind;
    return true;
}

// The edge of a face that lies furthest along a direction, or its only corner twice.
Segment<double> furthest_edge(const SupportFace<double>& face, const Vec3& direction)
{
    const auto corner = [&](int i) { return face.corners[static_cast<std::size_t>(i)]; };
    Segment<double> best{corner(0), corner(face.count > 1 ? 1 : 0)};
    double furthest = direction.dot(best.from + best.to);
    for (int i = 1; i < face.count; ++i) {
        const Segment<double> edge{corner(i), corner((i + 1) % face.count)};
        const double extent = direction.dot(edge.from + edge.to);
        if (extent > furthest) {
            furthest = extent;
            best = edge;
        }
    }
    return best;
}

// Points of the two that face one another along a normal, for a method that names none.
void find_witnesses(const ConvexCorePair& pair, ContactAxis& axis)
{
    const Vec3 back = pair.b_turn.transpose() * -axis.normal;
    Segment<double> on_a = furthest_edge(support_face(pair.a, axis.normal), axis.normal);
    Segment<double> on_b = furthest_edge(support_face(pair.b, back), back);
    for (Vec3* end : {&on_b.from, &on_b.to}) *end = pair.b_turn * *end + pair.b_position;
    const auto nearest = closest_points(on_a, on_b);
    axis.on_a = nearest.on_a;
    axis.on_b = nearest.on_b;
}

// Slivers at the rim of the shared volume turn its normal a little off the faces that meet: theirs
// takes its place where less must be moved along it.
void settle_on_face(const ConvexCorePair& pair, Vec3& normal)
{
    constexpr double kNear = 0.9;  // cosine
    double best = separation_along(pair, normal);
    const Vec3 from_b = pair.b_turn.transpose() * -normal;
    const Vec3 of_a = support_face(pair.a, normal).normal;
    const Vec3 of_b = -(pair.b_turn * support_face(pair.b, from_b).normal);
    const Vec3 asked = normal;
    for (const Vec3& face : {of_a, of_b}) {
        if (face.dot(asked) < kNear) continue;
        const double separation = separation_along(pair, face);
        if (separation > best) {
            best = separation;
            normal = face;
        }
    }
}

}  // namespace

bool collide_by(const ConvexMethod& method,
                MethodStart start,
                const PairInput<double>& in,
                MethodMemory& memory,
                LocalManifold<double>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    out.count = 0;
    const bool depth = (method.tells & tells_depth) != 0;
    const bool distance = (method.tells & tells_distance) != 0;
    const bool volume = (method.tells & tells_volume) != 0;
    const ConvexPair pair(shapes, a, b, b_in_a);
    if (!method.serves(pair)) return false;
    if (depth && !distance && start != MethodStart::plain)
        return collide_by_axes({shapes, a, b, b_in_a, speculative_margin}, start, memory, out);

    const MethodAnswer answer = method.ask(pair, speculative_margin, start, memory);
    if (answer.overlap == OverlapState::undecided) return false;
    const bool apart = answer.overlap == OverlapState::apart;
    const ConvexCorePair& cores = pair.cores();
    const double convex_radius = cores.a.convex_radius + cores.b.convex_radius;
    // Whatever direction is told: further apart along it is further apart.
    if (!depth && !volume)
        return apart && separation_along(cores, answer.normal) - convex_radius > speculative_margin;
    if (apart && !depth) return true;
    ContactAxis axis;
    axis.normal = answer.normal;
    if (depth) {
        axis.separation = answer.separation + convex_radius;
    } else {
        settle_on_face(cores, axis.normal);
        axis.separation = separation_along(cores, axis.normal);
    }
    if (axis.separation - convex_radius > speculative_margin) return true;
    if (distance) {
        axis.on_a = answer.on_a - answer.normal * cores.a.convex_radius;
        axis.on_b = answer.on_b + answer.normal * cores.b.convex_radius;
    } else {
        find_witnesses(cores, axis);
    }
    fill_points(cores, axis, speculative_margin, out);
    return true;
}

}  // namespace throng
