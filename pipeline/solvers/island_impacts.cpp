// Island impacts: how those who meet faster than gravity makes them leave one another.
//
// impact_law=simultaneous: all pairs that close are stopped together, by one solve, and given back
// their share e of what stopped them; then those that close now, and so on until none does: the
// generalised reflections of Smith and others. Momentum is kept, energy too where e = 1, what is
// symmetric stays so, and the order of bodies means nothing. Where coefficients differ the mean
// over the work done is taken, so that no pass gains energy.
//
// impact_law=sequential: the same pair by pair, in order of pair ids, round after round.
//
// Friction comes last, and sees the impulses of both: a solve that asks every struck point for the
// speed that it leaves with.
//
// Source: Smith, Kaufman, Vouga, Tamstorf and Grinspun, Reflections on Simultaneous Impact (2012).
#include "pipeline/solvers/island_solver.hpp"

#include <algorithm>

namespace throng {

namespace {

// Passes at most: those between a wall and a heavy body that closes in may be without end. What
// still closes then is stopped.
constexpr int kMostPasses = 500;
// Slower than this, of the greatest speed, nobody closes.
constexpr double kRounding = 1e-11;

}  // namespace

// Those that were touching as the substep began, or came to touch within it.
void IslandSolver::list_touching(double threshold)
{
    touching_.clear();
    bool any = false;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        const bool touches = separations_[i] <= contacts_[i].tolerance
            || points_[i].normal.dot(points_[i].impulse) > 0;
        if (!touches) continue;
        touching_.push_back(i);
        any = any || (contacts_[i].restitution > 0 && approach(i, struck_) < -threshold);
    }
    if (!any) touching_.clear();
}

// Reflects those that close among the touching from `begin` to before `end`. False if none does.
bool IslandSolver::reflect(std::size_t begin, std::size_t end, double least_speed)
{
    hits_.clear();
    struck_points_.clear();
    hit_speeds_.clear();
    hit_restitution_.clear();
    for (std::size_t k = begin; k < end; ++k) {
        const std::size_t at = touching_[k];
        const double speed = approach(at, struck_);
        if (!(speed < -least_speed)) continue;
        DirectPoint point = points_[at];
        point.friction = point.rolling = point.least = 0;
        point.impulse = point.torque = Vec3::Zero();
        hits_.push_back(at);
        hit_speeds_.push_back(-speed);
        hit_restitution_.push_back(contacts_[at].restitution);
        struck_points_.push_back(point);
    }
    if (hits_.empty()) return false;
    stopped_ = struck_;
    solve(stopped_, struck_points_);
    const double twice = 1 + shared_restitution(struck_points_, hit_speeds_, hit_restitution_);
    mirror(stopped_, twice, struck_);
    for (std::size_t k = 0; k < hits_.size(); ++k)
        struck_impulse_[hits_[k]] +=
            struck_points_[k].normal.dot(struck_points_[k].impulse) * twice;
    return true;
}

// Contact by contact: the points of one meet together.
bool IslandSolver::reflect_in_order(double least_speed)
{
    bool any = false;
    for (std::size_t begin = 0, end = 0; begin < touching_.size(); begin = end) {
        const std::uint32_t contact = contacts_[touching_[begin]].contact;
        while (end < touching_.size() && contacts_[touching_[end]].contact == contact) ++end;
        any = reflect(begin, end, least_speed) || any;
    }
    return any;
}

// What the impacts did, J, but for rounding; and more than friction and rest may leave of that.
bool IslandSolver::gains(double work) const
{
    double size = 0;
    for (const DirectPoint& point : others_) {
        const double speed = relative_velocity(point, before_).norm();
        size = std::max(size,
                        point.impulse.norm() * (speed + relative_velocity(point, after_).norm()));
    }
    return work_of(others_, free_, after_) > work + kRounding * size;
}

// What gravity did in the substep, resting contacts and friction: every struck point leaves with
// the speed that it has now.
void IslandSolver::hold_struck()
{
    after_ = free_;
    for (std::size_t i = 0; i < others_.size(); ++i)
        if (struck_impulse_[i] > 0) others_[i].least = std::max(0.0, approach(i, struck_));
    solve(after_, others_);
}

// The same on top of the impacts.
void IslandSolver::add_to_struck()
{
    after_ = free_;
    for (std::size_t i = 0; i < after_.size(); ++i) {
        after_[i].velocity += struck_[i].velocity - before_[i].velocity;
        after_[i].spin += struck_[i].spin - before_[i].spin;
    }
    solve(after_, others_);
}

// By impacts with friction each point leaves as fast as without, unless that takes energy that
// nobody gave: then friction bears its share of the impulse, and the point leaves as it comes.
void IslandSolver::settle_after_impacts()
{
    bool has_friction = false;
    double work = 0;
    others_ = points_;
    for (std::size_t i = 0; i < others_.size(); ++i) {
        DirectPoint& point = others_[i];
        const bool struck = struck_impulse_[i] > 0;
        has_friction = has_friction || (struck && (point.friction > 0 || point.rolling > 0));
        point.least = struck ? 0 : std::min(point.least, 0.0);
        point.impulse = point.torque = Vec3::Zero();
        if (struck)
            work += 0.5 * struck_impulse_[i] * (approach(i, before_) + approach(i, struck_));
    }
    if (has_friction) {
        hold_struck();
        if (!gains(work)) return;
    }
    struck_points_ = others_;
    for (std::size_t i = 0; i < others_.size(); ++i) {
        DirectPoint& point = struck_points_[i];
        point.impulse = point.normal * struck_impulse_[i];
        point.torque.setZero();
        if (struck_impulse_[i] > 0) apply_impact_friction(struck_impulse_[i], point, struck_);
        if (struck_impulse_[i] > 0) others_[i].least = 0;
    }
    add_to_struck();
    for (std::size_t i = 0; i < others_.size(); ++i) {
        others_[i].impulse += struck_points_[i].impulse;
        others_[i].torque += struck_points_[i].torque;
    }
}

bool IslandSolver::bounce(const StepContext& context)
{
    if (!context.has(Effect::restitution)) return false;
    // Slower than what gravity gives in two steps is resting, not bouncing.
    const double threshold = 2 * context.gravity.norm() * context.settings.dt;
    struck_ = before_;
    for (std::size_t i = 0; i < struck_.size(); ++i)
        struck_[i].inverse_inertia = free_[i].inverse_inertia;
    list_touching(threshold);
    if (touching_.empty()) return false;
    double greatest = 0;
    for (const std::size_t at : touching_)
        greatest = std::max(greatest, std::abs(approach(at, struck_)));
    const double least_speed = std::max(threshold, kRounding * greatest);
    struck_impulse_.assign(contacts_.size(), 0);
    const bool together = context.settings.impact_law == ImpactLaw::simultaneous;
    for (int pass = 0; pass < kMostPasses; ++pass)
        if (!(together ? reflect(0, touching_.size(), least_speed) : reflect_in_order(least_speed)))
            break;
    settle_after_impacts();
    return true;
}

}  // namespace throng
