// Hull against hull, and box against hull: separating axes, then clipping, as for two boxes.
//
// The wide kernels answer for float. What is too big, too thin or too unlike for them goes by the
// plain arithmetic of double, and so do pairs in double.
#include "narrowphase/contact_points.hpp"
#include "narrowphase/hull_kernels.hpp"
#include "narrowphase/pair_functions.hpp"
#include "narrowphase/polytope_contacts.hpp"
#include "narrowphase/wide_shapes.hpp"

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
                   double reach,
                   double slack,
                   LocalManifold<double>& out,
                   double& least)
{
    PolytopePoints found;
    clip_faces(pair, axis, reach, slack, found);
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

// The remembered face, or a likely one: it parts the two at once or is a good face to begin with.
FaceAxis first_guess(const PolytopePair& pair, const PairCache& cache)
{
    const bool is_face = cache.kind == static_cast<std::uint32_t>(Remembered::face_a)
        || cache.kind == static_cast<std::uint32_t>(Remembered::face_b);
    const bool known = is_face && cache.feature_a < pair.a.normals.size()
        && cache.feature_b < pair.b.vertices.size();
    return known ? face_axis(pair, static_cast<std::uint16_t>(cache.feature_a),
                             static_cast<std::uint16_t>(cache.feature_b))
                 : likely_face_axis(pair);
}

PairCache remember(Remembered kind, const FaceAxis& axis)
{
    const auto apart = static_cast<float>(std::max(0.0, axis.separation));
    return {axis.face, axis.vertex, static_cast<std::uint32_t>(kind), apart};
}

void collide_polytopes(const PolytopePair& pair,
                       double reach,
                       PairCache& cache,
                       LocalManifold<double>& out)
{
    out.count = 0;
    const PolytopePair turned = pair.mirrored();
    const bool by_b = cache.kind == static_cast<std::uint32_t>(Remembered::face_b);
    const FaceAxis guess = first_guess(by_b ? turned : pair, cache);
    cache.apart = static_cast<float>(std::max(0.0, guess.separation));
    if (guess.separation > reach) return;

    // What a guess has shown saves looking at faces that cannot lead any more.
    const double bias = kFaceBias * (pair.a.inner_radius + pair.b.inner_radius);
    const FaceAxis face_a =
        best_face_axis(pair, by_b ? likely_face_axis(pair) : guess, guess.separation - bias);
    if (face_a.separation > reach) {
        cache = remember(Remembered::face_a, face_a);
        return;
    }
    const FaceAxis face_b =
        best_face_axis(turned, by_b ? guess : likely_face_axis(turned), face_a.separation);
    if (face_b.separation > reach) {
        cache = remember(Remembered::face_b, face_b);
        return;
    }
    const bool b_leads = face_b.separation > face_a.separation + bias;
    const FaceAxis& face = b_leads ? face_b : face_a;
    cache = remember(b_leads ? Remembered::face_b : Remembered::face_a, face);

    const double top = std::max(face_a.separation, face_b.separation);
    const EdgeAxis edge = best_edge_axis(pair, top);
    const bool has_edge = !edge.normal.isZero(0);
    if (edge.separation > reach) return;
    const Vec3 normal =
        b_leads ? Vec3(-(pair.turn * pair.b.normals[face.face])) : pair.a.normals[face.face];
    const bool edge_better = has_edge && edge.separation > face.separation + bias;
    const bool alike = has_edge && edge.normal.dot(normal) > kAlike;
    if (edge_better && !alike) {
        cross_edges(pair, edge, reach + bias, out);
        return;
    }
    // A face that has lost its deepest corner over the other's side still tells the depth, if what
    // is left of it agrees with the edges. Otherwise clipping has lost the very place of touch.
    double least = 0;
    face_manifold(b_leads ? turned : pair, face, reach, bias, out, least);
    if (b_leads) turn_round(pair, out);
    const bool kept = !edge_better && (face.separation >= 0 || least <= face.separation + 2 * bias);
    const bool agrees = alike && std::abs(least - edge.separation) <= 2 * bias;
    if (has_edge && !kept && !agrees) cross_edges(pair, edge, reach + bias, out);
    // A face that leads by its bias alone may have nothing over it. At rest others bear the body,
    // and a contact that comes and goes would rock it.
    if (out.count > 0 || face.separation >= -4 * bias) return;
    face_manifold(b_leads ? pair : turned, b_leads ? face_a : face_b, reach, bias, out, least);
    if (out.count == 0) touch_vertex(b_leads ? pair : turned, b_leads ? face_a : face_b, out);
    if (!b_leads) turn_round(pair, out);
}

// Of the size of both: where the balls inside are smaller, the bias of faces comes near rounding.
constexpr float kUnlike = 2e-3F;

// False where float will not do.
bool meet_wide(const Shapes& shapes,
               ShapeRef a,
               ShapeRef b,
               const PoseT<float>& b_in_a,
               float reach,
               PairCache& cache,
               LocalManifold<float>& out)
{
    const WideShape wide_a(shapes, a), wide_b(shapes, b);
    if (!wide_a.suited() || !wide_b.suited()) return false;
    HullPair pair;
    pair.a = wide_a.view();
    pair.b = wide_b.view();
    const float inner = pair.a.inner + pair.b.inner;
    if (inner < kUnlike * (pair.a.outer + pair.b.outer)) return false;
    const Mat3 turn = b_in_a.orientation.cast<double>().toRotationMatrix();
    const Vec3 offset = turn * wide_b.center() + b_in_a.position.cast<double>() - wide_a.center();
    for (int i = 0; i < 9; ++i) pair.turn[i] = static_cast<float>(turn(i / 3, i % 3));
    for (int i = 0; i < 3; ++i) pair.offset[i] = static_cast<float>(offset[i]);
    pair.reach = reach;
    pair.bias = static_cast<float>(kFaceBias) * inner;

    HullGuess guess{cache.kind, cache.feature_a, cache.feature_b};
    HullTouch touch;
    static const HullKernel meet = hull_kernel();
    meet(pair, guess, touch);
    cache = {guess.a, guess.b, guess.kind, touch.count == 0 ? touch.apart : 0};
    out.count = 0;
    if (touch.count == 0) return true;
    out.normal = {touch.normal[0], touch.normal[1], touch.normal[2]};
    std::array<LocalManifold<float>::Point, HullTouch::kMost> points;
    const auto count = static_cast<std::size_t>(touch.count);
    const Vec3T<float> center = wide_a.center().cast<float>();
    for (std::size_t i = 0; i < count; ++i) {
        const HullTouch::Point& point = touch.points[i];
        points[i].position =
            Vec3T<float>(point.position[0], point.position[1], point.position[2]) + center;
        points[i].separation = point.separation;
        points[i].feature = point.feature;
    }
    reduce_to_four<float>({points.data(), count}, out);
    return true;
}

template <class Real>
void meet_plain(const Shapes& shapes,
                ShapeRef a,
                ShapeRef b,
                const PoseT<Real>& b_in_a,
                Real reach,
                PairCache& cache,
                LocalManifold<Real>& out)
{
    const PolytopeShape shape_a(shapes, a), shape_b(shapes, b);
    const Pose pose{b_in_a.position.template cast<double>(),
                    b_in_a.orientation.template cast<double>()};
    LocalManifold<double> found;
    collide_polytopes({shape_a.view(), shape_b.view(), pose}, reach, cache, found);

    out = found.cast<Real>();
}

}  // namespace

template <>
void hull_hull<float>(const Shapes& shapes,
                      ShapeRef a,
                      ShapeRef b,
                      const PoseT<float>& b_in_a,
                      float reach,
                      PairCache& cache,
                      LocalManifold<float>& out)
{
    if (!meet_wide(shapes, a, b, b_in_a, reach, cache, out))
        meet_plain(shapes, a, b, b_in_a, reach, cache, out);
}

template <>
void hull_hull<double>(const Shapes& shapes,
                       ShapeRef a,
                       ShapeRef b,
                       const Pose& b_in_a,
                       double reach,
                       PairCache& cache,
                       LocalManifold<double>& out)
{
    meet_plain(shapes, a, b, b_in_a, reach, cache, out);
}

}  // namespace throng
