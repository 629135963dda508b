// Back up: the step is cut where bodies first touch, as often as it takes, for those concerned.
//
// A group of bodies that may meet (step_event_driven.cpp) flies from touch to touch: none ever
// overlap.
#include "pipeline/event_driven/event_driven_group.hpp"

#include <algorithm>

namespace throng {

namespace {

// The shortest span that a step is cut into, as a share of it.
constexpr double kLeastSpan = 1e-9;
// A time that is a step but for rounding.
constexpr double kWhole = 1 - 1e-12;
// Where a body flies on a curve it is not yet there when the chord touches: the span is cut to this
// share, and the curve is that share squared as far from its chord.
constexpr double kCloser = 0.125;
// Spans that went well before a longer one is tried.
constexpr int kCalm = 4;
// Of its separation a pair that touches may lose this share while it rests; it is given back after.
constexpr double kKept = 0.9;

}  // namespace

// Whether none will have come nearer than a quarter of the tolerance at the end of the way ahead;
// of those that are there already, whether none will have come much nearer.
bool EventDrivenGroup::stay_apart(double time)
{
    for (const PairKey key : pairs_) {
        double least = tolerance_of(key) / 4;
        if (const auto now = separation_now_.find(key); now != separation_now_.end()) {
            const double separation = now->second;
            if (separation <= 0 && depth_error(key) > 0) continue;
            const double deeper = separation - least * (1 - kKept);
            least = std::min(least, separation > 0 ? separation * kKept : deeper);
        }
        const std::uint32_t a = scene_.colliders.body[first_of(key)];
        const std::uint32_t b = scene_.colliders.body[second_of(key)];
        const double speculative_margin = std::max(least, 0.0);
        if (separation_of(key, end_of(a, time), end_of(b, time), speculative_margin) < least)
            return false;
    }
    return true;
}

void EventDrivenGroup::back_up()
{
    const double dt = scene_.context.dt, whole = scene_.context.substep();
    double time = 0, span = whole;
    int calm = kCalm;
    while (time < dt * kWhole && may_go_on()) {
        double next = std::min(span, dt - time);
        if (dt - time - next < dt * (1 - kWhole)) next = dt - time;
        contacts_.clear();
        if (!fly(time, next)) break;
        find_pairs(time, next);
        list_contacts(time);
        if (resolve_impacts()) continue;
        if (solve_resting(next)) find_pairs(time, next);
        const FirstImpact first = look_ahead(pairs_, time, next);
        const bool meets = first.impact.state == ToiState::hit;
        if (meets) {
            next *= first.impact.time;
            fly(time, next);
            solve_resting(next);
        }
        if (!stay_apart(time + next)) {
            span = next / 2;
            calm = 0;
            if (!(span > dt * kLeastSpan)) break;
            continue;
        }
        commit();
        time += next;
        if (++calm > kCalm) span = std::min(whole, 2 * span);
        if (!meets) continue;
        const PairKey key = pairs_[first.pair];
        const std::uint32_t a = scene_.colliders.body[first_of(key)];
        const std::uint32_t b = scene_.colliders.body[second_of(key)];
        const double tolerance = tolerance_of(key), wider = 2 * tolerance;
        if (separation_of(key, pose_at(a, time), pose_at(b, time), wider) > tolerance)
            span = std::max(next * kCloser, dt * kLeastSpan);
    }
    outcome_.held = time < dt * kWhole;
}

std::vector<PassRow> EventDrivenGroup::passes_of_back_up()
{
    using Group = EventDrivenGroup;
    return {
        {function_name<&Group::fly>(), kEventDriven, "each span that the step is cut into"},
        {function_name<&Group::list_contacts>(), kEventDriven, "as a span begins"},
        {function_name<&Group::resolve_impacts>(),
         {Effect::restitution},
         "as it begins, until none bounces"},
        {function_name<&Group::solve_resting>(), kEventDriven, "each span, of those that touch"},
        {function_name<&Group::look_ahead>(), kEventDriven,
         "each span, and the next begins at the first touch"},
    };
}

}  // namespace throng
