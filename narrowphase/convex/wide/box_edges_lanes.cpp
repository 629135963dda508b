// The place where an edge of one box crosses an edge of the other, W pairs side by side.
#include "narrowphase/convex/wide/box_lanes.hpp"

namespace throng::THRONG_LANES {

namespace {

// The pair with a's edge i along the first row and b's edge j along the first column; the other
// axes after them in turn.
struct EdgePair {
    Floats half_a[3], half_b[3], center[3], turn[3][3];
    Mask i0, i1, j0, j1;

    EdgePair(const BoxLanes& pair, Ints edge)
    {
        const Ints code = edge - Ints(6);
        i0 = code < Ints(3), i1 = code < Ints(6);
        const Ints j = code - pick(i0, i1, Ints(0), Ints(3), Ints(6));
        j0 = equal(j, 0), j1 = equal(j, 1);
        for (int r = 0; r < 3; ++r) {
            const int r1 = (r + 1) % 3, r2 = (r + 2) % 3;
            half_a[r] = pick(i0, i1, pair.half_a[r], pair.half_a[r1], pair.half_a[r2]);
            half_b[r] = pick(j0, j1, pair.half_b[r], pair.half_b[r1], pair.half_b[r2]);
            center[r] = pick(i0, i1, pair.center[r], pair.center[r1], pair.center[r2]);
            Floats row[3];
            for (int c = 0; c < 3; ++c)
                row[c] = pick(i0, i1, pair.turn[r][c], pair.turn[r1][c], pair.turn[r2][c]);
            for (int c = 0; c < 3; ++c)
                turn[r][c] = pick(j0, j1, row[c], row[(c + 1) % 3], row[(c + 2) % 3]);
        }
    }
    // Back to a's own axes.
    void put_back(const Floats (&from)[3], Floats (&to)[3]) const
    {
        to[0] = pick(i0, i1, from[0], from[2], from[1]);
        to[1] = pick(i0, i1, from[1], from[0], from[2]);
        to[2] = pick(i0, i1, from[2], from[1], from[0]);
    }
    // Bit `first` + k for a's axis k, where k is the r-th after the edge's; and for b's.
    Ints bit_a(Mask set, int first, int r) const { return bit(set, i0, i1, first, r); }
    Ints bit_b(Mask set, int first, int r) const { return bit(set, j0, j1, first, r); }

private:
    static Ints bit(Mask set, Mask at0, Mask at1, int first, int r)
    {
        const Ints place = pick(at0, at1, Ints(1 << (first + r)), Ints(1 << (first + (r + 1) % 3)),
                                Ints(1 << (first + (r + 2) % 3)));
        return select(set, place, Ints(0));
    }
};

void cross_lanes(const BoxPair* pairs, const BoxList& edges, std::int32_t from, float* manifolds)
{
    const AxesLanes axes(edges, from);
    const BoxLanes boxes(pairs, axes.pair);
    const EdgePair pair(boxes, axes.edge);
    const auto& turn = pair.turn;
    const Floats zero = 0.f;

    // a's edge, the first axis, across b's.
    const Floats sine2 = turn[2][0] * turn[2][0] + turn[1][0] * turn[1][0];
    const Floats sine = sqrt(sine2);
    Floats normal[3] = {zero, -turn[2][0] / sine, turn[1][0] / sine};
    const Mask turned = dot(normal, pair.center) < zero;
    for (Floats& n : normal) n = select(turned, -n, n);

    // The middles of a's furthest edge along the normal, and of b's furthest against it.
    Ints feature = axes.edge + Ints(std::int32_t(0x80000000u));
    Floats on_a[3], on_b[3] = {pair.center[0], pair.center[1], pair.center[2]};
    on_a[0] = zero;
    for (int r = 1; r < 3; ++r) {
        const Mask low = normal[r] < zero;
        on_a[r] = select(low, -pair.half_a[r], pair.half_a[r]);
        feature = feature + pair.bit_a(low, 8, r);
        const Floats axis[3] = {turn[0][r], turn[1][r], turn[2][r]};
        const Mask below = dot(normal, axis) > zero;
        const Floats extent = select(below, -pair.half_b[r], pair.half_b[r]);
        for (int k = 0; k < 3; ++k) on_b[k] += extent * axis[k];
        feature = feature + pair.bit_b(below, 12, r);
    }
    // Closest points of the two lines, held to the edges.
    const Floats along_b[3] = {turn[0][0], turn[1][0], turn[2][0]};
    const Floats between[3] = {on_b[0] - on_a[0], on_b[1] - on_a[1], on_b[2] - on_a[2]};
    const Floats cosine = along_b[0], da = between[0], db = dot(between, along_b);
    const Floats at_a = clamp((da - cosine * db) / sine2, -pair.half_a[0], pair.half_a[0]);
    const Floats at_b = clamp(cosine * at_a - db, -pair.half_b[0], pair.half_b[0]);
    on_a[0] = at_a;
    Floats middle[3], distance2 = zero;
    for (int k = 0; k < 3; ++k) {
        on_b[k] += at_b * along_b[k];
        const Floats apart = on_b[k] - on_a[k];
        distance2 += apart * apart;
        middle[k] = (on_a[k] + on_b[k]) * 0.5f;
    }

    // Boxes that are apart may have their closest points elsewhere: these two then pass each other
    // by and there is nothing to hold.
    const Floats limit = boxes.speculative_margin + boxes.bias();
    const unsigned pass_by = bits(both(axes.edge_separation > zero, distance2 > limit * limit));
    PointLanes point[4];
    pair.put_back(middle, point[0].at);
    point[0].separation = axes.edge_separation;
    point[0].feature = feature;
    Floats out_normal[3];
    pair.put_back(normal, out_normal);
    write_manifolds(out_normal, point, Ints(1), axes.pair, axes.used & ~pass_by, manifolds);
}

}  // namespace

void cross_boxes(const BoxPair* pairs, const BoxList& edges, float* manifolds);
void cross_boxes(const BoxPair* pairs, const BoxList& edges, float* manifolds)
{
    for (std::int32_t from = 0; from < edges.count; from += kWidth)
        cross_lanes(pairs, edges, from, manifolds);
}

}  // namespace throng::THRONG_LANES
