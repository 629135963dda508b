// Hull against hull, and box against hull: separating axes, then clipping, as for two boxes.
//
// The wide kernels answer for float. What is too big, too thin or too unlike for them goes by the
// plain arithmetic of double, and so do pairs in double. Where the vertices are many, GJK and EPA
// tell which corners meet, and the axes of these are looked at alone.
#include "kernels/geometry/polytope_contacts.hpp"
#include "narrowphase/convex/pair_functions.hpp"
#include "narrowphase/convex/query_gjk.hpp"
#include "narrowphase/convex/wide/hull_kernels.hpp"
#include "narrowphase/convex/wide_shapes.hpp"
#include "narrowphase/manifold/contact_points.hpp"
#include "narrowphase/manifold/edge_on_edge.hpp"
#include "narrowphase/manifold/edge_over_face.hpp"
#include "narrowphase/manifold/polytope_foot.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// What the cache's features are: nothing, or a face of one and the vertex of the other under it.
enum class Remembered : std::uint32_t { nothing, face_a, face_b };

// A face leads unless another axis is better by this part of the balls inside both, so that the
// normal of a body at rest does not jump between axes that are as good as one another.
constexpr double kFaceBias = 1e-3;

// Cosine below which an edge's normal is no stand-in for a face's: a fiftieth of a radian.
constexpr double kAlike = 0.9998;

void face_manifold(const PolytopePair& pair,
                   const FaceAxis& axis,
                   double speculative_margin,
                   double slack,
                   LocalManifold<double>& out,
                   double& least)
{
    PolytopePoints found;
    clip_faces(pair, axis, speculative_margin, slack, found);
    least = found.count > 0 ? found.least : std::numeric_limits<double>::max();
    out.normal = pair.a.normals[axis.face];
    reduce_to_four<double>({found.points.data(), found.count}, out);
}

// The corner that is deepest under a face, over it or not.
void touch_vertex(const PolytopePair& pair, const FaceAxis& axis, LocalManifold<double>& out)
{
    out.normal = pair.a.normals[axis.face];
    const Vec3 corner = pair.turn * pair.b.vertices[axis.vertex] + pair.shift;
    out.add(corner - out.normal * (axis.separation / 2), axis.separation,
            1u << 30 | std::uint32_t{axis.face} << 16 | axis.vertex);
}

// Two polytopes seen from either, and what it costs a face to lead.
struct Sides {
    Sides(const PolytopePair& of, double within)
        : pair(of), turned(of.mirrored()), speculative_margin(within),
          bias(kFaceBias * (of.a.inner_radius + of.b.inner_radius))
    { }

    const PolytopePair& pair;
    PolytopePair turned;
    double speculative_margin, bias;
};

// A face axis to begin with: the one remembered, if any.
struct Guess {
    Guess(const Sides& sides, const PairCache& cache)
    {
        of_b = cache.kind == static_cast<std::uint32_t>(Remembered::face_b);
        const PolytopePair& pair = of_b ? sides.turned : sides.pair;
        known = (of_b || cache.kind == static_cast<std::uint32_t>(Remembered::face_a))
            && cache.feature_a < pair.a.normals.size() && cache.feature_b < pair.b.vertices.size();
        if (known)
            axis = face_axis(pair, static_cast<std::uint16_t>(cache.feature_a),
                             static_cast<std::uint16_t>(cache.feature_b));
    }

    FaceAxis axis;
    bool known = false, of_b = false;
};

PairCache remember(Remembered kind, const FaceAxis& axis)
{
    const auto apart = static_cast<float>(std::max(0.0, axis.separation));
    return {axis.face, axis.vertex, static_cast<std::uint32_t>(kind), apart};
}

// What leads to the points: the best face of each, and the edges whose axis is better than both.
struct Axes {
    FaceAxis face_a, face_b;
    EdgeAxis edge;  // normal zero where there are none

    double top() const { return std::max(face_a.separation, face_b.separation); }
    bool b_leads(const Sides& sides) const
    {
        return face_b.separation > face_a.separation + sides.bias;
    }
};

PairCache remember_leading(const Sides& sides, const Axes& axes)
{
    return axes.b_leads(sides) ? remember(Remembered::face_b, axes.face_b)
                               : remember(Remembered::face_a, axes.face_a);
}

// Looks at all faces and edges. False where one shows the two to be beyond the margin.
bool look_at_all(const Sides& sides, const Guess& guess, PairCache& cache, Axes& axes)
{
    const PolytopePair &pair = sides.pair, &turned = sides.turned;
    const FaceAxis first = guess.known ? guess.axis : likely_face_axis(guess.of_b ? turned : pair);
    cache.apart = static_cast<float>(std::max(0.0, first.separation));
    if (first.separation > sides.speculative_margin) return false;

    // What a guess has shown saves looking at faces that cannot lead any more.
    axes.face_a = best_face_axis(pair, guess.of_b ? likely_face_axis(pair) : first,
                                 first.separation - sides.bias);
    if (axes.face_a.separation > sides.speculative_margin) {
        cache = remember(Remembered::face_a, axes.face_a);
        return false;
    }
    axes.face_b = best_face_axis(turned, guess.of_b ? first : likely_face_axis(turned),
                                 axes.face_a.separation);
    if (axes.face_b.separation > sides.speculative_margin) {
        cache = remember(Remembered::face_b, axes.face_b);
        return false;
    }
    cache = remember_leading(sides, axes);
    axes.edge = best_edge_axis(pair, axes.top());
    return axes.edge.separation <= sides.speculative_margin;
}

// Whose shapes they are, for GJK to look at.
struct Shown {
    const Shapes& shapes;
    ShapeRef a, b;
    const Pose& b_in_a;
};

std::uint16_t corner_along(const PolytopeView& shape, const Vec3& direction, std::uint32_t start)
{
    return support_vertex(shape, direction,
                          static_cast<std::uint16_t>(start < shape.vertices.size() ? start : 0));
}

// GJK's memory, had it ended on the axis of a face: three of its corners against the other's
// vertex, and what is furthest from there where these are likely to enclose 0.
MethodMemory memory_of(const Sides& sides, const Guess& guess)
{
    MethodMemory memory;
    if (!guess.known) return memory;
    const PolytopePair& pair = guess.of_b ? sides.turned : sides.pair;
    const Vec3& normal = pair.a.normals[guess.axis.face];
    const auto corners = pair.a.face(guess.axis.face);
    for (std::size_t i = 0; i < 3; ++i) {
        memory.a[i] = corners[i * corners.size() / 3];
        memory.b[i] = guess.axis.vertex;
    }
    memory.kind = 1;
    memory.count = 3;
    if (guess.axis.separation <= 0) {
        memory.count = 4;
        memory.a[3] = corner_along(pair.a, -normal, 0);
        memory.b[3] = corner_along(pair.b, pair.turn.transpose() * normal, 0);
    }
    memory.axis = guess.of_b ? Vec3(-(sides.pair.turn * normal)) : normal;
    if (guess.of_b) std::swap(memory.a, memory.b);
    return memory;
}

enum class Found { apart, near, unsure };

// Asks GJK which corners meet, and looks at their faces and edges alone. Unsure where it came to
// its bound, which is told by the cache, or where other axes must be better.
Found look_where_they_meet(
    const Shown& shown, const Sides& sides, const Guess& guess, PairCache& cache, Axes& axes)
{
    MethodMemory memory = memory_of(sides, guess);
    const ConvexPair cores(shown.shapes, shown.a, shown.b, shown.b_in_a);
    const MethodAnswer met =
        query_gjk(cores, sides.speculative_margin, MethodStart::cached, memory);
    if (met.cut_short) {
        cache.kind |= kFellBack;
        return Found::unsure;
    }
    const PolytopePair& pair = sides.pair;
    const std::uint16_t corner_a = corner_along(pair.a, met.normal, memory.a[0]);
    const std::uint16_t corner_b =
        corner_along(pair.b, -(pair.turn.transpose() * met.normal), memory.b[0]);
    axes.face_a = best_face_axis_at(pair, corner_a, corner_b);
    axes.face_b = best_face_axis_at(sides.turned, corner_b, corner_a);
    cache = remember_leading(sides, axes);
    if (met.separation > sides.speculative_margin) {
        cache.apart = static_cast<float>(met.separation);
        return Found::apart;
    }
    axes.edge = best_edge_axis_at(pair, corner_a, corner_b, axes.top());
    const double shown_apart = std::max(axes.top(), axes.edge.separation);
    return shown_apart < std::min(met.separation, 0.0) - sides.bias ? Found::unsure : Found::near;
}

// The points of touch by the axes found.
void find_points(const Sides& sides, const Axes& axes, LocalManifold<double>& out)
{
    const PolytopePair &pair = sides.pair, &turned = sides.turned;
    const double speculative_margin = sides.speculative_margin, bias = sides.bias;
    const bool b_leads = axes.b_leads(sides);
    const EdgeAxis& edge = axes.edge;
    const FaceAxis& face = b_leads ? axes.face_b : axes.face_a;
    const bool has_edge = !edge.normal.isZero(0);
    const Vec3 normal =
        b_leads ? Vec3(-(pair.turn * pair.b.normals[face.face])) : pair.a.normals[face.face];
    const bool edge_better = has_edge && edge.separation > face.separation + bias;
    const bool alike = has_edge && edge.normal.dot(normal) > kAlike;
    if (edge_better && !alike) {
        cross_edges(pair, edge, speculative_margin + bias, out);
        lay_edge_over_face(pair, edge.edge_a, edge.edge_b, speculative_margin, out);
        return;
    }
    // A face that has lost its deepest corner over the other's side still tells the depth, if what
    // is left of it agrees with the edges. Otherwise clipping has lost the very place of touch.
    double least = 0;
    face_manifold(b_leads ? turned : pair, face, speculative_margin, bias, out, least);
    if (b_leads) turn_round(pair, out);
    const bool kept = !edge_better && (face.separation >= 0 || least <= face.separation + 2 * bias);
    const bool agrees = alike && std::abs(least - edge.separation) <= 2 * bias;
    if (has_edge && !kept && !agrees) cross_edges(pair, edge, speculative_margin + bias, out);
    // A face that leads by its bias alone may have nothing over it: then the best one has. Unless
    // the two are deep its points are told far enough apart not to push: at rest others bear the
    // body, and what pushes at times would rock it.
    if (out.count > 0 || face.separation >= 0) return;
    const double deep = 4 * bias;
    const bool shallow = face.separation >= -deep;
    const bool by_b = axes.face_b.separation >= axes.face_a.separation;
    const FaceAxis& best = by_b ? axes.face_b : axes.face_a;
    if (by_b != b_leads)
        face_manifold(by_b ? turned : pair, best, speculative_margin, bias, out, least);
    if (shallow)
        for (int i = 0; i < out.count; ++i)
            out.points[static_cast<std::size_t>(i)].separation += deep;
    if (out.count == 0 && !shallow) touch_vertex(by_b ? turned : pair, best, out);
    if (by_b) turn_round(pair, out);
}

// The face of a that a normal is along, or none.
constexpr std::size_t kNoFace = ~std::size_t{0};
std::size_t face_along(const PolytopeView& shape, const Vec3& normal)
{
    for (std::size_t i = 0; i < shape.normals.size(); ++i)
        if (shape.normals[i].dot(normal) > kAlike) return i;
    return kNoFace;
}

// A floor to another is what is this many times as large.
constexpr double kFloor = 4;

// Lets what is small to the other stand on its face.
void spread_feet(const PolytopePair& pair, double speculative_margin, LocalManifold<double>& out)
{
    if (out.count == 0) return;
    if (pair.a.outer_radius > kFloor * pair.b.outer_radius) {
        if (const std::size_t face = face_along(pair.a, out.normal); face != kNoFace)
            spread_foot(pair, static_cast<std::uint16_t>(face), speculative_margin, out);
        return;
    }
    if (!(pair.b.outer_radius > kFloor * pair.a.outer_radius)) return;
    const std::size_t face = face_along(pair.b, -(pair.turn.transpose() * out.normal));
    if (face == kNoFace) return;
    const PolytopePair turned = pair.mirrored();
    turn_round(turned, out);
    spread_foot(turned, static_cast<std::uint16_t>(face), speculative_margin, out);
    turn_round(pair, out);
}

// None where it was no face that led.
LeadingFace leading_face(const PairCache& cache)
{
    const std::uint32_t kind = cache.kind & ~kFellBack;
    const bool of_a = kind == static_cast<std::uint32_t>(Remembered::face_a);
    const bool of_b = kind == static_cast<std::uint32_t>(Remembered::face_b);
    return {of_a || of_b ? cache.feature_a : LeadingFace{}.face, of_b};
}

void collide_polytopes(const PolytopePair& pair,
                       double speculative_margin,
                       const Shown* shown,
                       PairCache& cache,
                       LocalManifold<double>& out)
{
    out.count = 0;
    const Sides sides(pair, speculative_margin);
    cache.kind &= ~kFellBack;
    const Guess guess(sides, cache);
    if (guess.known && guess.axis.separation > speculative_margin) {
        cache.apart = static_cast<float>(guess.axis.separation);
        return;
    }
    Axes axes;
    Found found = shown ? look_where_they_meet(*shown, sides, guess, cache, axes) : Found::unsure;
    if (found == Found::unsure) {
        const std::uint32_t fell_back = cache.kind & kFellBack;
        found = look_at_all(sides, guess, cache, axes) ? Found::near : Found::apart;
        cache.kind |= fell_back;
    }
    if (found != Found::near) return;
    find_points(sides, axes, out);
    spread_feet(pair, speculative_margin, out);
    meet_edge_on_edge(pair, leading_face(cache), speculative_margin, out);
}

// Of the size of both: where the balls inside are smaller, the bias of faces comes near rounding.
constexpr float kUnlike = 2e-3F;

// False where float will not do.
//
//   over_face  whether it is two edges that cross, one of them all but along a face of the other
bool meet_wide(const WideShape& wide_a,
               const WideShape& wide_b,
               const PairInput<float>& in,
               PairCache& cache,
               LocalManifold<float>& out,
               bool& over_face)
{
    if (!wide_a.suited() || !wide_b.suited()) return false;
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    HullPair pair;
    pair.a = wide_a.view();
    pair.b = wide_b.view();
    const float inner = pair.a.inner + pair.b.inner;
    if (inner < kUnlike * (pair.a.outer + pair.b.outer)) return false;
    const Mat3 turn = b_in_a.orientation.cast<double>().toRotationMatrix();
    const Vec3 offset = turn * wide_b.center() + b_in_a.position.cast<double>() - wide_a.center();
    for (int i = 0; i < 9; ++i) pair.turn[i] = static_cast<float>(turn(i / 3, i % 3));
    for (int i = 0; i < 3; ++i) pair.offset[i] = static_cast<float>(offset[i]);
    pair.speculative_margin = speculative_margin;
    pair.bias = static_cast<float>(kFaceBias) * inner;

    HullGuess guess{cache.kind, cache.feature_a, cache.feature_b};
    HullOverlap overlap;
    static const HullKernel& collide = hull_kernel();
    collide(pair, guess, overlap);
    cache = {guess.a, guess.b, guess.kind, overlap.count == 0 ? overlap.apart : 0};
    over_face = double{overlap.edge_to_face} > kAllButFace;
    out.count = 0;
    if (overlap.count == 0) return true;
    out.normal = {overlap.normal[0], overlap.normal[1], overlap.normal[2]};
    std::array<LocalManifold<float>::Point, HullOverlap::kMost> points;
    const auto count = static_cast<std::size_t>(overlap.count);
    const Vec3T<float> center = wide_a.center().cast<float>();
    for (std::size_t i = 0; i < count; ++i) {
        const HullOverlap::Point& point = overlap.points[i];
        points[i].position =
            Vec3T<float>(point.position[0], point.position[1], point.position[2]) + center;
        points[i].separation = point.separation;
        points[i].feature = point.feature;
    }
    reduce_to_four<float>({points.data(), count}, out);
    return true;
}

// Whether what is small to the other has to stand on its feet, for the step that is taken.
bool may_spread(const WidePolytope& a,
                const WidePolytope& b,
                float speculative_margin,
                const LocalManifold<float>& found)
{
    constexpr auto kMuch = static_cast<float>(kFloor);
    if (a.outer <= kMuch * b.outer && b.outer <= kMuch * a.outer) return false;
    float deepest = 0;
    for (int i = 0; i < found.count; ++i)
        deepest = std::min(deepest, found.points[static_cast<std::size_t>(i)].separation);
    const float inner = a.outer > b.outer ? b.inner : a.inner;
    return is_long_step(double{speculative_margin}, double{deepest}, double{inner});
}

// A little below the cosine that the plain way asks for, which has the last word.
constexpr auto kAlongInFloat = static_cast<float>(kEdgesAlong - 1e-5);

bool has_edge_along(const WidePolytope& shape, const Vec3T<float>& direction)
{
    return std::any_of(shape.edges, shape.edges + shape.edge_count, [&](const WideEdge& edge) {
        const float cosine = edge.along[0] * direction.x() + edge.along[1] * direction.y()
            + edge.along[2] * direction.z();
        return std::abs(cosine) >= kAlongInFloat;
    });
}

// Whether an edge of a face is along any of another polytope.
//
//   turn  from the axes of whose face it is to the other's
bool has_edge_along(const WidePolytope& other,
                    const WidePolytope& self,
                    std::uint32_t face,
                    const QuatT<float>& turn)
{
    const auto begin = self.sides() + self.face_begin()[face];
    const auto end = self.sides() + self.face_begin()[face + 1];
    return std::any_of(begin, end, [&](std::uint16_t side) {
        const float* const along = self.edges[side].along;
        return has_edge_along(other, turn * Vec3T<float>(along[0], along[1], along[2]));
    });
}

// Whether it may be two edges that meet, side by side.
bool may_be_edges(const WidePolytope& a,
                  const WidePolytope& b,
                  const QuatT<float>& b_in_a,
                  float speculative_margin,
                  const PairCache& cache,
                  const LocalManifold<float>& found)
{
    const QuatT<float> a_in_b = b_in_a.conjugate();
    if (found.count == 0) {
        const LeadingFace leading = leading_face(cache);
        if (cache.apart > speculative_margin || leading.face == LeadingFace{}.face) return false;
        return leading.of_b ? has_edge_along(a, b, leading.face, b_in_a)
                            : has_edge_along(b, a, leading.face, a_in_b);
    }
    const float radius = static_cast<float>(kRounded) * std::min(a.inner, b.inner);
    Vec3T<float> middle, along;
    return is_strip(found, radius, middle, along) && has_edge_along(a, along)
        && has_edge_along(b, a_in_b * along);
}

// As above, for what the wide kernels found.
void finish_wide(const WidePolytope& wide_a,
                 const WidePolytope& wide_b,
                 const PairInput<float>& in,
                 const PairCache& cache,
                 bool over_face,
                 LocalManifold<float>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    const bool spreads = may_spread(wide_a, wide_b, speculative_margin, out);
    if (!spreads && !over_face
        && !may_be_edges(wide_a, wide_b, b_in_a.orientation, speculative_margin, cache, out))
        return;
    const PolytopeShape shape_a(shapes, a), shape_b(shapes, b);
    const PolytopePair pair(shape_a.view(), shape_b.view(),
                            {b_in_a.position.cast<double>(), b_in_a.orientation.cast<double>()});
    LocalManifold<double> finished = out.cast<double>();
    if (over_face && finished.count == 1) {
        const std::uint32_t edges = finished.points[0].feature;
        lay_edge_over_face(pair, edges >> 8 & 0xff, edges & 0xff, double{speculative_margin},
                           finished);
    }
    if (spreads) spread_feet(pair, double{speculative_margin}, finished);
    meet_edge_on_edge(pair, leading_face(cache), double{speculative_margin}, finished);
    out = finished.cast<float>();
}

// Of both: from how many vertices on GJK takes less than all axes do.
constexpr std::size_t kManyVertices = 192;

// `searches` false looks at all axes however many they are.
template <class Real>
void meet_plain(const PairInput<Real>& in,
                bool searches,
                PairCache& cache,
                LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    const PolytopeShape shape_a(shapes, a), shape_b(shapes, b);
    const Pose pose{b_in_a.position.template cast<double>(),
                    b_in_a.orientation.template cast<double>()};
    const PolytopePair pair(shape_a.view(), shape_b.view(), pose);
    const bool many = pair.a.vertices.size() + pair.b.vertices.size() >= kManyVertices;
    const Pose straight{pose.position, pose.orientation.normalized()};
    const Shown shown{shapes, a, b, straight};
    LocalManifold<double> found;
    collide_polytopes(pair, speculative_margin, searches && many ? &shown : nullptr, cache, found);

    out = found.cast<Real>();
}

}  // namespace

template <>
void hull_hull<float>(const PairInput<float>& in, PairCache& cache, LocalManifold<float>& out)
{
    bool over_face = false;
    const WideShape a(in.shapes, in.a), b(in.shapes, in.b);
    if (!meet_wide(a, b, in, cache, out, over_face))
        meet_plain(in, true, cache, out);
    else
        finish_wide(a.view(), b.view(), in, cache, over_face, out);
}

template <>
void hull_hull<double>(const PairInput<double>& in, PairCache& cache, LocalManifold<double>& out)
{
    meet_plain(in, true, cache, out);
}

void hull_hull_by_axes(const PairInput<double>& in, PairCache& cache, LocalManifold<double>& out)
{
    meet_plain(in, false, cache, out);
}

}  // namespace throng
