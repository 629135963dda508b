// Impacts: how those who meet leave one another, by generalised reflections.
//
// Those that close are stopped together, by one solve, and given back their share e of what stopped
// them; then those that close now, and so on until none does. Momentum is kept, energy too where
// e = 1, what is symmetric stays so, and the order of bodies means nothing. Where coefficients
// differ the mean over the work done is taken, so that no pass gains energy.
//
// Source: Smith, Kaufman, Vouga, Tamstorf and Grinspun, Reflections on Simultaneous Impact (2012).
#pragma once

#include "kernels/solver/direct/direct_points.hpp"

#include <functional>
#include <vector>

namespace throng {

/// A point that may be struck.
///
///   at           what the caller knows it by
///   pair         of those that meet together where pairs go in turn; points of one follow one
///                another
///   least_speed  m/s, slower ones do not bounce
///   impulse      N s along the normal, of all impacts so far
struct ImpactPoint {
    DirectPoint point;
    std::size_t at = 0;
    std::uint64_t pair = 0;
    double restitution = 0, least_speed = 0, impulse = 0;
};

class Impacts {
public:
    /// Brings points to their least speed, without friction: impulses from nothing.
    using Solve = std::function<void(std::vector<DirectBody>&, std::vector<DirectPoint>&)>;

    /// Passes at most: those between a wall and a heavy body that closes in may be without end.
    /// What still closes then is stopped.
    static constexpr int kMostPasses = 500;
    /// Slower than this, of the greatest speed, nobody closes.
    static constexpr double kRounding = 1e-11;

    std::vector<ImpactPoint> points;

    /// One pass: all that close at once, or (`in_order`) pair by pair. False if none closes.
    bool pass(bool in_order, std::vector<DirectBody>& bodies, const Solve& solve);

private:
    bool reflect(std::size_t begin,
                 std::size_t end,
                 std::vector<DirectBody>& bodies,
                 const Solve& solve);
    bool bounce_one(std::vector<DirectBody>& bodies);

    std::vector<std::size_t> hits_;        // those of `points` that close
    std::vector<DirectPoint> struck_;      // [hits]
    std::vector<double> speeds_, shares_;  // [hits] m/s closing; restitution
    std::vector<DirectBody> stopped_;      // [bodies]
};

}  // namespace throng
