// Fast bodies: who may pass through something in a step.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/bounds.hpp"

#include <algorithm>

namespace throng {

/// Contacts are looked for this far from a resting surface, as a share of the shape's smallest half
/// extent: far enough that a body at rest never loses its contacts to a breath.
inline constexpr double kRestingMargin = 0.04;

/// A body is a fast candidate once the speculative margin of a collider is this share of its
/// smallest half extent: half the extent in a step, and what it looks around at rest. Who is not
/// cannot be fast in this step, nor, but for a blow, in the next one.
inline constexpr double kFastCandidateMargin = 0.5 + kRestingMargin;

/// Who goes further in a step than this many smallest half extents looks for no contacts ahead, nor
/// does who is marked fast and is not at rest. Up to here those that it finds ahead hold it in all
/// but rare cases.
inline constexpr double kAheadOfContacts = 2;

/// The margin of such a body, in tolerances of its time of impact: it is held within one. Any more
/// and what passes close by is turned aside.
inline constexpr double kHeldMargin = 2;

/// Up to this angle a step, rad, contacts see turning well enough ahead: no point is further from
/// the straight way that they take it for than 3 % of that.
inline constexpr double kSmallTurn = 0.25;

/// How far the surface of a collider comes by turning in a step, m, at most; 0 where contacts see
/// it ahead, and of a ball about its own center, which stays where it is.
inline double way_of_turning(const Colliders& colliders, std::size_t at, double angle)
{
    const double outer = colliders.outer_radius[at];
    if (!(outer > colliders.inner_extent[at])) return 0;
    return angle > kSmallTurn ? std::min(angle, 2.0) * outer : 0;
}

/// A body that turns strays from the straight ways that contacts take its points for by half of
/// outer_radius * angle^2 at most. From this share of its smallest half extent on what is slender
/// may be found deeper than contacts saw, and with more beyond what it met.
inline constexpr double kStrayed = 0.25;

/// Whether turning by an angle, of which the square is told, takes a collider as far astray.
inline bool strays(const Colliders& colliders, std::size_t at, double square)
{
    const double inner = colliders.inner_extent[at], outer = colliders.outer_radius[at];
    return inner > 0 && outer > inner && outer * square > 2 * kStrayed * inner;
}

/// Whether a body is a fast candidate, of those that have colliders.
///
///   falls   m, what gravity may add to its way in a step
inline bool is_fast_candidate(const Colliders& colliders,
                              const Velocities& velocities,
                              std::size_t body,
                              double dt,
                              double falls)
{
    const double way = velocities.linear[body].norm() * dt;
    const double angle = velocities.angular[body].norm() * dt;
    for (std::uint32_t k = 0; k < colliders.count[body]; ++k) {
        const std::uint32_t at = colliders.begin[body] + k;
        const double inner = colliders.inner_extent[at];
        // A surface has no inside to be passed by turning about itself.
        const double turning = inner > 0 ? way_of_turning(colliders, at, angle) : 0;
        const double rest = std::max(kRestingMargin * inner, falls);
        if (rest + way + turning > kFastCandidateMargin * inner && way + turning + falls > 0)
            return true;
        if (strays(colliders, at, angle * angle)) return true;
    }
    return false;
}

/// Most are: neither fast candidates as the step began nor fast as it ended. False where that takes
/// a closer look.
inline bool is_surely_slow(const Colliders& colliders,
                           const Bounds& bounds,
                           const Velocities& velocities,
                           std::size_t body,
                           double dt)
{
    if (colliders.count[body] != 1) return false;
    const std::uint32_t at = colliders.begin[body];
    const double inner = colliders.inner_extent[at];
    const double turned = velocities.angular[body].squaredNorm() * dt * dt;
    return bounds.speculative_margin[at] <= kFastCandidateMargin * inner
        && 4 * velocities.linear[body].squaredNorm() * dt * dt <= inner * inner
        && turned <= kSmallTurn * kSmallTurn && !strays(colliders, at, turned);
}

/// Whether a body has come far enough in a step to have passed through something.
///
///   length  m, of the way of its middle
///   angle   rad, that its spin would have turned it by
///   square  of the angle that counts for how far it strayed, which may be greater
inline bool may_have_passed(
    const Colliders& colliders, std::size_t body, double length, double angle, double square)
{
    for (std::uint32_t k = 0; k < colliders.count[body]; ++k) {
        const std::uint32_t at = colliders.begin[body] + k;
        const double inner = colliders.inner_extent[at];
        const double turning = inner > 0 ? way_of_turning(colliders, at, angle) : 0;
        if (length + turning > inner || strays(colliders, at, square)) return true;
    }
    return false;
}

}  // namespace throng
