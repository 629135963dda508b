// Box spread: the best four of the points that clipping left, W manifolds side by side; the rules
// of contact_points.hpp, in the plane of the leading face.
#pragma once

#include "narrowphase/convex/wide/box_clip_lanes.hpp"

#include <array>

namespace throng::THRONG_LANES {

// A place that was chosen: its bit, and where it is.
struct Chosen {
    Ints bit{};
    Spot spot;
};

class Spread {
public:
    // sign: of the leading face's normal, which decides the direction that is looked in first.
    // Returns the bits of the chosen places, which are drawn to those that are left out.
    static Ints four_of(Places& places, Floats sign)
    {
        Spread spread(places);
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
        return spread.drawn({one, two, three, four});
    }

private:
    explicit Spread(Places& places) : places_(places) { }

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

    // See contact_points.cpp.
    struct Drawn {
        Floats u = 0.f, v = 0.f, separation = 0.f, sum = 0.f, least = 3e38f;

        void add(const Spot& spot, Floats share)
        {
            u = u + share * spot.u;
            v = v + share * spot.v;
            separation = separation + share * spot.separation;
            sum = sum + share;
        }
        Spot draw(Floats chosen_least, Floats whole, const Spot& spot) const
        {
            const Mask some = sum > Floats(0.f);
            const Floats part = min((chosen_least - least) / whole, Floats(1.f));
            const auto drawn = [&](Floats all, Floats own) {
                return select(some, own + part * (all / sum - own), own);
            };
            return {drawn(u, spot.u), drawn(v, spot.v), drawn(separation, spot.separation)};
        }
    };

    // Which of those that were chosen is nearest.
    static Ints nearest_of(const std::array<Chosen, 4>& chosen, const Spot& spot)
    {
        Ints nearest{};
        Floats nearest2 = 3e38f;
        int i = 0;
        for (const Chosen& one : chosen) {
            const Floats d2 = distance2(one.spot, spot);
            const Mask nearer = d2 < nearest2;
            nearest2 = select(nearer, d2, nearest2);
            nearest = select(nearer, Ints(i), nearest);
            ++i;
        }
        return nearest;
    }

    // Returns the bits of those that were chosen.
    Ints drawn(const std::array<Chosen, 4>& chosen)
    {
        Ints kept{};
        Floats least = 3e38f;
        for (const Chosen& one : chosen) {
            kept = kept.v | one.bit.v;
            least = min(least, one.spot.separation);
        }
        std::array<Mask, kPlaces> deeper;
        unsigned any = 0;
        for (std::size_t k = 0; k < kPlaces; ++k) {
            deeper[k] = both(places_.there[k], places_.separation[k] < least);
            any |= bits(deeper[k]);
        }
        if (any == 0) return kept;

        // Above nothing, as all may lie in one point.
        const Floats whole =
            max(sqrt(distance2(chosen[1].spot, chosen[0].spot)) * kDrawn, Floats(1e-37f));
        std::array<Drawn, 4> all;
        std::array<Ints, kPlaces> nearest;
        for (std::size_t k = 0; k < kPlaces; ++k) {
            nearest[k] = nearest_of(chosen, spot_at(k));
            for (int i = 0; i < 4; ++i) {
                Floats& deepest = all[std::size_t(i)].least;
                deepest = select(both(deeper[k], equal(nearest[k], i)),
                                 min(places_.separation[k], deepest), deepest);
            }
        }
        for (std::size_t k = 0; k < kPlaces; ++k)
            for (int i = 0; i < 4; ++i) {
                Drawn& one = all[std::size_t(i)];
                const Spot spot = spot_at(k);
                const Floats share =
                    max(Floats(1.f) - (spot.separation - one.least) / whole, Floats(0.f));
                one.add(spot, select(both(deeper[k], equal(nearest[k], i)), share, Floats(0.f)));
            }
        for (std::size_t i = 0; i < 4; ++i)
            put(chosen[i].bit, all[i].draw(least, whole, chosen[i].spot));
        return kept;
    }

    Spot spot_at(std::size_t k) const
    {
        return {places_.u[k], places_.v[k], places_.separation[k]};
    }

    void put(Ints bit, const Spot& spot)
    {
        for (int k = 0; k < kPlaces; ++k) {
            const Mask here = equal(bit, 1 << k);
            places_.u[k] = select(here, spot.u, places_.u[k]);
            places_.v[k] = select(here, spot.v, places_.v[k]);
            places_.separation[k] = select(here, spot.separation, places_.separation[k]);
        }
    }

    static constexpr float kDrawn = 5e-4f;  // as in contact_points.hpp

    Places& places_;
};

}  // namespace throng::THRONG_LANES
