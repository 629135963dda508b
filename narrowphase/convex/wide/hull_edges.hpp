// Hull edges: pairs of edges whose common normal may part two polytopes, for the hull kernels.
#pragma once

#include "narrowphase/convex/wide/hull_faces.hpp"

namespace throng::THRONG_LANES {

// Square of the sine below which edges are parallel: their faces part the two as well within it.
constexpr float kParallel = 1e-10F;

struct EdgeAxis {
    float separation;
    int a = -1, b = -1;
    F3 normal{0, 0, 1};
};

// An edge that may take part: its direction, a point of it and its faces' normals.
struct Arc {
    F3 along, on, left, right;
    int edge;
};

// Arcs side by side, whole groups.
struct Arcs {
    int count = 0;
    int edge[kWideEdges];
    float number[12][kWideEdges];  // along, on, left, right

    // Another arc's place; those behind it, up to a whole group, are zero.
    int add()
    {
        if (count % kWideGroup == 0)
            for (auto& row : number)
                for (int i = 0; i < kWideGroup; i += L::kWidth) L(0.0F).store(row + count + i);
        return count++;
    }
    F3 get(int what, int i) const
    {
        return {number[3 * what][i], number[3 * what + 1][i], number[3 * what + 2][i]};
    }
    void put(int what, int i, F3 v)
    {
        number[3 * what][i] = v.x;
        number[3 * what + 1][i] = v.y;
        number[3 * what + 2][i] = v.z;
    }
};

// Whether any normal in an edge's arc leaves the point `far` beyond the edge, given how far it is
// beyond the faces. No branches: which way they went could not be foretold.
inline bool reaches(const Arc& arc, F3 point, float left, float right, float far, float slack)
{
    const float best = most(left, right);
    // The best normal may lie inside the arc: then it is straight away from the edge.
    const F3 across = cross(point - arc.on, arc.along);
    const bool bulges = (best >= 0) & (dot(across, across) >= far * far * 0.9999F)
        & (dot(across, arc.left) > -slack) & (dot(across, arc.right) < slack);
    return (best >= far) | bulges;
}

// Edges that may part the two by `far`.
inline void collect_arcs(const Side& side, const Bound& bound, float far, Arcs& arcs)
{
    const WidePolytope& self = side.self;
    const std::uint16_t *face_begin = self.face_begin(), *sides = self.sides();
    const float *leans = self.lean(), *first_beyond = bound.point_beyond[0];
    const float slack = 1e-5F * self.outer, far_of_center = far + bound.inner;
    // The normal between two faces that is furthest beyond is not far from one of them.
    const float part = far > 0 ? far : 0, rest = far - part;
    arcs.count = 0;
    for (int i = 0, count = self.faces; i < count; i += L::kWidth) {
        const L limit = L(part) * L::load(leans + i) + L(rest);
        for (unsigned there = bits_of(!(L::load(first_beyond + i) < limit)); there != 0;
             there &= there - 1) {
            const int face = i + __builtin_ctz(there);
            if (face >= count) break;
            for (int k = face_begin[face], end = face_begin[face + 1]; k < end; ++k) {
                const WideEdge& edge = self.edges[sides[k]];
                const Arc arc{along_of(edge), vertex_of(self, edge.from),
                              normal_of(self, edge.left), normal_of(self, edge.right), sides[k]};
                // Each once: by its left face, if that is seen too.
                const int left = edge.left, right = edge.right;
                const bool seen_left = !(first_beyond[left] < part * leans[left] + rest);
                bool passes = (face == left) | !seen_left;
                passes &= reaches(arc, side.center, bound.center_beyond[left],
                                  bound.center_beyond[right], far_of_center, slack);
                for (int n = 0; n < bound.points; ++n)
                    passes &= reaches(arc, bound.point[n], bound.point_beyond[n][left],
                                      bound.point_beyond[n][right], far, slack);
                if (!passes) continue;
                const int at = arcs.add();
                arcs.edge[at] = arc.edge;
                arcs.put(0, at, arc.along);
                arcs.put(1, at, arc.on);
                arcs.put(2, at, arc.left);
                arcs.put(3, at, arc.right);
            }
        }
    }
}

// b's arcs as a sees them, pointing the other way.
inline void turn_arcs(const Side& side, Arcs& arcs)
{
    const float* t = side.turn;
    for (int i = 0; i < arcs.count; i += L::kWidth) {
        for (int what = 0; what < 4; ++what) {
            const L x = L::load(arcs.number[3 * what] + i);
            const L y = L::load(arcs.number[3 * what + 1] + i);
            const L z = L::load(arcs.number[3 * what + 2] + i);
            const float* center = &side.center.x;
            for (int k = 0; k < 3; ++k) {
                L turned = L(t[3 * k]) * x + L(t[3 * k + 1]) * y + L(t[3 * k + 2]) * z;
                if (what == 1) turned += L(center[k]);
                if (what > 1) turned = -turned;
                turned.store(arcs.number[3 * what + k] + i);
            }
        }
    }
}

inline L dot_at(const Arcs& arcs, int what, int i, F3 v)
{
    return L(v.x) * L::load(arcs.number[3 * what] + i)
        + L(v.y) * L::load(arcs.number[3 * what + 1] + i)
        + L(v.z) * L::load(arcs.number[3 * what + 2] + i);
}

// Of b's arcs from i on, those that cross an arc of a on the sphere of directions, as bits.
inline unsigned crossing(const Arc& a, const Arcs& arcs_b, int i)
{
    const L zero = 0.0F;
    const L left_b = dot_at(arcs_b, 2, i, a.along), right_b = dot_at(arcs_b, 3, i, a.along);
    const L left_a = dot_at(arcs_b, 0, i, a.left), right_a = dot_at(arcs_b, 0, i, a.right);
    return bits_of((left_b * right_b < zero) & (left_a * right_a < zero)
                   & (left_b * right_a > zero));
}

// The axis of two edges that cross, if it is better; ties go to the first pair.
inline void try_edges(const Side& side, const Arc& a, const Arc& b, float noise, EdgeAxis& best)
{
    const F3 across = cross(a.along, b.along);
    const float length2 = dot(across, across);
    if (length2 < kParallel) return;
    F3 normal = across * (1 / root(length2));
    if (dot(normal, a.left + a.right) < 0) normal = -normal;
    // No vertex is further along it than its edge, but for rounding.
    if (dot(normal, b.on - a.on) < best.separation - noise) return;
    const float separation = dot(normal, side.center) + lowest(side.other, side.to_other(normal))
        + lowest(side.self, -normal);
    const bool first = a.edge != best.a ? a.edge < best.a : b.edge < best.b;
    if (separation < best.separation || (separation == best.separation && !first)) return;
    best.separation = separation;
    best.a = a.edge;
    best.b = b.edge;
    best.normal = normal;
}

inline Arc arc_at(const Arcs& arcs, int i)
{
    return {arcs.get(0, i), arcs.get(1, i), arcs.get(2, i), arcs.get(3, i), arcs.edge[i]};
}

// The points of two edges nearest to one another, in a's frame.
inline void
nearest_points(const Side& by_a, const WideEdge& edge_a, const WideEdge& edge_b, F3& on_a, F3& on_b)
{
    const WidePolytope &a = by_a.self, &b = by_a.other;
    const F3 from_a = vertex_of(a, edge_a.from), along_a = along_of(edge_a);
    const F3 from_b = by_a.from_other(vertex_of(b, edge_b.from)) + by_a.center;
    const F3 along_b = by_a.from_other(along_of(edge_b));
    const F3 span_a = vertex_of(a, edge_a.to) - from_a;
    const F3 span_b = vertex_of(b, edge_b.to) - vertex_of(b, edge_b.from);

    // Closest points of the two lines, held to the edges.
    const F3 between = from_b - from_a, across = cross(along_a, along_b);
    const float at_a = dot(cross(between, along_b), across) / dot(across, across);
    on_a = from_a + along_a * most(0, least(at_a, dot(span_a, along_a)));
    const float at_b = dot(on_a - from_b, along_b);
    on_b = from_b + along_b * most(0, least(at_b, root(dot(span_b, span_b))));
}

}  // namespace throng::THRONG_LANES
