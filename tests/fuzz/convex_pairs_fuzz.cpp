// Convex pairs, fuzzed: whatever two convex shapes, however placed, and whatever is remembered of
// them, all methods give finite answers that agree with one another.
#include "narrowphase/alternatives/method_contacts.hpp"
#include "narrowphase/dispatch.hpp"
#include "tests/fuzz/convex_pair_promises.hpp"
#include "throng/convex_query.hpp"

#include <optional>

namespace {

using namespace throng;

// What build_hull() promises of vertices above faces.
constexpr double kAbove = 1e-14;
constexpr int kMoves = 6;

// A hull is refused with a reason, or closed: each edge between two faces, nothing above any face.
bool take_hull(const HullShape& shape, Shapes& shapes)
{
    HullResult made = build_hull(shape.points);
    if (!made.trouble.empty()) return false;
    const Hull& hull = made.hull;
    const auto vertices = std::ssize(hull.vertices), faces = std::ssize(hull.normals);
    expect(vertices - std::ssize(hull.edges) + faces == 2, "a hull is closed");
    expect(std::ssize(hull.face_vertices) == 2 * std::ssize(hull.edges), "edges lie between faces");
    Vec3 lower = hull.vertices[0], upper = lower;
    for (const Vec3& vertex : hull.vertices) {
        lower = lower.cwiseMin(vertex);
        upper = upper.cwiseMax(vertex);
    }
    const double extent = std::max(
        {(upper - lower).maxCoeff(), upper.cwiseAbs().maxCoeff(), lower.cwiseAbs().maxCoeff()});
    for (std::size_t face = 0; face < hull.normals.size(); ++face) {
        const Vec3& normal = hull.normals[face];
        expect(std::abs(normal.norm() - 1) < kParts, "normals of faces are of unit length");
        for (const Vec3& vertex : hull.vertices) {
            const double above = normal.dot(vertex) - hull.offsets[face];
            expect(above <= kAbove * extent, "no vertex is above a face", above, extent);
        }
    }
    shapes.hulls.push_back(std::move(made.hull));
    return true;
}

// The shape added to the world's, unless it is refused.
std::optional<ShapeRef> taken(const ShapeDescription& shape, Shapes& shapes)
{
    if (const auto* s = std::get_if<SphereShape>(&shape.shape)) {
        shapes.spheres.push_back({s->radius});
        return ShapeRef{ShapeKind::sphere, static_cast<std::uint32_t>(shapes.spheres.size() - 1)};
    }
    if (const auto* s = std::get_if<CapsuleShape>(&shape.shape)) {
        shapes.capsules.push_back({s->radius, s->half_length});
        return ShapeRef{ShapeKind::capsule, static_cast<std::uint32_t>(shapes.capsules.size() - 1)};
    }
    if (const auto* s = std::get_if<CylinderShape>(&shape.shape)) {
        shapes.cylinders.push_back({s->radius, s->half_length});
        return ShapeRef{ShapeKind::cylinder,
                        static_cast<std::uint32_t>(shapes.cylinders.size() - 1)};
    }
    if (const auto* s = std::get_if<BoxShape>(&shape.shape)) {
        shapes.boxes.push_back({s->half_extents});
        return ShapeRef{ShapeKind::box, static_cast<std::uint32_t>(shapes.boxes.size() - 1)};
    }
    if (!take_hull(std::get<HullShape>(shape.shape), shapes)) return {};
    return ShapeRef{ShapeKind::hull, static_cast<std::uint32_t>(shapes.hulls.size() - 1)};
}

void check_contacts(const ConvexMethod& method,
                    MethodStart start,
                    const Shapes& shapes,
                    const std::array<ShapeRef, 2>& refs,
                    const Placing& placing,
                    MethodMemory& memory)
{
    LocalManifold<double> out;
    const double speculative_margin = std::min(now.speculative_margin, placing.size());
    const bool told = collide_by(
        method, start, {shapes, refs[0], refs[1], now.pose, speculative_margin}, memory, out);
    expect(out.count >= 0 && out.count <= 4, "contacts are four at most", out.count);
    if (!told) return;
    expect(all_finite(out), "contacts are finite");
    if (out.count > 0)
        expect(std::abs(out.normal.norm() - 1) < kHair, "contact normals are of unit length",
               out.normal.norm());
    if (out.count > 0)
        expect(placing.by_axes() <= speculative_margin + kOfStraying * placing.size(),
               "contacts are within reach", placing.by_axes(), speculative_margin);
    if (out.count == 0)
        expect(placing.by_points() >= -kOfStraying * placing.size(), "what is deep has contacts",
               placing.by_points());
}

// What a step asks, with what it remembers of the last move.
template <class Real>
void check_step(const Shapes& shapes,
                const std::array<ShapeRef, 2>& refs,
                const Placing& placing,
                PairCache& cache)
{
    now.method = sizeof(Real) == sizeof(float) ? "auto in float" : "auto";
    const double speculative_margin = std::min(now.speculative_margin, placing.size());
    const double slack = kOfStraying * placing.size();
    LocalManifold<Real> out;
    collide<Real>({shapes,
                   refs[0],
                   refs[1],
                   {now.pose.position.cast<Real>(), now.pose.orientation.cast<Real>()},
                   static_cast<Real>(speculative_margin)},
                  cache, out);
    expect(out.count >= 0 && out.count <= 4 && all_finite(out), "a step's contacts are finite");
    if (out.count == 0) {
        expect(placing.by_points() >= -slack, "a step sees what is deep", placing.by_points());
        return;
    }
    const double length = static_cast<double>(out.normal.norm());
    expect(std::abs(length - 1) < 1e-5, "a step's normals are of unit length", length);
    expect(placing.by_axes() <= speculative_margin + slack, "a step touches within reach",
           placing.by_axes(), speculative_margin);
}

// The public door says what the method said, and refuses what makes no sense.
void check_query(ConvexQuery& query,
                 const ConvexMethod& method,
                 const ConvexPair& pair,
                 const Placing& placing)
{
    now.method = method.name;
    now.speculative_margin = kAnyReach;
    const ConvexAnswer cold = query.ask(method.name, now.pose, MethodStart::cold);
    if (!method.serves(pair)) {
        expect(cold.verdict == QueryVerdict::refused && !cold.trouble.empty(),
               "what a method does not serve is refused");
        return;
    }
    const ConvexAnswer kept = query.ask(method.name, now.pose, MethodStart::cached);
    for (const ConvexAnswer& answer : {cold, kept}) {
        expect(answer.verdict != QueryVerdict::refused, "what makes sense is answered");
        placing.check(method, kAnyReach,
                      {static_cast<OverlapState>(static_cast<int>(answer.verdict) - 1),
                       answer.separation, answer.normal, answer.on_a, answer.on_b, answer.volume,
                       answer.surface, answer.center, answer.rounds, answer.cut_short});
    }
    Pose wrong = now.pose;
    wrong.orientation.coeffs() *= 1.1;
    expect(query.ask(method.name, wrong).verdict == QueryVerdict::refused
               && query.ask("none", now.pose).verdict == QueryVerdict::refused,
           "nonsense is refused");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    FuzzBytes bytes({data, size});
    const std::array<double, 2> scales = scales_of(bytes);
    const ShapeDescription a = shape_of(bytes, scales[0]), b = shape_of(bytes, scales[1]);
    now = {};
    now.shapes[0] = &a;
    now.shapes[1] = &b;
    Shapes shapes;
    const auto ref_a = taken(a, shapes), ref_b = taken(b, shapes);
    std::optional<ConvexQuery> query;
    if (!is_large()) query.emplace(a, b);
    expect(!query || query->trouble().empty() == (ref_a && ref_b),
           "what the query refuses, a hull refuses");
    if (!ref_a || !ref_b) return 0;
    const std::array<ShapeRef, 2> refs{*ref_a, *ref_b};

    ConvexPair pair(shapes, refs[0], refs[1], Pose{});
    const std::span<const ConvexMethod> methods = convex_methods();
    std::vector<MethodMemory> memories(methods.size());
    PairCache cache, wide_cache;
    constexpr std::array kReach{kAnyReach, 0.0, 1e-3, 0.1};
    for (int move = 0; move == 0 || (move < kMoves && !bytes.empty()); ++move) {
        now.pose = move == 0 ? pose_of(bytes, pair) : moved(bytes, now.pose, pair);
        pair.place(now.pose);
        const Placing placing(pair, now.pose);
        const double part = kReach[bytes.below(4)];
        const double speculative_margin = part == kAnyReach ? part : part * placing.size();
        now.speculative_margin = speculative_margin;
        check_step<double>(shapes, refs, placing, cache);
        check_step<float>(shapes, refs, placing, wide_cache);
        if (!query) continue;
        // One method is met with what is foreign to it, the others with their own.
        const std::uint32_t chosen = bytes.byte(), foreign = bytes.below(4);
        for (std::size_t i = 0; i < methods.size(); ++i) {
            const ConvexMethod& method = methods[i];
            if (i == chosen % methods.size()) {
                check_query(*query, method, pair, placing);
                if (foreign == 1) memories[i] = garbage_of(bytes);
                if (foreign == 2) memories[i] = memories[bytes.byte() % methods.size()];
            }
            if (!method.serves(pair)) continue;
            now.method = method.name;
            now.speculative_margin = speculative_margin;
            now.memory = memories[i];
            now.start = 0;
            const MethodAnswer told =
                method.ask(pair, speculative_margin, MethodStart::cached, memories[i]);
            placing.check(method, speculative_margin, told);
            MethodMemory fresh;
            now.memory = fresh;
            now.start = 1;
            const MethodAnswer cold = method.ask(pair, kAnyReach, MethodStart::cold, fresh);
            placing.check(method, kAnyReach, cold);
            placing.compare(method, speculative_margin, told, cold);
            if (i != chosen % methods.size()) continue;
            MethodMemory plain_memory;
            now.start = 2;
            const MethodAnswer plain =
                method.ask(pair, kAnyReach, MethodStart::plain, plain_memory);
            placing.check(method, kAnyReach, plain);
            placing.compare(method, kAnyReach, cold, plain);
            now.start = static_cast<int>(bytes.below(3));
            MethodMemory contact_memory = memories[i];
            now.memory = contact_memory;
            check_contacts(method, static_cast<MethodStart>(now.start), shapes, refs, placing,
                           contact_memory);
        }
    }
    return 0;
}
