// Box spread: the best four of the points that clipping left, W manifolds side by side; the rules
// of contact_points.hpp, in the plane of the leading face.
#pragma once

#include "narrowphase/convex/wide/box_clip_lanes.hpp"

namespace throng::THRONG_LANES {

// A place that was chosen: its bit, and where it is.
struct Chosen {
    Ints bit{};
    Spot spot;
};

class Spread {
public:
    // sign: of the leading face's normal, which decides the direction that is looked in first.
    // Returns the bits of the chosen places.
    static Ints four_of(const Places& places, Floats sign)
    {
        const Spread spread(places);
        // A slanted direction, so that rectangles along the axes have one furthest corner.
        const Chosen one = spread.best([&](const Spot& p) { return sign * p.v - p.u * 0.3f; });
        const Chosen two = spread.best([&](const Spot& p) { return distance2(p, one.spot); });
        const Floats du = two.spot.u - one.spot.u, dv = two.spot.v - one.spot.v;
        const auto beside = [&](const Spot& p) {
            return du * (p.v - one.spot.v) - dv * (p.u - one.spot.u);
        };
        const Chosen three = spread.best([&](const Spot& p) { return abs(beside(p)); });
        const Floats turn = sign_of(beside(three.spot));
        const Chosen four = spread.best(OutsideTriangle(one.spot, two.spot, three.spot, turn));
        return spread.with_deepest(one, two, three, four);
    }

private:
    explicit Spread(const Places& places) : places_(places) { }

    // Positions are midway between the surfaces, so half of a difference in depth counts.
    static Floats distance2(const Spot& p, const Spot& q)
    {
        const Floats du = p.u - q.u, dv = p.v - q.v;
        const Floats dw = (p.separation - q.separation) * 0.5f;
        return du * du + dv * dv + dw * dw;
    }

    // By how much a point adds to the triangle.
    struct OutsideTriangle {
        Floats u[3], v[3], edge_u[3], edge_v[3];

        OutsideTriangle(const Spot& a, const Spot& b, const Spot& c, Floats turn)
            : u{a.u, b.u, c.u}, v{a.v, b.v, c.v}
        {
            for (int i = 0; i < 3; ++i) {
                edge_u[i] = turn * (u[(i + 1) % 3] - u[i]);
                edge_v[i] = turn * (v[(i + 1) % 3] - v[i]);
            }
        }
        Floats operator()(const Spot& p) const
        {
            Floats most = 0.f;
            for (int i = 0; i < 3; ++i)
                most = max(edge_v[i] * (p.u - u[i]) - edge_u[i] * (p.v - v[i]), most);
            return most;
        }
    };

    // The first of those with the highest score.
    template <class Score>
    Chosen best(const Score& score) const
    {
        Chosen result;
        Floats highest = -3e38f;
#pragma GCC unroll 12
        for (int k = 0; k < kPlaces; ++k) {
            const Spot spot = {places_.u[k], places_.v[k], places_.separation[k]};
            const Floats value = score(spot);
            const Mask better = both(places_.there[k], value > highest);
            highest = select(better, value, highest);
            result.bit = select(better, Ints(1 << k), result.bit);
            result.spot = {select(better, spot.u, result.spot.u),
                           select(better, spot.v, result.spot.v),
                           select(better, spot.separation, result.spot.separation)};
        }
        return result;
    }

    // Where the deepest is left out, it takes the place of the chosen one nearest to it.
    Ints with_deepest(const Chosen& one,
                      const Chosen& two,
                      const Chosen& three,
                      const Chosen& four) const
    {
        const Chosen deepest = best([](const Spot& p) { return -p.separation; });
        const Floats extent = sqrt(distance2(two.spot, one.spot));
        const Floats chosen_least = min(min(one.spot.separation, two.spot.separation),
                                        min(three.spot.separation, four.spot.separation));
        const Mask left_out = deepest.spot.separation < chosen_least - extent * kLevel;
        const Chosen* const chosen[4] = {&one, &two, &three, &four};
        Ints kept{}, nearest{};
        Floats nearest2 = 3e38f;
        for (const Chosen* const some : chosen) {
            const Floats d2 = distance2(some->spot, deepest.spot);
            const Mask nearer = d2 < nearest2;
            nearest2 = select(nearer, d2, nearest2);
            nearest = select(nearer, some->bit, nearest);
            kept = kept.v | some->bit.v;
        }
        return select(left_out, Ints((kept.v & ~nearest.v) | deepest.bit.v), kept);
    }

    // Points whose depths differ by less than this part of the contact's extent are as deep as one
    // another.
    static constexpr float kLevel = 1e-5f;

    const Places& places_;
};

}  // namespace throng::THRONG_LANES
