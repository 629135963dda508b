// Convex pairs, fuzzed: whatever two convex shapes, however placed, and whatever is remembered of
// them, all methods give finite answers that agree with one another.
#include "narrowphase/methods/method_contacts.hpp"
#include "narrowphase/methods/separating_axes.hpp"
#include "narrowphase/narrowphase.hpp"
#include "pipeline/convex_query.hpp"
#include "tests/fuzz/convex_pair_input.hpp"
#include "tests/narrowphase/methods/polytope_pairs.hpp"

#include <cstdio>
#include <cstdlib>
#include <optional>

namespace {

using namespace throng;

// Of the size, like all below: nearer than this to touching either answer is right, and lengths are
// known as well.
constexpr double kHair = 1e-9;
// Corners that stray from their faces by no more are rounding.
constexpr double kFlat = 1e-13;
// What goes by faces is as good as this where corners stray from them: ten times what build_hull()
// allows, for that counts more where faces meet at a sharp angle.
constexpr double kOfStraying = 1e-4;
constexpr double kOfCylinders = 1e-6;
constexpr double kParts = 1e-12;
// What build_hull() promises of vertices above faces.
constexpr double kAbove = 1e-14;
constexpr double kAnyReach = 1e30;
constexpr int kMoves = 6;

// What is being asked, told where a check fails.
struct Now {
    const ShapeDescription* shapes[2] = {};
    Pose pose;
    std::string_view method = "none";
    int start = 0;
    double reach = 0;
    MethodMemory memory;
};
Now now;

void tell(const Vec3& v) { std::fprintf(stderr, "{%.17g, %.17g, %.17g}", v.x(), v.y(), v.z()); }

void tell_shape(const ShapeDescription& shape)
{
    if (const auto* hull = std::get_if<HullShape>(&shape.shape)) {
        std::fprintf(stderr, "hull");
        for (const Vec3& point : hull->points) {
            std::fprintf(stderr, " ");
            tell(point);
        }
    }
    if (const auto* box = std::get_if<BoxShape>(&shape.shape)) {
        std::fprintf(stderr, "box ");
        tell(box->half_extents);
    }
    const auto tell_round = [](const char* kind, double radius, double half_length) {
        std::fprintf(stderr, "%s %.17g %.17g", kind, radius, half_length);
    };
    if (const auto* s = std::get_if<SphereShape>(&shape.shape)) tell_round("sphere", s->radius, 0);
    if (const auto* s = std::get_if<CapsuleShape>(&shape.shape))
        tell_round("capsule", s->radius, s->half_length);
    if (const auto* s = std::get_if<CylinderShape>(&shape.shape))
        tell_round("cylinder", s->radius, s->half_length);
    std::fprintf(stderr, "\n");
}

[[noreturn]] void fail(const char* promise, double got, double wanted)
{
    std::fprintf(stderr, "broken: %s (%.17g, %.17g)\n", promise, got, wanted);
    for (const ShapeDescription* shape : now.shapes) tell_shape(*shape);
    std::fprintf(stderr, "at ");
    tell(now.pose.position);
    const Quat& q = now.pose.orientation;
    std::fprintf(stderr, " turned (%.17g, %.17g, %.17g, %.17g)\n", q.w(), q.x(), q.y(), q.z());
    std::fprintf(stderr, "%s, start %d, reach %.17g; remembered kind %u, count %u, axis ",
                 std::string(now.method).c_str(), now.start, now.reach, now.memory.kind,
                 now.memory.count);
    tell(now.memory.axis);
    for (int i = 0; i < 4; ++i) std::fprintf(stderr, " %u/%u", now.memory.a[i], now.memory.b[i]);
    std::fprintf(stderr, "\n");
    std::abort();
}

void expect(bool good, const char* promise, double got = 0, double wanted = 0)
{
    if (!good) fail(promise, got, wanted);
}

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

int most_rounds(const ConvexMethod& method, const ConvexPair& pair)
{
    if (method.name == "sphere") return 1;
    if (method.name == "sat") return 8;
    if (method.name == "chung_wang") return 96;
    // Of GJK and EPA as ask_gjk.hpp says, and a few supports that prove.
    if (method.name == "gjk") return 129 + 512 + 8;
    if (method.name.starts_with("k_dop")) return 32;
    const PolytopeView &a = pair.polytopes()->a, &b = pair.polytopes()->b;
    const auto looks = [](const PolytopeView& planes, const PolytopeView& other) {
        return planes.normals.size() * (other.vertices.size() + other.edges.size() + 64);
    };
    if (method.name == "clip_volume")
        return static_cast<int>(2 * (a.vertices.size() + b.vertices.size()));
    return static_cast<int>(4 * (looks(a, b) + looks(b, a)));
}

// So many vertices that a step asks GJK which corners meet, and other methods take too long.
bool is_large()
{
    return std::any_of(std::begin(now.shapes), std::end(now.shapes), [](const auto* shape) {
        const auto* const hull = std::get_if<HullShape>(&shape->shape);
        return hull && hull->points.size() >= 192;
    });
}

/// All that is asked of two shapes at one pose.
class Placing {
public:
    Placing(const ConvexPair& pair, const Pose& pose) : pair_(pair), pose_(pose)
    {
        size_ = pair.size() + pose.position.norm();
        const CorePair& cores = pair.cores();
        cylinders_ = cores.a.kind == ShapeKind::cylinder || cores.b.kind == ShapeKind::cylinder;
        MethodMemory memory;
        now.method = "gjk";
        now.start = 2;
        now.reach = kAnyReach;
        now.memory = memory;
        best_ = find_convex_method("gjk")->ask(pair, kAnyReach, MethodStart::plain, memory);
        by_points_ = best_.separation;
        by_faces_ = by_points_;
        const PolytopePair* const both = pair.polytopes();
        if (both && !is_large()) {
            by_faces_ = polytope_separation(both->a, both->b, pose, nullptr);
            const double stray = std::max(stray_of(both->a), stray_of(both->b));
            strays_ = stray > kFlat * pair.size();
        }
    }

    double size() const { return size_; }
    double by_points() const { return by_points_; }
    /// As near as any axis leaves them, which is nearer than their points where corners face
    /// corners.
    double by_axes() const { return std::min(by_points_, by_faces_); }

    /// What holds of any answer, whatever the pair remembered.
    void check(const ConvexMethod& method, double reach, const MethodAnswer& told) const
    {
        check_numbers(method, told);
        check_touch(method, told);
        if (told.touch == Touch::apart) check_apart(method, reach, told);
        if (told.touch == Touch::touching && (method.tells & tells_depth)) check_depth(told);
    }

    /// What a start from memory and a cold one have in common.
    void compare(const ConvexMethod& method,
                 double reach,
                 const MethodAnswer& told,
                 const MethodAnswer& cold) const
    {
        if (std::abs(by_points_) > slack_of(method) && told.touch != Touch::undecided
            && cold.touch != Touch::undecided)
            expect(told.touch == cold.touch, "memory does not change who touches");
        if (told.touch != cold.touch || told.cut_short || cold.cut_short) return;
        const bool apart = told.touch == Touch::apart;
        const bool measured = (method.tells & (apart ? tells_distance : tells_depth)) != 0;
        if (measured && cold.separation <= reach) {
            const double error = std::abs(told.separation - cold.separation);
            expect(error <= std::max(slack_of(method), length_slack()),
                   "memory does not change lengths", told.separation, cold.separation);
        }
        if (!apart && (method.tells & tells_volume)) {
            expect(std::abs(told.volume - cold.volume) <= kHair * size_ * size_ * size_,
                   "memory does not change volumes", told.volume, cold.volume);
        }
    }

private:
    // Of what goes by faces and of what goes by points.
    double face_slack() const { return (strays_ ? kOfStraying : kHair) * size_; }
    double length_slack() const { return (cylinders_ ? kOfCylinders : kHair) * size_; }
    bool goes_by_faces(const ConvexMethod& method) const
    {
        return method.name == "sat" || method.name == "containment";
    }
    double slack_of(const ConvexMethod& method) const
    {
        return goes_by_faces(method) ? face_slack() : length_slack();
    }

    void check_numbers(const ConvexMethod& method, const MethodAnswer& told) const
    {
        expect(std::isfinite(told.separation) && std::isfinite(told.volume)
                   && std::isfinite(told.surface),
               "lengths and volumes are finite");
        expect(told.normal.allFinite() && told.on_a.allFinite() && told.on_b.allFinite()
                   && told.center.allFinite(),
               "directions and places are finite");
        expect(std::abs(told.normal.norm() - 1) < kParts, "normals are of unit length",
               told.normal.norm());
        const int most = most_rounds(method, pair_);
        expect(told.rounds >= 0 && told.rounds <= most, "rounds have a bound", told.rounds, most);
        expect(told.volume >= 0 && told.surface >= 0, "volumes are not below 0", told.volume);
    }

    void check_touch(const ConvexMethod& method, const MethodAnswer& told) const
    {
        const Touch touch = told.touch;
        // What they all have in common is seen by faces and by points.
        const double slack = slack_of(method);
        if (by_faces_ > face_slack() && by_points_ > slack)
            expect(touch != Touch::touching, "what is apart does not touch", by_faces_, by_points_);
        if (by_faces_ < -face_slack() && by_points_ < -slack)
            expect(touch != Touch::apart, "what touches is not apart", by_faces_, by_points_);
        if (pair_.polytopes() && (by_faces_ > face_slack() || by_faces_ < -face_slack()))
            expect((by_faces_ > 0) == (by_points_ > 0), "gjk agrees with the axes", by_points_,
                   by_faces_);
        if (goes_by_faces(method)) return;
        if (by_points_ > slack)
            expect(touch != Touch::touching, "what gjk parts does not touch", by_points_);
        if (by_points_ < -slack)
            expect(touch != Touch::apart, "what gjk sees touch is not apart", by_points_);
    }

    void check_apart(const ConvexMethod& method, double reach, const MethodAnswer& told) const
    {
        // Those have a normal of faces alone, or none.
        if (method.name == "clip_volume" || method.name == "containment") return;
        const double room = room_along(pair_.cores(), told.normal);
        expect(room > -kParts * size_, "the normal of what is apart parts it", room, size_);
        if ((method.tells & tells_distance) == 0) return;
        expect(room >= told.separation - length_slack(), "the normal shows the distance", room,
               told.separation);
        if (told.separation > reach) return;
        const double between = (told.on_b - told.on_a).norm();
        expect(std::abs(between - told.separation) <= kHair * size_,
               "the nearest points are that far apart", between, told.separation);
    }

    void check_depth(const MethodAnswer& told) const
    {
        const double room = room_along(pair_.cores(), told.normal);
        expect(room >= told.separation - kHair * size_, "the depth is enough to part them", room,
               told.separation);
        if (told.cut_short || best_.cut_short || by_points_ > 0) return;
        const double wrong = std::abs(told.separation - by_points_);
        expect(wrong <= std::max(face_slack(), length_slack()), "depths agree", told.separation,
               by_points_);
    }

    const ConvexPair& pair_;
    const Pose pose_;
    MethodAnswer best_;
    double size_ = 0, by_points_ = 0, by_faces_ = 0;
    bool strays_ = false, cylinders_ = false;
};

void check_contacts(const ConvexMethod& method,
                    MethodStart start,
                    const Shapes& shapes,
                    const std::array<ShapeRef, 2>& refs,
                    const Placing& placing,
                    MethodMemory& memory)
{
    LocalManifold<double> out;
    const double reach = std::min(now.reach, placing.size());
    const bool told =
        collide_by(method, start, shapes, refs[0], refs[1], now.pose, reach, memory, out);
    expect(out.count >= 0 && out.count <= 4, "contacts are four at most", out.count);
    if (!told) return;
    expect(all_finite(out), "contacts are finite");
    if (out.count > 0)
        expect(std::abs(out.normal.norm() - 1) < kHair, "contact normals are of unit length",
               out.normal.norm());
    if (out.count > 0)
        expect(placing.by_axes() <= reach + kOfStraying * placing.size(),
               "contacts are within reach", placing.by_axes(), reach);
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
    const double reach = std::min(now.reach, placing.size());
    const double slack = kOfStraying * placing.size();
    LocalManifold<Real> out;
    collide<Real>(shapes, refs[0], refs[1],
                  {now.pose.position.cast<Real>(), now.pose.orientation.cast<Real>()},
                  static_cast<Real>(reach), cache, out);
    expect(out.count >= 0 && out.count <= 4 && all_finite(out), "a step's contacts are finite");
    if (out.count == 0) {
        expect(placing.by_points() >= -slack, "a step sees what is deep", placing.by_points());
        return;
    }
    const double length = static_cast<double>(out.normal.norm());
    expect(std::abs(length - 1) < 1e-5, "a step's normals are of unit length", length);
    expect(placing.by_axes() <= reach + slack, "a step touches within reach", placing.by_axes(),
           reach);
}

// The public door says what the method said, and refuses what makes no sense.
void check_query(ConvexQuery& query,
                 const ConvexMethod& method,
                 const ConvexPair& pair,
                 const Placing& placing)
{
    now.method = method.name;
    now.reach = kAnyReach;
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
                      {static_cast<Touch>(static_cast<int>(answer.verdict) - 1), answer.separation,
                       answer.normal, answer.on_a, answer.on_b, answer.volume, answer.surface,
                       answer.center, answer.rounds, answer.cut_short});
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
        const double reach = part == kAnyReach ? part : part * placing.size();
        now.reach = reach;
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
            now.reach = reach;
            now.memory = memories[i];
            now.start = 0;
            const MethodAnswer told = method.ask(pair, reach, MethodStart::cached, memories[i]);
            placing.check(method, reach, told);
            MethodMemory fresh;
            now.memory = fresh;
            now.start = 1;
            const MethodAnswer cold = method.ask(pair, kAnyReach, MethodStart::cold, fresh);
            placing.check(method, kAnyReach, cold);
            placing.compare(method, reach, told, cold);
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
