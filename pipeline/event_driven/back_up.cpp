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
// How often a span is taken anew with what was foreseen of it, before it is cut.
constexpr int kMostForeseen = 3;
// Of its separation a pair that touches may lose this share while it rests; it is given back after.
constexpr double kKept = 0.9;

}  // namespace

// Whether a pair will not have come nearer than a quarter of the tolerance at the end of the way
// ahead; one that is there already, not much nearer.
bool EventDrivenGroup::stays_apart(PairKey key, double time)
{
    double least = tolerance_of(key) / 4;
    if (const auto now = separation_now_.find(key); now != separation_now_.end()) {
        const double separation = now->second;
        if (separation <= 0 && depth_error(key) > 0) return true;
        const double deeper = separation - least * (1 - kKept);
        least = std::min(least, separation > 0 ? separation * kKept : deeper);
    }
    const std::uint32_t a = scene_.colliders.body[first_of(key)];
    const std::uint32_t b = scene_.colliders.body[second_of(key)];
    const double speculative_margin = std::max(least, 0.0);
    return !(separation_of(key, end_of(a, time), end_of(b, time), speculative_margin) < least);
}

// The same of all; where others would be too near is foreseen when the span is taken anew.
bool EventDrivenGroup::stay_apart(double begin, double end)
{
    bool all = true;
    for (const PairKey key : pairs_) {
        if (stays_apart(key, end)) continue;
        foresee(key, begin, end);
        all = false;
    }
    return all;
}

// Places that the manifolds found last have too near at the end of the way ahead are contacts of
// its beginning: what a body tips over to, or rolls on to, while it is held elsewhere.
void EventDrivenGroup::foresee(PairKey key, double begin, double end)
{
    GroupContact contact = contact_of(key);
    const Pose from_a = pose_at(contact.body_a, begin), from_b = pose_at(contact.body_b, begin);
    const Pose to_a = end_of(contact.body_a, end), to_b = end_of(contact.body_b, end);
    DirectPoint& point = contact.point;
    for (const LocalManifold<double>& found : manifolds_.manifolds) {
        note_normal(found, contact);
        for (int k = 0; k < found.count; ++k) {
            const auto& at = found.points[static_cast<std::size_t>(k)];
            if (!(at.separation < contact.rest_separation)) continue;
            const Vec3 middle = manifolds_.at_first * at.position;
            const Vec3 half = point.normal * (at.separation / 2);
            point.arm_a = from_a.orientation * to_a.to_local(middle - half);
            point.arm_b = from_b.orientation * to_b.to_local(middle + half);
            contact.separation =
                point.normal.dot(from_b.position + point.arm_b - from_a.position - point.arm_a);
            // Who was on the other side, seen along this normal, met it in another way.
            if (!(contact.separation > 0)) continue;
            if (!scene_.prescribed.body.empty()) point.walk = walk_at(contact);
            foreseen_.push_back(contact);
        }
    }
}

void EventDrivenGroup::add_foreseen()
{
    for (GroupContact& contact : foreseen_) {
        contact.point.a = index_of(contact.body_a);
        contact.point.b = index_of(contact.body_b);
        contacts_.push_back(contact);
    }
}

void EventDrivenGroup::back_up()
{
    const double dt = scene_.context.dt, whole = scene_.context.substep();
    double time = 0, span = whole;
    int calm = kCalm, foreseen = 0;
    while (time < dt * kWhole && may_go_on()) {
        double next = std::min(span, dt - time);
        if (dt - time - next < dt * (1 - kWhole)) next = dt - time;
        contacts_.clear();
        if (!fly(time, next)) break;
        find_pairs(time, next);
        list_contacts(time);
        add_foreseen();
        if (resolve_impacts()) continue;
        if (solve_resting(next)) find_pairs(time, next);
        const FirstImpact first = look_ahead(pairs_, time, next);
        const bool meets = first.impact.state == ToiState::hit;
        if (meets) {
            next *= first.impact.time;
            fly(time, next);
            solve_resting(next);
        }
        const std::size_t before = foreseen_.size();
        if (!stay_apart(time, time + next)) {
            if (foreseen_.size() > before && foreseen++ < kMostForeseen) continue;
            span = next / 2;
            calm = foreseen = 0;
            foreseen_.clear();
            if (!(span > dt * kLeastSpan)) break;
            continue;
        }
        commit();
        foreseen = 0;
        foreseen_.clear();
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
