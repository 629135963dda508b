// Box clip: a parallelogram cut to a rectangle, W of them side by side and without branches.
//
// All in the rectangle's own frame: u and v along its sides, and with each point how far it lies
// from the rectangle's plane. What is left has fixed places: two for each edge of the
// parallelogram, where it enters the rectangle and where it leaves it, and one for each of the
// rectangle's corners.
#pragma once

#include "narrowphase/convex/wide/box_lanes.hpp"

namespace throng::THRONG_LANES {

constexpr int kPlaces = 12;

// Points in the plane. Lines that meet there, 3 bits each in the order of going round: 0 to 3 the
// parallelogram's edges, 4 and 5 the sides u = half and u = -half, 6 and 7 those of v.
struct Places {
    Floats u[kPlaces], v[kPlaces], separation[kPlaces];
    Ints lines[kPlaces];
    Mask there[kPlaces];
};

struct Spot {
    Floats u, v, separation;
};

// Two opposite sides of the rectangle. Corners up to the slack beyond stay as they are, so that
// they do not come and go with rounding.
struct Slab {
    Floats half, limit;

    Slab(Floats extent, Floats slack) : half(extent), limit(extent + slack) { }
    Mask above(Floats x) const { return x > limit; }
    Mask below(Floats x) const { return x < -limit; }
    Floats at_side(Floats x) const { return sign_of(x) * half; }
    // What part of the way from `out`, beyond the limit, to `in` the side is: also where `in` lies
    // beyond it within the slack.
    Floats part(Floats out, Floats in) const
    {
        const Floats beyond = abs(out) - half;
        return clamp(beyond / (beyond - (sign_of(out) * in - half)), Floats(0.f), Floats(1.f));
    }
};

inline Floats on_the_way(Floats from, Floats to, Floats part) { return from + part * (to - from); }

class Clipper {
public:
    Clipper(Floats half_u, Floats half_v, Floats slack) : u_(half_u, slack), v_(half_v, slack) { }

    // The corners in order.
    void cut(const Spot (&corner)[4], Places& out)
    {
        add_edge<0>(corner[0], corner[1], out);
        add_edge<1>(corner[1], corner[2], out);
        add_edge<2>(corner[2], corner[3], out);
        add_edge<3>(corner[3], corner[0], out);
        add_corner<8>(high_, u_.half, Floats(1.f), 4, 6, out);
        add_corner<9>(high_, u_.half, Floats(-1.f), 4, 7, out);
        add_corner<10>(low_, -u_.half, Floats(1.f), 5, 6, out);
        add_corner<11>(low_, -u_.half, Floats(-1.f), 5, 7, out);
    }

private:
    // Where the polygon leaves by one side of u and comes back.
    struct Side {
        Spot leaves, enters;
        Mask there{};
    };

    static void note(Side& side, Mask from_out, Mask to_out, const Spot& from, const Spot& to)
    {
        const Mask leaves = but_not(to_out, from_out), enters = but_not(from_out, to_out);
        side.leaves.v = select(leaves, to.v, side.leaves.v);
        side.leaves.separation = select(leaves, to.separation, side.leaves.separation);
        side.enters.v = select(enters, from.v, side.enters.v);
        side.enters.separation = select(enters, from.separation, side.enters.separation);
        side.there = either(side.there, leaves);
    }

    // First cut to u, then what is left to v.
    template <int e>
    void add_edge(const Spot& from, const Spot& to, Places& out)
    {
        const Mask from_high = u_.above(from.u), from_low = u_.below(from.u);
        const Mask to_high = u_.above(to.u), to_low = u_.below(to.u);
        const Mask from_out = either(from_high, from_low), to_out = either(to_high, to_low);
        const Spot a = cut_u(from_out, from, to), b = cut_u(to_out, to, from);
        note(high_, from_high, to_high, a, b);
        note(low_, from_low, to_low, a, b);

        const Mask a_high = v_.above(a.v), a_low = v_.below(a.v);
        const Mask b_high = v_.above(b.v), b_low = v_.below(b.v);
        const Mask a_out = either(a_high, a_low), b_out = either(b_high, b_low);
        cut_v<2 * e>(a_out, a, b, out);
        cut_v<2 * e + 1>(b_out, b, a, out);

        constexpr int kBefore = (e + 3) % 4;
        const Ints enters_u =
            pick(from_high, from_low, Ints(4 + 8 * e), Ints(5 + 8 * e), Ints(kBefore + 8 * e));
        out.lines[2 * e] = pick(a_high, a_low, Ints(6 + 8 * e), Ints(7 + 8 * e), enters_u);
        const Ints leaves_u = select(to_high, Ints(e + 8 * 4), Ints(e + 8 * 5));
        out.lines[2 * e + 1] = pick(b_high, b_low, Ints(e + 8 * 6), Ints(e + 8 * 7), leaves_u);

        // An edge that ends at a corner leaves it to the next edge.
        const Mask gone = either(either(both(from_high, to_high), both(from_low, to_low)),
                                 either(both(a_high, b_high), both(a_low, b_low)));
        out.there[2 * e] = no(gone);
        out.there[2 * e + 1] = but_not(either(to_out, b_out), gone);
    }

    Spot cut_u(Mask out, const Spot& from, const Spot& to) const
    {
        const Floats part = u_.part(from.u, to.u);
        return {select(out, u_.at_side(from.u), from.u),
                select(out, on_the_way(from.v, to.v, part), from.v),
                select(out, on_the_way(from.separation, to.separation, part), from.separation)};
    }
    template <int place>
    void cut_v(Mask is_out, const Spot& from, const Spot& to, Places& out) const
    {
        const Floats part = v_.part(from.v, to.v);
        out.u[place] = select(is_out, on_the_way(from.u, to.u, part), from.u);
        out.v[place] = select(is_out, v_.at_side(from.v), from.v);
        out.separation[place] =
            select(is_out, on_the_way(from.separation, to.separation, part), from.separation);
    }

    // The rectangle's corner at one end of a side of u: there where the polygon leaves by the side
    // on this side of it and comes back beyond it, or the other way round.
    template <int place>
    void add_corner(
        const Side& side, Floats at_u, Floats sign_v, int line_u, int line_v, Places& out) const
    {
        const Floats leaves = side.leaves.v * sign_v, enters = side.enters.v * sign_v;
        const Mask leaves_out = leaves > v_.limit, enters_out = enters > v_.limit;
        const Floats beyond = leaves - v_.half;
        const Floats part = clamp(beyond / (beyond - (enters - v_.half)), Floats(0.f), Floats(1.f));
        out.u[place] = at_u;
        out.v[place] = sign_v * v_.half;
        out.separation[place] = on_the_way(side.leaves.separation, side.enters.separation, part);
        out.lines[place] = select(leaves_out, Ints(line_v + 8 * line_u), Ints(line_u + 8 * line_v));
        out.there[place] = both(side.there, leaves_out ^ enters_out);
    }

    Slab u_, v_;
    Side high_, low_;
};

}  // namespace throng::THRONG_LANES
