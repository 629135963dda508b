// Penalty forces: each point that overlaps is a spring with a damper, and all act at once.
//
// Overlap under a load is the load over the stiffness. Friction is a damper across the normal that
// gives way at Coulomb's limit, so that what should stick creeps: a box on four corners at eight
// times the speed that it is given in a substep. Rolling friction has no force.
#include "pipeline/stages/whole_island.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Of auto: by how many radians it swings in a substep, and the share of critical damping where
// nothing bounces; together half of what a semi-implicit step bears.
constexpr double kSwing = 0.5, kDamped = 0.7;
// A substep is cut to this share of the limit.
constexpr double kWithin = 0.9;

}  // namespace

// What a point is to the step.
struct WholeIsland::Give {
    double stiffness = 0, damping = 0, across = 0;  // N/m, N s/m, N s/m
    double longest = 0;                             // s, of a step that keeps it from growing
};

// Whether the two overlap, or come to within that time: a spring that they fall into for a whole
// substep holds more than they bring with them.
bool WholeIsland::presses(std::size_t at, const Conditions& conditions, double ahead) const
{
    const double closing = conditions.gravity.norm() * ahead - approach(at, after_);
    return gaps_[at] < std::max(0.0, closing) * ahead;
}

// Who bears how many points that overlap, or come to within that time.
void WholeIsland::count_touching(const Conditions& conditions, double ahead)
{
    pressed_.assign(seats_.size(), 0);
    for (std::size_t i = 0; i < touches_.size(); ++i) {
        if (!presses(i, conditions, ahead)) continue;
        for (const std::int32_t seat : {touches_[i].a, touches_[i].b})
            if (seat >= 0) ++pressed_[static_cast<std::size_t>(seat)];
    }
}

// Points that share a body add up: each takes its part of what the step bears.
WholeIsland::Give WholeIsland::give_of(std::size_t at, const Settings& settings, double time) const
{
    const IslandTouch& touch = touches_[at];
    std::uint32_t share = 1;
    for (const std::int32_t seat : {touch.a, touch.b})
        if (seat >= 0) share = std::max(share, pressed_[static_cast<std::size_t>(seat)]);
    const double ease = ease_along(points_[at], touch.normal, after_) * share;
    if (!(ease > 0)) return {};
    Give give;
    give.stiffness = settings.penalty_stiffness > 0 ? settings.penalty_stiffness
                                                    : kSwing * kSwing / (time * time * ease);
    const double frequency = std::sqrt(give.stiffness * ease);
    const double damped = kDamped * (1 - touch.restitution);
    give.damping =
        settings.penalty_damping >= 0 ? settings.penalty_damping : 2 * damped * frequency / ease;
    const double ratio = 0.5 * give.damping * ease / frequency;
    give.longest = 2 * (std::sqrt(1 + ratio * ratio) - ratio) / frequency;
    give.across = 0.5 / (time * ease);
    return give;
}

// All forces are of the velocities before, so that no order of touches has a say.
void WholeIsland::push_by_forces(const Conditions& conditions, double time, bool finest)
{
    place_points();
    move_freely(conditions, time);
    count_touching(conditions, 0);
    // What is too stiff for the finest cut gives way as far as that bears.
    Settings softened = conditions.settings;
    softened.penalty_stiffness = softened.penalty_damping = -1;
    for (std::size_t i = 0; i < touches_.size(); ++i) {
        if (!(gaps_[i] < 0)) continue;
        DirectPoint& point = points_[i];
        Give give = give_of(i, conditions.settings, time);
        if (finest && give.longest < time) give = give_of(i, softened, time);
        const double force =
            std::max(0.0, -give.stiffness * gaps_[i] - give.damping * approach(i, before_));
        const Vec3 between = velocity_between(point, before_);
        const Vec3 sliding = between - point.normal * point.normal.dot(between);
        const double fast = std::sqrt(sliding.squaredNorm());
        const double hold = std::min(give.across * fast, point.friction * force);
        Vec3 impulse = point.normal * (force * time);
        if (fast > 0) impulse -= sliding * (hold * time / fast);
        point.impulse += impulse;
        apply_impulse(point, impulse, after_);
    }
    going_ = after_;
    advance(time);
}

void WholeIsland::penalise(const Conditions& conditions)
{
    const double time = conditions.substep();
    place_points();
    count_touching(conditions, time);
    double longest = time;
    for (std::size_t i = 0; i < touches_.size(); ++i) {
        points_[i].impulse = points_[i].torque = Vec3::Zero();
        if (!presses(i, conditions, time)) continue;
        const double bears = give_of(i, conditions.settings, time).longest;
        if (bears > 0 && bears < time) longest = std::min(longest, kWithin * bears);
    }
    const int cuts = static_cast<int>(
        std::min(std::ceil(time / longest), static_cast<double>(kMostPenaltyCuts)));
    cuts_ = std::max(cuts_, cuts);
    for (int cut = 0; cut < cuts; ++cut)
        push_by_forces(conditions, time / cuts, cuts == kMostPenaltyCuts);
}

}  // namespace throng
