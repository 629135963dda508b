// The fifteen axes of W pairs of boxes, all of them for every pair.
#include "narrowphase/convex/wide/box_lanes.hpp"

namespace throng::THRONG_LANES {

namespace {

// Square of the sine below which two edges count as parallel. Their common normal could point
// anywhere by then, and the faces beside the edges part the boxes as well to within this sine.
constexpr float kParallel = 1e-8f;

// Cosine below which an edge's normal is no stand-in for a face's: a fiftieth of a radian. Boxes
// that lie on one another a little askew, one over the other's side, touch at an edge but rest on
// the face.
constexpr float kAlike = 0.9998f;

struct BestFace {
    Floats separation;
    Ints index;

    void try_axis(Floats other, int other_index)
    {
        const auto better = other > separation;
        separation = max(other, separation);
        index = select(better, Ints(other_index), index);
    }
};

struct BestEdge {
    Floats separation;  // times its length
    Floats length2;
    Floats square;  // of the separation, times length2; negative where the separation is
    Ints index;

    // Separations compared by their squares, each times both axes' squared lengths: no root and no
    // quotient but in the end.
    void try_axis(Floats other, Floats other_length2, int other_index)
    {
        const Floats other_square = other * abs(other);
        const Mask better = both(other_length2 > Floats(kParallel),
                                 other_square * length2 > square * other_length2);
        separation = select(better, other, separation);
        length2 = select(better, other_length2, length2);
        square = select(better, other_square, square);
        index = select(better, Ints(other_index), index);
    }
};

struct Axes {
    const BoxLanes& pair;
    Floats abs_turn[3][3];

    explicit Axes(const BoxLanes& boxes) : pair(boxes)
    {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) abs_turn[i][j] = abs(pair.turn[i][j]);
    }
    Floats face_of_a(int i) const
    {
        return abs(pair.center[i]) - (pair.half_a[i] + dot(abs_turn[i], pair.half_b));
    }
    Floats face_of_b(int j) const
    {
        const Floats axis[3] = {pair.turn[0][j], pair.turn[1][j], pair.turn[2][j]};
        const Floats size[3] = {abs_turn[0][j], abs_turn[1][j], abs_turn[2][j]};
        return abs(dot(axis, pair.center)) - (pair.half_b[j] + dot(size, pair.half_a));
    }
    // Every term uses the very axis that was rounded, so that near-parallel edges, whose axis is
    // short and coarse, still get the true answer for that axis.
    void try_edges(int i, int j, BestEdge& best) const
    {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        const auto& turn = pair.turn;
        const Floats x = -turn[i2][j], y = turn[i1][j];
        const Floats along = abs(x * pair.center[i1] + y * pair.center[i2]);
        const Floats extent_a =
            pair.half_a[i1] * abs_turn[i2][j] + pair.half_a[i2] * abs_turn[i1][j];
        const Floats extent_b = pair.half_b[j1] * abs(x * turn[i1][j1] + y * turn[i2][j1])
            + pair.half_b[j2] * abs(x * turn[i1][j2] + y * turn[i2][j2]);
        best.try_axis(along - (extent_a + extent_b), x * x + y * y, 6 + 3 * i + j);
    }
};

// Whether the best edges' normal is all but the leading face's; both from a to b.
Mask alike(const BoxLanes& pair, Ints face, const BestEdge& edge)
{
    // The edges' normal is a's edge i across b's edge j.
    const Ints of_b = edge.index - Ints(6);
    const Mask i0 = of_b < Ints(3), i1 = of_b < Ints(6);
    const Ints j = of_b - pick(i0, i1, Ints(0), Ints(3), Ints(6));
    const Mask j0 = equal(j, 0), j1 = equal(j, 1);
    Floats along_b[3];
    for (int k = 0; k < 3; ++k)
        along_b[k] = pick(j0, j1, pair.turn[k][0], pair.turn[k][1], pair.turn[k][2]);
    const Floats zero = 0.f;
    const Floats normal[3] = {pick(i0, i1, zero, along_b[2], -along_b[1]),
                              pick(i0, i1, -along_b[2], zero, along_b[0]),
                              pick(i0, i1, along_b[1], -along_b[0], zero)};

    const Mask of_a = face < Ints(3);
    const Ints axis = select(of_a, face, face - Ints(3));
    const Mask axis0 = equal(axis, 0), axis1 = equal(axis, 1);
    const Floats one = 1.f;
    const Floats unit[3] = {pick(axis0, axis1, one, zero, zero),
                            pick(axis0, axis1, zero, one, zero),
                            pick(axis0, axis1, zero, zero, one)};
    Floats leading[3];
    for (int k = 0; k < 3; ++k)
        leading[k] = select(of_a, unit[k],
                            pick(axis0, axis1, pair.turn[k][0], pair.turn[k][1], pair.turn[k][2]));
    const Floats turned = sign_of(dot(normal, pair.center)) * sign_of(dot(leading, pair.center));
    return dot(normal, leading) * turned > Floats(kAlike) * sqrt(edge.length2);
}

// One group of lanes, from pair `from` on.
void part_lanes(
    const BoxPair* pairs, std::int32_t from, std::int32_t count, BoxList& faces, BoxList& edges)
{
    std::int32_t index[kWidth];
    Ints place;
    for (int i = 0; i < kWidth; ++i) {
        index[i] = from + i < count ? from + i : count - 1;
        place.set(i, from + i);
    }
    unsigned left = first_lanes(count - from);
    const BoxLanes pair(pairs, index);
    const Axes axes(pair);

    BestFace of_a{axes.face_of_a(0), Ints(0)}, of_b{axes.face_of_b(0), Ints(3)};
    for (int i = 1; i < 3; ++i) {
        of_a.try_axis(axes.face_of_a(i), i);
        of_b.try_axis(axes.face_of_b(i), 3 + i);
    }
    const Floats top = max(of_a.separation, of_b.separation);
    left &= ~bits(top > pair.speculative_margin);
    if (left == 0) return;

    const Floats one = 1.f;
    BestEdge edge{top, one, top * abs(top), Ints(kNoEdge)};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) axes.try_edges(i, j, edge);
    const Mask has_edge = edge.index < Ints(kNoEdge);
    const Floats edge_separation = edge.separation / sqrt(edge.length2);
    left &= ~bits(both(has_edge, edge_separation > pair.speculative_margin));
    if (left == 0) return;

    // b's face leads only where it is clearly better, for the same reason as any face does.
    const Floats bias = pair.bias();
    const Mask b_leads = of_b.separation > of_a.separation + bias;
    const Floats face_separation = select(b_leads, of_b.separation, of_a.separation);
    const Ints face = select(b_leads, of_b.index, of_a.index);
    const Mask same = both(has_edge, alike(pair, face, edge));
    const unsigned at_edges =
        bits(but_not(both(has_edge, edge_separation > face_separation + bias), same));

    const Floats numbers[8] = {as_floats(place),      as_floats(face),
                               as_floats(edge.index), as_floats(select(same, Ints(1), Ints(0))),
                               face_separation,       edge_separation,
                               Floats(0.f),           Floats(0.f)};
    append(faces, numbers, left & ~at_edges);
    append(edges, numbers, left & at_edges);
}

void part(const BoxPair* pairs, std::int32_t count, BoxList& faces, BoxList& edges)
{
    for (std::int32_t from = 0; from < count; from += kWidth)
        part_lanes(pairs, from, count, faces, edges);
}

}  // namespace

void clip_boxes(const BoxPair* pairs, const BoxList& faces, BoxList& edges, float* manifolds);
void cross_boxes(const BoxPair* pairs, const BoxList& edges, float* manifolds);

extern const BoxKernels kBoxes;
const BoxKernels kBoxes = {THRONG_LANES_NAME, kWidth, part, clip_boxes, cross_boxes};

}  // namespace throng::THRONG_LANES
