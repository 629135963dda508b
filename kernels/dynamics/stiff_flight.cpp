#include "kernels/dynamics/stiff_flight.hpp"

#include <algorithm>

namespace throng {

namespace {

// rad, of an arm of a spring, in a part that is not halved; how often a span is, and into how many
// parts all of them: what turns yet faster loses energy, and gains none.
constexpr double kFurthestTurn = 0.5;
constexpr int kHalvings = 6, kMostParts = 256;

// Springs change spins, so none is kept as a momentum.
RigidRule with_spins(RigidRule rule)
{
    rule.momentum_on_pivots = false;
    return rule;
}

}  // namespace

StiffFlight::StiffFlight(const RigidRule& rule,
                         const RigidFacts& facts,
                         std::span<const std::uint32_t> bodies,
                         const Flights& flights)
    : rule_(with_spins(rule)), law_(rule_, facts),
      springs_(facts.forces, facts.masses, facts.poses, facts.velocities, bodies)
{
    law_.leave_springs();
    law_.take(bodies, flights);
}

void StiffFlight::carry(double time, double span) { carry_part(time, span, kHalvings); }

void StiffFlight::carry_part(double time, double span, int halvings)
{
    const std::vector<double> begun(law_.state(), law_.state() + law_.places() + law_.speeds());
    law_.precess(0.5 * span);
    law_.kick(time, 0.5 * span, law_.state());
    look();
    const auto change = springs_.begin(time, span);
    const bool follows = springs_.found() && springs_.furthest_turn() <= kFurthestTurn;
    if (!follows && halvings > 0 && ++parts_ <= kMostParts) {
        std::copy(begun.begin(), begun.end(), law_.state());
        carry_part(time, 0.5 * span, halvings - 1);
        return carry_part(time + 0.5 * span, 0.5 * span, halvings - 1);
    }
    give(change);
    law_.go(span);
    law_.kick(time + span, 0.5 * span, law_.state());
    look_at_speeds();
    give(springs_.end());
    law_.precess(0.5 * span);
    law_.settle();
}

void StiffFlight::look()
{
    for (std::size_t i = 0; i < springs_.bodies().size(); ++i) {
        const RigidMotion::Going going = law_.going(i);
        SpringBody& body = springs_.bodies()[i];
        body.position = going.position;
        body.turn = going.turn;
        body.velocity = going.velocity;
        body.spin = going.spin;
        body.inverse_inertia = going.inverse_inertia;
        body.axis = going.axis;
        body.carries = going.carries;
    }
}

void StiffFlight::look_at_speeds()
{
    for (std::size_t i = 0; i < springs_.bodies().size(); ++i) {
        const RigidMotion::Going going = law_.going(i);
        springs_.bodies()[i].velocity = going.velocity;
        springs_.bodies()[i].spin = going.spin;
    }
}

void StiffFlight::give(std::span<const StiffSprings::Six> change)
{
    for (std::size_t i = 0; i < change.size(); ++i)
        law_.add_speed(i, change[i].linear, change[i].angular);
}

}  // namespace throng
