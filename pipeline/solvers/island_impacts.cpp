// Island impacts: how those who meet faster than gravity makes them leave one another.
//
// By generalised reflections (see impacts.hpp): all pairs that close together, or, by
// impact_law=sequential, pair by pair in order of pair ids, round after round.
//
// Friction comes last, and sees the impulses of both: a solve that asks every struck point for the
// speed that it leaves with.
#include "pipeline/solvers/island_solver.hpp"

#include <algorithm>

namespace throng {

namespace {

// Of the greatest speed after impacts, by which a point may still close more than it may.
constexpr double kClosing = 1e-3;

}  // namespace

// Those that were touching as the substep began, or came to touch within it; and those who may be
// thrown at one another so fast that they would. False if nobody bounces as it begins.
bool IslandSolver::list_touching(double time)
{
    impacts_.points.clear();
    bool any = false;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        const IslandContact& contact = contacts_[i];
        const bool touches =
            separations_[i] <= contact.tolerance || points_[i].normal.dot(points_[i].impulse) > 0;
        if (!touches && !(contact.restitution > 0)) continue;
        const double least =
            touches ? contact.least_speed : std::max(contact.least_speed, separations_[i] / time);
        add_impact(i, least);
        // Who would touch later in the substep does so by what forces leave of his way.
        const bool comes =
            approach(i, struck_) < -least && (touches || approach(i, free_) < -least);
        any = any || (contact.restitution > 0 && comes);
    }
    return any;
}

// Who closes slower, m/s, does not bounce.
void IslandSolver::add_impact(std::size_t at, double least_speed)
{
    impacts_.points.push_back(
        {points_[at], at, contacts_[at].contact, contacts_[at].restitution, least_speed, 0});
}

// Passes of impacts, until nobody closes faster than that, m/s. Pairs of several points take a
// solve each: those of an island that is escalated end with the steps that it has. False where
// somebody still closes, who is to be stopped.
bool IslandSolver::reflect(bool in_order, int most_passes, double least_speed)
{
    for (ImpactPoint& point : impacts_.points)
        point.least_speed = std::max(least_speed, point.least_speed);
    bool solved = false, closes = true;
    const auto stop = [&](auto& bodies, auto& points) {
        solve(bodies, points);
        solved = true;
    };
    const auto goes_on = [&] { return effort_.pivots || left_ > 0 || !solved; };
    for (int pass = 0; pass < most_passes && closes && goes_on(); ++pass)
        closes = impacts_.pass(in_order, struck_, stop);
    struck_impulse_.assign(contacts_.size(), 0);
    for (const ImpactPoint& point : impacts_.points) struck_impulse_[point.at] = point.impulse;
    return !closes;
}

// What the impacts did, J, but for rounding; and more than friction and rest may leave of that.
bool IslandSolver::gains(double work) const
{
    return work_of(others_, free_, after_) > work + rounding_of_work(others_, before_, after_);
}

// Whether those that were struck close no faster than they may. Where somebody heavy lies on
// somebody light, the residual, as a share of what his load would do to the light one, tells
// nothing of that.
bool IslandSolver::is_held() const
{
    double fastest = 0, most = 0;
    for (std::size_t i = 0; i < others_.size(); ++i) {
        fastest = std::max(fastest, std::abs(approach(i, struck_)));
        most = std::max(most, others_[i].least - approach(i, after_));
    }
    return most <= kClosing * fastest;
}

// What gravity did in the substep, resting contacts and friction: every struck point leaves with
// the speed that it has now.
void IslandSolver::hold_struck(double time)
{
    after_ = free_;
    for (std::size_t i = 0; i < others_.size(); ++i)
        if (struck_impulse_[i] > 0)
            others_[i].least = std::max(closing_in(i, time), approach(i, struck_));
    solve(after_, others_);
}

// The same on top of the impacts. Who spins otherwise than before precesses otherwise: of a rod
// that was set spinning about itself the torque of before would make energy.
void IslandSolver::add_to_struck(const StepContext& context, double time)
{
    after_ = free_;
    for (std::size_t i = 0; i < after_.size(); ++i) {
        after_[i].velocity += struck_[i].velocity - before_[i].velocity;
        if (bodies_[i].dynamic)
            after_[i].spin += turned_freely(i, struck_[i].spin, context, time)
                - turned_freely(i, before_[i].spin, context, time);
    }
    solve(after_, others_);
}

// Each struck point leaves as fast as it is reflected, friction or not, unless that takes energy
// that nobody gave: then friction bears its share of the impulse, and the point leaves as it comes.
// So it does where impacts came to no end, as between a wall and who closes in on it: somebody is
// on his way back by then, and what all that was struck leaves by would be too much. Where neither
// can be had with the steps that there are, nobody bounces.
void IslandSolver::settle_after_impacts(const StepContext& context, double time, bool ended)
{
    double work = 0;
    going_ = after_;
    others_ = points_;
    for (std::size_t i = 0; i < others_.size(); ++i) {
        DirectPoint& point = others_[i];
        const bool struck = struck_impulse_[i] > 0;
        point.least = struck ? closing_in(i, time) : std::min(point.least, 0.0);
        point.impulse = point.torque = Vec3::Zero();
        if (struck)
            work += 0.5 * struck_impulse_[i] * (approach(i, before_) + approach(i, struck_));
    }
    if (ended) {
        hold_struck(time);
        if (is_held() && !gains(work)) return;
    }
    struck_points_ = others_;
    for (std::size_t i = 0; i < others_.size(); ++i) {
        DirectPoint& point = struck_points_[i];
        point.impulse = point.normal * struck_impulse_[i];
        point.torque.setZero();
        if (!(struck_impulse_[i] > 0)) continue;
        apply_impact_friction(struck_impulse_[i], point, struck_);
        others_[i].least = closing_in(i, time);
    }
    add_to_struck(context, time);
    for (std::size_t i = 0; i < others_.size(); ++i) {
        others_[i].impulse += struck_points_[i].impulse;
        others_[i].torque += struck_points_[i].torque;
    }
    if (is_held() && (effort_.pivots || !gains(work))) return;
    after_ = going_;
    others_ = points_;
}

void IslandSolver::apply_restitution(const StepContext& context, double time)
{
    struck_ = before_;
    // Of others the half of gravity that is behind has not been added yet: with them it comes
    // after.
    if (state_forces_)
        for (const ForcedBody& forced : state_forces_->forced_bodies())
            if (forced.falls_late && context.has(Effect::gravity)
                && struck_[forced.at].inverse_mass > 0)
                struck_[forced.at].velocity -= 0.5 * time * context.gravity;
    for (std::size_t i = 0; i < struck_.size(); ++i)
        struck_[i].inverse_inertia = free_[i].inverse_inertia;
    if (!list_touching(time)) return;
    double greatest = 0;
    for (const ImpactPoint& point : impacts_.points)
        greatest = std::max(greatest, std::abs(approach(point.at, struck_)));
    const bool ended = reflect(parameters_.impact_law == ImpactLaw::sequential,
                               Impacts::kMostPasses, Impacts::kRounding * greatest);
    settle_after_impacts(context, time, ended);
    points_ = others_;
}

}  // namespace throng
