#include "kernels/geometry/polytope_contacts.hpp"

#include "kernels/geometry/clip.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace throng {
namespace {

// Square of the sine below which edges are parallel: their common normal could point anywhere.
constexpr double kParallel = 1e-24;
// ... and below which the normal is coarse enough for other vertices to be further along it.
constexpr double kNearParallel = 1e-8;

double extent_along(const PolytopeView& shape, const Vec3& direction)
{
    return direction.dot(shape.vertices[support_vertex(shape, direction, 0)]);
}

// An edge that may take part: its direction and its faces' normals, in a's frame.
struct Arc {
    Vec3 along, left, right;
    Vec3 on;  // a point of the edge
    std::uint16_t edge;
};

Arc arc_of(const PolytopeView& shape, std::size_t index)
{
    const Hull::Edge& edge = shape.edges[index];
    const Vec3& on = shape.vertices[edge.from];
    return {shape.vertices[edge.to] - on, shape.normals[edge.left], shape.normals[edge.right], on,
            static_cast<std::uint16_t>(index)};
}

// Edges that may leave the other's center, `other` in this one's frame, at least `least` beyond
// them. The rest cannot part the two better than is known already, for there is a ball round that
// center inside the other.
void collect_arcs(const PolytopeView& shape,
                  const Vec3& other,
                  double least,
                  std::vector<double>& beyond,
                  std::vector<Arc>& arcs)
{
    arcs.clear();
    beyond.resize(shape.normals.size());
    for (std::size_t i = 0; i < shape.normals.size(); ++i) {
        beyond[i] = shape.normals[i].dot(other) - shape.offsets[i];
    }
    for (std::size_t i = 0; i < shape.edges.size(); ++i) {
        const Hull::Edge& edge = shape.edges[i];
        const Vec3& on = shape.vertices[edge.from];
        const Vec3 along = shape.vertices[edge.to] - on;
        const double best = std::max(beyond[edge.left], beyond[edge.right]);
        if (best < least) {
            // The best normal may lie inside the arc: then it is straight away from the edge.
            if (best < 0) continue;
            const Vec3 towards = other - on;
            const double along2 = along.squaredNorm(), part = along.dot(towards);
            if ((towards.squaredNorm() - least * least) * along2 < part * part) continue;
            const Vec3 across = towards.cross(along);
            if (across.dot(shape.normals[edge.left]) < 0) continue;
            if (across.dot(shape.normals[edge.right]) > 0) continue;
        }
        arcs.push_back(arc_of(shape, i));
    }
}

// Whether the arc of a and the arc of -b cross on the sphere of directions, b already negated.
bool arcs_cross(const Arc& a, const Arc& b)
{
    const double left_b = b.left.dot(a.along), right_b = b.right.dot(a.along);
    if (left_b * right_b >= 0) return false;
    const double left_a = a.left.dot(b.along), right_a = a.right.dot(b.along);
    return left_a * right_a < 0 && left_b * right_a > 0;
}

struct Scratch {
    std::vector<double> beyond;
    std::vector<Arc> arcs_a, arcs_b;
};

// b's arcs as a sees them, pointing the other way.
void turn_arcs(const PolytopePair& pair, std::vector<Arc>& arcs)
{
    for (Arc& arc : arcs) {
        arc.along = pair.turn * arc.along;
        arc.left = -(pair.turn * arc.left);
        arc.right = -(pair.turn * arc.right);
        arc.on = pair.turn * arc.on + pair.shift;
    }
}

// The best axis of an arc of a and an arc of b, both as a sees them.
EdgeAxis best_crossing(const PolytopePair& pair, const Scratch& scratch, double to_beat)
{
    EdgeAxis best;
    best.separation = to_beat;
    for (const Arc& a : scratch.arcs_a) {
        for (const Arc& b : scratch.arcs_b) {
            if (!arcs_cross(a, b)) continue;
            Vec3 normal = a.along.cross(b.along);
            const double length2 = normal.squaredNorm();
            const double full2 = a.along.squaredNorm() * b.along.squaredNorm();
            if (length2 <= kParallel * full2) continue;
            normal /= std::sqrt(length2);
            if (normal.dot(a.left + a.right) < 0) normal = -normal;
            double separation = normal.dot(b.on - a.on);
            if (length2 < kNearParallel * full2 || separation > best.separation) {
                separation = normal.dot(pair.shift)
                    - extent_along(pair.b, -(pair.turn.transpose() * normal))
                    - extent_along(pair.a, normal);
            }
            if (separation > best.separation) best = {separation, normal, a.edge, b.edge};
        }
    }
    return best;
}

// Calls visit(edge) for the edges at a vertex. Those of a hull are in order of their ends.
template <class Visitor>
void visit_edges_at(const PolytopeView& shape, std::uint16_t vertex, Visitor visit)
{
    if (!shape.guide) {
        for (std::size_t i = 0; i < shape.edges.size(); ++i)
            if (shape.edges[i].from == vertex || shape.edges[i].to == vertex) visit(i);
        return;
    }
    const std::uint32_t end = shape.neighbor_begin[vertex + 1u];
    for (std::uint32_t i = shape.neighbor_begin[vertex]; i < end; ++i) {
        const auto [from, to] = std::minmax(vertex, shape.neighbors[i]);
        const auto is_before = [](const Hull::Edge& edge,
                                  const std::array<std::uint16_t, 2>& ends) {
            return edge.from != ends[0] ? edge.from < ends[0] : edge.to < ends[1];
        };
        const auto at = std::lower_bound(shape.edges.begin(), shape.edges.end(),
                                         std::array<std::uint16_t, 2>{from, to}, is_before);
        visit(static_cast<std::size_t>(at - shape.edges.begin()));
    }
}

std::uint16_t face_against(const PolytopePair& pair, std::uint16_t vertex, const Vec3& normal)
{
    const Vec3 local = pair.turn.transpose() * normal;
    std::uint16_t best = 0;
    double most = 2;
    const auto look = [&](std::uint16_t face) {
        const double cosine = pair.b.normals[face].dot(local);
        const bool has_corners = pair.b.face_begin[face + 1u] > pair.b.face_begin[face] + 2;
        if (has_corners && (cosine < most || (cosine == most && face < best))) {
            most = cosine;
            best = face;
        }
    };
    visit_edges_at(pair.b, vertex, [&](std::size_t edge) {
        look(pair.b.edges[edge].left);
        look(pair.b.edges[edge].right);
    });
    return best;
}

// Room is left for the corners that cuts add; a face of very many corners is nearly round and keeps
// every few of them, and the one that is nearest to a's face wherever all others are further off by
// more than the slack: flat faces keep the same corners from step to step.
Polygon<double>
face_polygon(const PolytopePair& pair, std::uint16_t face, const FaceAxis& axis, double slack)
{
    const auto corners = pair.b.face(face);
    const std::size_t step = (corners.size() + kMaxCorners / 2 - 1) / (kMaxCorners / 2);
    const auto place = [&](std::size_t i) {
        return Vec3(pair.turn * pair.b.vertices[corners[i]] + pair.shift);
    };
    std::size_t nearest = corners.size();
    if (step > 1) {
        const Vec3& normal = pair.a.normals[axis.face];
        double least = std::numeric_limits<double>::max();
        for (std::size_t i = 0; i < corners.size(); i += step)
            least = std::min(least, normal.dot(place(i)) - pair.a.offsets[axis.face]);
        if (axis.separation < least - slack)
            nearest = static_cast<std::size_t>(
                std::find(corners.begin(), corners.end(), axis.vertex) - corners.begin());
    }
    Polygon<double> polygon;
    for (std::size_t i = 0; i < corners.size(); ++i)
        if (i % step == 0 || i == nearest)
            polygon.add(place(i), static_cast<std::uint16_t>(i % 2048));
    return polygon;
}

}  // namespace

PolytopePair::PolytopePair(const PolytopeView& shape_a,
                           const PolytopeView& shape_b,
                           const Pose& b_in_a)
    : a(shape_a), b(shape_b), turn(b_in_a.orientation.normalized().toRotationMatrix()),
      shift(b_in_a.position), offset(turn * shape_b.center + shift - shape_a.center)
{ }

PolytopePair PolytopePair::mirrored() const
{
    PolytopePair pair;
    pair.a = b;
    pair.b = a;
    pair.turn = turn.transpose();
    pair.shift = -(pair.turn * shift);
    pair.offset = -(pair.turn * offset);
    return pair;
}

double PolytopePair::noise() const
{
    return 1e-13
        * (a.center.norm() + a.outer_radius + b.center.norm() + b.outer_radius + shift.norm());
}

FaceAxis face_axis(const PolytopePair& pair, std::uint16_t face, std::uint16_t start)
{
    const Vec3& normal = pair.a.normals[face];
    const std::uint16_t vertex = support_vertex(pair.b, -(pair.turn.transpose() * normal), start);
    const double separation =
        normal.dot(pair.turn * pair.b.vertices[vertex] + pair.shift) - pair.a.offsets[face];
    return {separation, face, vertex};
}

FaceAxis likely_face_axis(const PolytopePair& pair)
{
    const Vec3 center_b = pair.turn * pair.b.center + pair.shift;
    std::size_t best = 0;
    double most = -std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < pair.a.normals.size(); ++i) {
        const double beyond = pair.a.normals[i].dot(center_b) - pair.a.offsets[i];
        if (beyond > most) {
            most = beyond;
            best = i;
        }
    }
    return face_axis(pair, static_cast<std::uint16_t>(best));
}

FaceAxis best_face_axis(const PolytopePair& pair, const FaceAxis& guess, double floor)
{
    FaceAxis best = guess;
    const double noise = pair.noise();
    const Vec3 center_b = pair.turn * pair.b.center + pair.shift;
    for (std::size_t i = 0; i < pair.a.normals.size(); ++i) {
        // No vertex of b can leave less room than the ball inside b does.
        const double bound =
            pair.a.normals[i].dot(center_b) - pair.a.offsets[i] - pair.b.inner_radius;
        if (bound + noise < std::max(best.separation, floor)) continue;
        const FaceAxis axis = face_axis(pair, static_cast<std::uint16_t>(i), best.vertex);
        const bool ties_lower = axis.separation == best.separation && axis.face < best.face;
        if (axis.separation > best.separation || ties_lower) best = axis;
    }
    return best;
}

EdgeAxis best_edge_axis(const PolytopePair& pair, double to_beat)
{
    thread_local Scratch scratch;
    const double noise = pair.noise();
    const auto collect_a = [&] {
        const Vec3 center_b = pair.offset + pair.a.center;
        collect_arcs(pair.a, center_b, to_beat + pair.b.inner_radius - noise, scratch.beyond,
                     scratch.arcs_a);
        return !scratch.arcs_a.empty();
    };
    const auto collect_b = [&] {
        const Vec3 center_a = pair.turn.transpose() * (pair.a.center - pair.shift);
        collect_arcs(pair.b, center_a, to_beat + pair.a.inner_radius - noise, scratch.beyond,
                     scratch.arcs_b);
        return !scratch.arcs_b.empty();
    };
    // Where the few are none, the many need not be looked at.
    const bool few_in_b = pair.b.edges.size() < pair.a.edges.size();
    if (few_in_b ? !collect_b() || !collect_a() : !collect_a() || !collect_b()) return {};
    turn_arcs(pair, scratch.arcs_b);
    return best_crossing(pair, scratch, to_beat);
}

FaceAxis best_face_axis_at(const PolytopePair& pair, std::uint16_t corner, std::uint16_t vertex)
{
    FaceAxis best;
    best.separation = -std::numeric_limits<double>::max();
    const auto look = [&](std::uint16_t face) {
        const FaceAxis axis = face_axis(pair, face, vertex);
        const bool ties_lower = axis.separation == best.separation && axis.face < best.face;
        if (axis.separation > best.separation || ties_lower) best = axis;
    };
    // Each face has two edges at the corner: it is the left one of one of them, seen from there.
    visit_edges_at(pair.a, corner, [&](std::size_t index) {
        const Hull::Edge& edge = pair.a.edges[index];
        look(edge.from == corner ? edge.left : edge.right);
    });
    return best;
}

EdgeAxis best_edge_axis_at(const PolytopePair& pair,
                           std::uint16_t corner_a,
                           std::uint16_t corner_b,
                           double to_beat)
{
    thread_local Scratch scratch;
    const auto collect = [](const PolytopeView& shape, std::uint16_t corner,
                            std::vector<Arc>& arcs) {
        arcs.clear();
        visit_edges_at(shape, corner,
                       [&](std::size_t edge) { arcs.push_back(arc_of(shape, edge)); });
        std::sort(arcs.begin(), arcs.end(),
                  [](const Arc& a, const Arc& b) { return a.edge < b.edge; });
    };
    collect(pair.a, corner_a, scratch.arcs_a);
    collect(pair.b, corner_b, scratch.arcs_b);
    turn_arcs(pair, scratch.arcs_b);
    return best_crossing(pair, scratch, to_beat);
}

void clip_faces(const PolytopePair& pair,
                const FaceAxis& axis,
                double speculative_margin,
                double slack,
                PolytopePoints& out)
{
    const std::uint16_t against = face_against(pair, axis.vertex, pair.a.normals[axis.face]);
    clip_faces(pair, axis, against, speculative_margin, slack, out);
}

void clip_faces(const PolytopePair& pair,
                const FaceAxis& axis,
                std::uint16_t against,
                double speculative_margin,
                double slack,
                PolytopePoints& out)
{
    const Vec3& normal = pair.a.normals[axis.face];
    Polygon<double> polygon = face_polygon(pair, against, axis, slack);
    const auto sides = pair.a.face(axis.face);
    for (std::size_t i = 0; i < sides.size() && polygon.count > 0; ++i) {
        const Vec3& from = pair.a.vertices[sides[i]];
        const Vec3& to = pair.a.vertices[sides[i + 1 == sides.size() ? 0 : i + 1]];
        const Vec3 side = (to - from).cross(normal).normalized();
        cut(polygon, side, side.dot(from), slack, static_cast<std::uint16_t>(2048 + i % 2048));
    }
    // Eight bits tell these two faces from others; the corner's own name has the other 24.
    const std::uint32_t faces = (axis.face * 31u + against * 17u) & 0x7f;
    for (int i = 0; i < polygon.count; ++i) {
        const Vec3& corner = polygon.corners[static_cast<std::size_t>(i)];
        const double separation = normal.dot(corner) - pair.a.offsets[axis.face];
        if (separation > speculative_margin) continue;
        out.least = out.count == 0 ? separation : std::min(out.least, separation);
        out.points[out.count++] = {corner - normal * (separation / 2), separation,
                                   polygon.corner_id(i) | faces << 24};
    }
}

void cross_edges(const PolytopePair& pair,
                 const EdgeAxis& axis,
                 double limit,
                 LocalManifold<double>& out)
{
    const Hull::Edge& edge_a = pair.a.edges[axis.edge_a];
    const Hull::Edge& edge_b = pair.b.edges[axis.edge_b];
    const Vec3& from_a = pair.a.vertices[edge_a.from];
    const Vec3 from_b = pair.turn * pair.b.vertices[edge_b.from] + pair.shift;
    const Vec3 along_a = pair.a.vertices[edge_a.to] - from_a;
    const Vec3 along_b = pair.turn * (pair.b.vertices[edge_b.to] - pair.b.vertices[edge_b.from]);

    // Closest points of the two lines, held to the edges; a cross product in place of the usual
    // determinant, which loses all its digits where edges are near parallel.
    const Vec3 between = from_b - from_a, cross = along_a.cross(along_b);
    const double at_a =
        std::clamp(between.cross(along_b).dot(cross) / cross.squaredNorm(), 0.0, 1.0);
    const Vec3 on_a = from_a + at_a * along_a;
    const double at_b = std::clamp((on_a - from_b).dot(along_b) / along_b.squaredNorm(), 0.0, 1.0);
    const Vec3 on_b = from_b + at_b * along_b;
    out.count = 0;
    if (axis.separation > 0 && (on_b - on_a).norm() > limit) return;
    out.normal = axis.normal;
    out.add((on_a + on_b) / 2, axis.separation,
            1u << 31 | (std::uint32_t{axis.edge_a} * 32749u + axis.edge_b) % 0x7fffffffu);
}

void turn_round(const PolytopePair& pair, LocalManifold<double>& out)
{
    out.normal = -(pair.turn * out.normal);
    for (int i = 0; i < out.count; ++i) {
        auto& point = out.points[static_cast<std::size_t>(i)];
        point.position = pair.turn * point.position + pair.shift;
        point.feature ^= 1u << 31;
    }
}

}  // namespace throng
