// The incident face of one box clipped against the leading face of the other, W pairs side by side.
#include "narrowphase/convex/wide/box_spread_lanes.hpp"

namespace throng::THRONG_LANES {

namespace {

// The pair as the leading box sees it: its leading axis first (w), the other two after it in turn
// (u, v). Columns of turn: the incident box's axes, that of its incident face first.
struct FacePair {
    Floats lead[3], incident[3], center[3], turn[3][3];
    Floats axis[3][3];  // rows: w, u and v in a's frame
    Floats origin[3];   // the leading box's center in a's frame
    Mask b_leads;
    Floats sign;  // of the leading face along w
    Ints names;   // of the two faces, above the six bits of a place's lines

    FacePair(const BoxLanes& pair, Ints face)
    {
        b_leads = face > Ints(2);
        const Ints leading = select(b_leads, face - Ints(3), face);
        Floats seen[3][3];
        see_from_leader(pair, equal(leading, 0), equal(leading, 1), seen);
        sign = sign_of(center[0]);
        const Ints facing = put_incident_first(pair, seen);
        names = (facing + (leading + leading + one_if(sign > Floats(0.f))) * Ints(8)) * Ints(64)
            + select(b_leads, Ints(1 << 12), Ints(0));
    }

private:
    static Ints one_if(Mask mask) { return select(mask, Ints(1), Ints(0)); }

    // Row r of `seen` belongs to the leading box's axis (leading + r) % 3; columns: the other's.
    void see_from_leader(const BoxLanes& pair, Mask at0, Mask at1, Floats (&seen)[3][3])
    {
        const auto& of_a = pair.turn;
        const Floats one = 1.f, zero = 0.f;
        for (int r = 0; r < 3; ++r) {
            const int r1 = (r + 1) % 3, r2 = (r + 2) % 3;
            Floats of_b[3];
            for (int k = 0; k < 3; ++k) {
                of_b[k] = pick(at0, at1, of_a[k][r], of_a[k][r1], of_a[k][r2]);
                seen[r][k] =
                    select(b_leads, of_b[k], pick(at0, at1, of_a[r][k], of_a[r1][k], of_a[r2][k]));
                const Floats unit =
                    pick(at0, at1, k == r ? one : zero, k == r1 ? one : zero, k == r2 ? one : zero);
                axis[r][k] = select(b_leads, of_b[k], unit);
            }
            center[r] = select(b_leads, -dot(of_b, pair.center),
                               pick(at0, at1, pair.center[r], pair.center[r1], pair.center[r2]));
            const auto half = [&](int k) {
                return select(b_leads, pair.half_b[k], pair.half_a[k]);
            };
            lead[r] = pick(at0, at1, half(r), half(r1), half(r2));
            origin[r] = select(b_leads, pair.center[r], zero);
        }
    }

    // The incident face is the one most against the leading one. Returns its name.
    Ints put_incident_first(const BoxLanes& pair, const Floats (&seen)[3][3])
    {
        const Floats size0 = abs(seen[0][0]), size1 = abs(seen[0][1]), size2 = abs(seen[0][2]);
        const Mask second = size1 > size0, third = size2 > max(size0, size1);
        const Ints k = select(third, Ints(2), one_if(second));
        const Mask at0 = equal(k, 0), at1 = equal(k, 1);
        for (int c = 0; c < 3; ++c) {
            const int c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            const auto half = [&](int i) {
                return select(b_leads, pair.half_a[i], pair.half_b[i]);
            };
            incident[c] = pick(at0, at1, half(c), half(c1), half(c2));
            for (int r = 0; r < 3; ++r)
                turn[r][c] = pick(at0, at1, seen[r][c], seen[r][c1], seen[r][c2]);
        }
        const Mask against = turn[0][0] * sign > Floats(0.f);
        incident[0] = select(against, -incident[0], incident[0]);
        return k + k + select(against, Ints(0), Ints(1));
    }
};

// The incident face's corners, as far as they are from the leading face.
void corners_of(const FacePair& pair, Spot (&corner)[4])
{
    Floats at[4][3];
    for (int r = 0; r < 3; ++r) {
        const Floats middle = pair.center[r] + pair.incident[0] * pair.turn[r][0];
        const Floats p = pair.incident[1] * pair.turn[r][1], q = pair.incident[2] * pair.turn[r][2];
        at[0][r] = middle + p + q;
        at[1][r] = middle - p + q;
        at[2][r] = middle - p - q;
        at[3][r] = middle + p - q;
    }
    for (int k = 0; k < 4; ++k)
        corner[k] = {at[k][1], at[k][2], pair.sign * at[k][0] - pair.lead[0]};
}

// The chosen places in their order, in a's frame; count: how many.
void gather_points(
    const FacePair& pair, const Places& places, Ints chosen, PointLanes (&point)[4], Ints& count)
{
    Spot spot[4];
    Ints lines[4];
    // From the last on, each pushing those after it one further.
#pragma GCC unroll 12
    for (int k = kPlaces - 1; k >= 0; --k) {
        const Mask takes = equal(chosen.v & Ints(1 << k).v, 1 << k);
        for (int i = 3; i >= 0; --i) {
            const Spot next =
                i > 0 ? spot[i - 1] : Spot{places.u[k], places.v[k], places.separation[k]};
            spot[i] = {select(takes, next.u, spot[i].u), select(takes, next.v, spot[i].v),
                       select(takes, next.separation, spot[i].separation)};
            lines[i] = select(takes, i > 0 ? lines[i - 1] : places.lines[k], lines[i]);
        }
        count = count + select(takes, Ints(1), Ints(0));
    }
    for (int i = 0; i < 4; ++i) {
        // Midway between the faces.
        const Floats w = pair.sign * (pair.lead[0] + spot[i].separation * 0.5f);
        for (int r = 0; r < 3; ++r)
            point[i].at[r] = pair.axis[0][r] * w + pair.axis[1][r] * spot[i].u
                + pair.axis[2][r] * spot[i].v + pair.origin[r];
        point[i].separation = spot[i].separation;
        point[i].feature = lines[i] + pair.names;
    }
}

void clip_lanes(
    const BoxPair* pairs, const BoxList& faces, std::int32_t from, BoxList& edges, float* manifolds)
{
    const AxesLanes axes(faces, from);
    const BoxLanes boxes(pairs, axes.pair);
    const FacePair pair(boxes, axes.face);
    Spot corner[4];
    corners_of(pair, corner);
    Places places;
    Clipper(pair.lead[1], pair.lead[2], least_of(pair.lead) * kFaceBias).cut(corner, places);

    Floats least = 3e38f;
    Ints there{}, count{};
    for (int k = 0; k < kPlaces; ++k) {
        places.there[k] = but_not(places.there[k], places.separation[k] > boxes.speculative_margin);
        least = select(places.there[k], min(places.separation[k], least), least);
        there = there + select(places.there[k], Ints(1 << k), Ints(0));
        count = count + select(places.there[k], Ints(1), Ints(0));
    }

    // A face that has lost its deepest corner over the other's side still tells the depth, if what
    // is left of it agrees with the edges. Otherwise clipping has lost the very place of touch.
    const Floats twice_bias = boxes.bias() * 2.f;
    const Mask has_edge = axes.edge < Ints(kNoEdge);
    const Mask same = both(has_edge, axes.alike > Ints(0));
    const Mask edge_better =
        both(has_edge, axes.edge_separation > axes.face_separation + boxes.bias());
    const Mask deep_enough = either(no(axes.face_separation < Floats(0.f)),
                                    no(least > axes.face_separation + twice_bias));
    const Mask kept = but_not(deep_enough, edge_better);
    const Mask agrees = but_not(same, abs(least - axes.edge_separation) > twice_bias);
    const unsigned at_edges = bits(but_not(has_edge, either(kept, agrees))) & axes.used;
    if (at_edges != 0) append(edges, axes.numbers, at_edges);

    const unsigned writes = axes.used & ~at_edges;
    const Mask many = count > Ints(4);
    if ((bits(many) & writes) != 0) there = select(many, Spread::four_of(places, pair.sign), there);
    PointLanes point[4];
    Ints points{};
    gather_points(pair, places, there, point, points);
    const Floats outward = select(pair.b_leads, -pair.sign, pair.sign);
    const Floats normal[3] = {outward * pair.axis[0][0], outward * pair.axis[0][1],
                              outward * pair.axis[0][2]};
    write_manifolds(normal, point, points, axes.pair, writes, manifolds);
}

}  // namespace

void clip_boxes(const BoxPair* pairs, const BoxList& faces, BoxList& edges, float* manifolds);
void clip_boxes(const BoxPair* pairs, const BoxList& faces, BoxList& edges, float* manifolds)
{
    for (std::int32_t from = 0; from < faces.count; from += kWidth)
        clip_lanes(pairs, faces, from, edges, manifolds);
}

}  // namespace throng::THRONG_LANES
