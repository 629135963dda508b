// Triangle against polytope: the axis that leads, of those that the mesh sticks out to, and the
// points that come of it.
#include "kernels/geometry/closest_points.hpp"
#include "kernels/geometry/polytope_contacts.hpp"
#include "narrowphase/manifold/contact_points.hpp"
#include "narrowphase/manifold/edge_over_face.hpp"
#include "narrowphase/manifold/polytope_foot.hpp"
#include "narrowphase/mesh/triangle_contacts.hpp"

#include <algorithm>

namespace throng {
namespace {

// Cosine beyond which faces are alike: a fiftieth of a radian.
constexpr double kAlike = 0.9998;

// A triangle leaves it to the next where the way out there is this much of its own. Were it to do
// so for any shorter way, one in a few hundred shapes deep inside would be pushed by none.
constexpr double kShorter = 0.2;

// Cosine up to which a face of the shape looks at the triangle. Its sides do not: what is let in
// from above is hardly beyond the triangles beside it.
constexpr double kLooksAt = 0.5;

// The best axis so far of a triangle against a polytope, of those that the mesh sticks out to.
struct TriangleAxis {
    enum class Kind { front, face, apart } kind = Kind::front;
    double separation = 0;
    double apart = 0;  // m, by the axis that parts the two most, whatever the mesh
    FaceAxis face;
};

// The corners of a triangle as a polytope sees them.
using SeenCorners = std::array<Vec3, 3>;

SeenCorners seen_corners(const PolytopePair& turned)
{
    SeenCorners seen;
    for (std::size_t k = 0; k < 3; ++k) seen[k] = turned.turn * turned.b.vertices[k] + turned.shift;
    return seen;
}

// As face_axis(), of a polytope and three corners.
FaceAxis axis_of(const PolytopeView& shape, const SeenCorners& seen, std::size_t face)
{
    const Vec3& normal = shape.normals[face];
    FaceAxis axis{normal.dot(seen[0]), static_cast<std::uint16_t>(face), 0};
    for (std::uint16_t k = 1; k < 3; ++k) {
        const double height = normal.dot(seen[k]);
        if (height < axis.separation) axis = {height, axis.face, k};
    }
    axis.separation -= shape.offsets[face];
    return axis;
}

// b's faces: any may show that the two are apart; only those the mesh sticks out to may push.
void try_faces(const MeshTriangle& triangle,
               const PolytopePair& turned,
               const SeenCorners& seen,
               double speculative_margin,
               double bias,
               TriangleAxis& best)
{
    for (std::size_t i = 0; i < turned.a.normals.size(); ++i) {
        const FaceAxis axis = axis_of(turned.a, seen, i);
        if (axis.separation > speculative_margin) {
            best.kind = TriangleAxis::Kind::apart;
            return;
        }
        best.apart = std::max(best.apart, axis.separation);
        const double to_beat =
            best.kind == TriangleAxis::Kind::front ? best.separation + bias : best.separation;
        if (axis.separation <= to_beat) continue;
        const Vec3 direction = -(turned.turn.transpose() * turned.a.normals[i]);
        if (direction.dot(triangle.normal) < 0) continue;
        if (!corner_sticks_out(triangle, axis.vertex, direction, bias)) continue;
        best.kind = TriangleAxis::Kind::face;
        best.separation = axis.separation;
        best.face = axis;
    }
}

// A triangle and a polytope, as both of them see it, and the triangle's front between them.
struct FrontedPair {
    const MeshTriangle& triangle;
    const PolytopePair &pair, &turned;
    SeenCorners seen;
    const FaceAxis& front;
    double speculative_margin, bias;
};

// Whether the shape's lowest corner is over the triangle, or below it: then no axis parts the two
// by more than that is high or deep.
bool is_lowest_over(const PolytopePair& pair, const FaceAxis& front)
{
    const Vec3 lowest = pair.turn * pair.b.vertices[front.vertex] + pair.shift;
    for (std::size_t rim = 2; rim < 5; ++rim)
        if (pair.a.normals[rim].dot(lowest) > pair.a.offsets[rim]) return false;
    return true;
}

// Whether no axis parts the two by more than the speculative margin: b's faces and any two edges
// may; the front is known.
bool within_margin(const FrontedPair& fronted, TriangleAxis& best)
{
    const auto& [triangle, pair, turned, seen, front, speculative_margin, bias] = fronted;
    try_faces(triangle, turned, seen, speculative_margin, bias, best);
    if (best.kind == TriangleAxis::Kind::apart) return false;
    // By how much the two are apart does not matter once they are.
    const double floor =
        best.apart > bias ? speculative_margin : std::min(bias, speculative_margin);
    if (std::abs(front.separation) <= floor && is_lowest_over(pair, front)) return true;
    const EdgeAxis any = best_edge_axis(turned, floor);
    if (!any.normal.isZero(0)) best.apart = any.separation;
    return best.apart <= speculative_margin;
}

// Where the polytope's face at its deepest corner is a sliver beside the triangle: the first that
// is all but along it and has anything over the triangle.
void clip_like_faces(const PolytopePair& pair,
                     const FaceAxis& front,
                     double speculative_margin,
                     double slack,
                     PolytopePoints& found)
{
    const Vec3 against = pair.turn.transpose() * -pair.a.normals[front.face];
    for (std::size_t i = 0; i < pair.b.normals.size() && found.count == 0; ++i)
        if (pair.b.normals[i].dot(against) > kAlike)
            clip_faces(pair, front, static_cast<std::uint16_t>(i), speculative_margin, slack,
                       found);
}

// Of two that are apart, what lies behind the triangle has gone past its rim, or past the back of
// all that the mesh encloses: a far margin sees both.
void drop_overlaps(PolytopePoints& found)
{
    std::size_t kept = 0;
    for (std::size_t i = 0; i < found.count; ++i)
        if (found.points[i].separation >= 0) found.points[kept++] = found.points[i];
    found.count = kept;
}

// Of a round side that lies on the triangle no more than its lowest line: the prism's other corners
// are above it, and would brake what rolls.
void keep_line(const PolytopePair& pair, const Vec3& normal, PolytopePoints& found)
{
    const Vec3 down = -(pair.turn.transpose() * normal);
    const double across = down.head<2>().norm(), radius = pair.b.vertices[0].head<2>().norm();
    if (!(across > std::abs(down.z()))) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < found.count; ++i) {
        const auto& point = found.points[i];
        const Vec3 on_b = point.position + normal * (point.separation / 2) - pair.shift;
        const Vec3 local = pair.turn.transpose() * on_b;
        if (local.head<2>().dot(down.head<2>()) > (1 - 1e-6) * radius * across)
            found.points[kept++] = point;
    }
    found.count = kept;
}

// Points along the face that leads, of the triangle or of the polytope.
void lay_face(const FrontedPair& fronted, const TriangleAxis& best, LocalManifold<double>& out)
{
    const auto& [triangle, pair, turned, seen, front, speculative_margin, bias] = fronted;
    const bool by_front = best.kind == TriangleAxis::Kind::front;
    PolytopePoints found;
    clip_faces(by_front ? pair : turned, by_front ? front : best.face, speculative_margin, bias,
               found);
    if (by_front) clip_like_faces(pair, front, speculative_margin, bias, found);
    if (best.apart > bias) drop_overlaps(found);
    if (by_front && pair.b.round) keep_line(pair, triangle.normal, found);
    out.normal = by_front ? triangle.normal : turned.a.normals[best.face.face];
    reduce_to_four<double>({found.points.data(), found.count}, out);
    // Of two that are apart by another axis, what is over the triangle may be behind it.
    if (by_front && best.apart <= bias && !pair.b.round)
        spread_foot(pair, 0, speculative_margin, out);
    if (!by_front) turn_round(pair, out);
}

// Whether the shape is before a triangle, or no further behind it than `most`, below 0.
bool is_shallow(const MeshTriangle& triangle, const PolytopePair& pair, double most)
{
    const Vec3& normal = triangle.normal;
    // Nothing pushes from behind.
    if (triangle.height(pair.offset + pair.a.center) < 0) return false;
    const auto lowest = support_vertex(pair.b, -(pair.turn.transpose() * normal), 0);
    return triangle.height(pair.turn * pair.b.vertices[lowest] + pair.shift) > most;
}

// Whether over an edge that sticks out there is a triangle that the shape is hardly behind. It
// pushes itself, and seen from this one what has just come past the edge may be deep inside.
bool yields_over_edges(const MeshTriangle& triangle, const PolytopePair& pair, double most)
{
    for (std::size_t e = 0; e < 3; ++e) {
        const std::int32_t next = triangle.adjacent(e);
        if (next < 0 || !triangle.is_convex(e)) continue;
        const auto beyond = static_cast<std::uint32_t>(next);
        if (is_shallow({triangle.mesh, beyond, triangle.behind}, pair, most)) return true;
    }
    return false;
}

// Whether one of the shape's faces that look at the triangle is hardly beyond it, or not at all,
// and may not push: then another triangle sticks out further that way and pushes, as where a face
// lies on a peak or on a ridge. By an edge of this one the same shape would be deep inside.
bool yields_to_faces(const FrontedPair& fronted, double most)
{
    const PolytopeView& shape = fronted.turned.a;
    const Vec3 against = -(fronted.turned.turn * fronted.triangle.normal);
    for (std::size_t i = 0; i < shape.normals.size(); ++i)
        if (against.dot(shape.normals[i]) > kLooksAt
            && axis_of(shape, fronted.seen, i).separation > most)
            return true;
    return false;
}

// The normal on the far side of an edge that sticks out: a rim pushes sideways too, and a little
// further, so that directions straight out of it are well inside.
Vec3 far_normal(const MeshTriangle& triangle, std::size_t edge, const Vec3& rim)
{
    const std::int32_t next = triangle.adjacent(edge);
    if (next >= 0) return triangle.normal_of(next);
    return (rim - 0.05 * triangle.normal).normalized();
}

// The triangle with the edges that stick out alone; their arcs end where the next triangle's begin.
struct OutwardEdges {
    OutwardEdges(const MeshTriangle& triangle, const TrianglePolytope& flat, const PolytopePair& of)
        : normals(flat.normals), offsets(flat.offsets), pair(of)
    {
        for (std::size_t e = 0; e < 3; ++e) {
            if (!triangle.is_convex(e)) continue;
            normals[2 + e] = far_normal(triangle, e, flat.normals[2 + e]);
            offsets[2 + e] = normals[2 + e].dot(triangle.corners[e]);
            edges[count++] = of.a.edges[2 * e];
        }
        pair.a.normals = normals;
        pair.a.offsets = offsets;
        pair.a.edges = {edges.data(), count};
    }
    /// The best of them and the shape's, as best_edge_axis(); it is the few that are turned.
    EdgeAxis best_axis(const PolytopePair& turned, double to_beat) const
    {
        if (count == 0) return {};
        PolytopePair seen = turned;
        seen.b = pair.a;
        EdgeAxis best = best_edge_axis(seen, to_beat);
        best.normal = -(pair.turn * best.normal);
        std::swap(best.edge_a, best.edge_b);
        return best;
    }
    OutwardEdges(const OutwardEdges&) = delete;  // the pair looks at the arrays
    OutwardEdges& operator=(const OutwardEdges&) = delete;

    std::array<Vec3, 5> normals;
    std::array<double, 5> offsets;
    std::array<Hull::Edge, 3> edges{};
    std::size_t count = 0;
    PolytopePair pair;
};

// The point of two edges; none where it is nowhere near the triangle: what overlaps along the axis
// of two long edges by a hair may have them pass one another by any distance.
void push_by_edges(const FrontedPair& fronted,
                   const OutwardEdges& outward,
                   const EdgeAxis& edge,
                   LocalManifold<double>& out)
{
    const double limit = fronted.speculative_margin + fronted.bias;
    cross_edges(outward.pair, edge, limit, out);
    if (out.count == 0) return;
    const auto& [a, b, c] = fronted.triangle.corners;
    const Vec3& place = out.points[0].position;
    const Vec3 apart = place - closest_on_triangle<double>(place, a, b, c).point;
    if (apart.norm() > limit - std::min(edge.separation, 0.0)) out.count = 0;
    lay_edge_over_face(outward.pair, edge.edge_a, edge.edge_b, fronted.speculative_margin, out);
}

// Points along a face that the shape's edge borders, where the axis of the two edges is that face's
// by a hair: a plate that lies on a ridge. The face may not be asked itself, as beyond the plate
// the ridge goes on and rises above it.
void push_by_face(const FrontedPair& fronted,
                  const TriangleAxis& best,
                  const EdgeAxis& edge,
                  LocalManifold<double>& out)
{
    const PolytopePair& turned = fronted.turned;
    const Vec3 direction = -(fronted.pair.turn.transpose() * edge.normal);
    double cosine = 0;
    const std::uint16_t face = face_beside(turned.a, edge.edge_b, direction, cosine);
    if (!(cosine > kAlike)) return;
    TriangleAxis by_face = best;
    by_face.kind = TriangleAxis::Kind::face;
    by_face.face = face_axis(turned, face);
    lay_face(fronted, by_face, out);
}

// By what tells them apart best, or least of all overlaps.
void collide_along_best(const FrontedPair& fronted,
                        const TrianglePolytope& flat,
                        LocalManifold<double>& out)
{
    const auto& [triangle, pair, turned, seen, front, speculative_margin, bias] = fronted;
    TriangleAxis best;
    best.separation = best.apart = front.separation;
    if (!within_margin(fronted, best)) return;
    const bool parted = best.apart > bias;

    const OutwardEdges outward(triangle, flat, pair);
    const double to_beat = best.separation + bias;
    const EdgeAxis edge = outward.best_axis(turned, parted ? std::max(to_beat, 0.0) : to_beat);
    const double told = edge.normal.isZero(0) ? best.separation : edge.separation;
    if (!parted && told < -bias) {
        const double most = kShorter * told;
        if (yields_over_edges(triangle, pair, most)) return;
        if (!edge.normal.isZero(0) && yields_to_faces(fronted, most)) return;
    }
    if (!edge.normal.isZero(0)) {
        if (edge.separation > speculative_margin) return;
        push_by_face(fronted, best, edge, out);
        if (out.count == 0) push_by_edges(fronted, outward, edge, out);
        return;
    }
    lay_face(fronted, best, out);
    // What leads by its bias alone may have nothing over it.
    if (out.count > 0 || best.separation >= 0 || parted) return;
    const EdgeAxis better = outward.best_axis(turned, best.separation);
    if (!better.normal.isZero(0)) push_by_edges(fronted, outward, better, out);
}

}  // namespace

void collide_triangle_polytope(const MeshTriangle& triangle,
                               const PolytopeView& shape,
                               const Pose& pose,
                               double speculative_margin,
                               LocalManifold<double>& out,
                               bool through)
{
    out.count = 0;
    const auto& corners = triangle.corners;
    const TrianglePolytope flat(corners[0], corners[1], corners[2], triangle.normal);
    const PolytopePair pair(flat.view(), shape, pose);
    if (triangle.normal.dot(pair.offset) < 0 && !through) return;
    const FaceAxis front = face_axis(pair, 0);
    if (front.separation > speculative_margin) return;
    const double bias = 1e-3 * shape.inner_radius;
    const PolytopePair turned = pair.mirrored();
    const FrontedPair fronted{triangle,           pair, turned, seen_corners(turned), front,
                              speculative_margin, bias};
    collide_along_best(fronted, flat, out);
    if (!through || out.count > 0) return;
    // Pressed all but out of the triangle on its other side it goes back the way it came; by its
    // deepest corner where its lowest side is over another, for which this one pushes too.
    TriangleAxis back;
    back.separation = back.apart = front.separation;
    lay_face(fronted, back, out);
    if (out.count > 0) return;
    const Vec3 deepest = pair.turn * shape.vertices[front.vertex] + pair.shift;
    out.normal = triangle.normal;
    out.add(deepest - triangle.normal * (front.separation / 2), front.separation, 0);
}

}  // namespace throng
