// Group contacts: what happens where bodies of a group touch.
//
// Who closes faster than a fall through the tolerance makes him bounces: all pairs together, or
// pair by pair in order of pair ids, as impact_law has it, by generalised reflections (see
// impacts.hpp). Friction comes last, and sees the impulses of all. Who closes slower
// rests: a joint solve keeps it half the tolerance away. A pair that has bounced too often in a
// step rests too, so that a step's work is bounded.
#include "kernels/math/rotation.hpp"
#include "kernels/solver/carried_points.hpp"
#include "kernels/solver/driven_contacts.hpp"
#include "pipeline/contacts/collide.hpp"
#include "pipeline/event_driven/event_driven_group.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace throng {

namespace {

constexpr int kMostStrikes = 1000;   // of a pair in a step
constexpr double kRounding = 1e-11;  // of a distance
// The share of what is missing to the separation at rest that a span gives back.
constexpr double kPartShare = 0.5;
// As far as this, in tolerances, at the end of a span, bodies are not held.
constexpr double kClear = 2;
// Deeper than this, in tolerances, two are moved apart.
constexpr double kSunk = 0.75;
// Two methods may see a distance differently by this share.
constexpr double kAlike = 1.01;
// Of two that touch, points out to so many tolerances count: held at its nearest corner alone, a
// body tips over to the others, and back, span by span.
constexpr double kWide = 4;

}  // namespace

// Those carried come first; below 0 for what stands still.
std::int32_t EventDrivenGroup::index_of(std::uint32_t body)
{
    if (const std::int32_t member = member_of(body); member >= 0) return member;
    const Velocities& velocities = scene_.velocities;
    const bool moves =
        scene_.states.kind[body] == BodyKind::kinematic || scene_.states.carries(body);
    if (!moves || (velocities.linear[body].isZero(0) && velocities.angular[body].isZero(0)))
        return -1;
    const auto at = std::find(members_.begin(), members_.end(), body);
    const auto place = static_cast<std::size_t>(at - members_.begin());
    if (at == members_.end()) members_.push_back(body);
    return static_cast<std::int32_t>(place);
}

void EventDrivenGroup::list_contacts(double time)
{
    contacts_.clear();
    separation_now_.clear();
    members_.assign(bodies_.begin(), bodies_.end());
    for (const PairKey key : pairs_) list_contacts_of(key, time);
}

void EventDrivenGroup::list_contacts_of(PairKey key, double time)
{
    const Colliders& colliders = scene_.colliders;
    const double tolerance = tolerance_of(key);
    const auto place = [&](std::uint32_t collider) {
        return pose_at(colliders.body[collider], time);
    };
    const double least =
        separation_of(key, place(first_of(key)), place(second_of(key)), kWide * tolerance);
    if (manifolds_.manifolds.empty() || least > kAlike * tolerance) return;
    separation_now_[key] = least;
    const GroupContact contact = contact_of(key);
    for (const LocalManifold<double>& found : manifolds_.manifolds)
        add_contacts(found, place(manifolds_.first).position, place(manifolds_.second).position,
                     contact);
}

// What points of the manifolds found last have in common.
EventDrivenGroup::GroupContact EventDrivenGroup::contact_of(PairKey key)
{
    const Colliders& colliders = scene_.colliders;
    const double tolerance = tolerance_of(key);
    const std::uint32_t a = manifolds_.first, b = manifolds_.second;
    const Surfaces::MaterialPair materials =
        scene_.surfaces.between(colliders.material[a], colliders.material[b]);
    GroupContact contact;
    contact.key = key;
    contact.body_a = colliders.body[a];
    contact.body_b = colliders.body[b];
    contact.tolerance = tolerance;
    contact.rest_separation = tolerance / 2;
    contact.restitution = materials.restitution;
    contact.least_speed = std::sqrt(2 * scene_.context.gravity.norm() * tolerance);
    contact.point.a = index_of(contact.body_a);
    contact.point.b = index_of(contact.body_b);
    contact.point.friction = materials.friction;
    contact.point.rolling = materials.rolling_friction;
    return contact;
}

// Who is driven walks on what bears it.
Vec3 EventDrivenGroup::walk_at(const GroupContact& contact) const
{
    const auto drive = [&](std::uint32_t body) {
        return scene_.states.movable(body) ? scene_.prescribed.of(body) : nullptr;
    };
    const auto rolls = [&](bool is_b) {
        const std::uint32_t body = is_b ? contact.body_b : contact.body_a;
        return (is_b ? contact.round_b : contact.round_a) > 0 && rule_.turns
            && !(scene_.masses.inverse_inertia[body] == Sym3{});
    };
    const auto velocity = [&](bool is_b) -> Vec3 {
        const std::uint32_t body = is_b ? contact.body_b : contact.body_a;
        return scene_.velocities.linear[body]
            + scene_.velocities.angular[body].cross(is_b ? contact.point.arm_b
                                                         : contact.point.arm_a);
    };
    return walk_of(drive(contact.body_a), drive(contact.body_b), contact.point.normal,
                   up_of(scene_.context.gravity), rolls, velocity);
}

// The normal of a manifold, and how round the two are along it.
void EventDrivenGroup::note_normal(const LocalManifold<double>& found, GroupContact& contact) const
{
    const Vec3 normal = (manifolds_.at_first.orientation * found.normal).normalized();
    const auto round = [&](std::uint32_t collider, std::uint32_t body) {
        const Colliders& colliders = scene_.colliders;
        const Quat turn = scene_.poses.orientation[body] * colliders.local[collider].orientation;
        return round_radius(scene_.shapes, colliders.shape[collider], {Vec3::Zero(), turn}, normal);
    };
    contact.point.normal = normal;
    contact.round_a = round(manifolds_.first, contact.body_a);
    contact.round_b = round(manifolds_.second, contact.body_b);
}

// The points of one manifold, of bodies at these positions; `contact` is what they have in common.
void EventDrivenGroup::add_contacts(const LocalManifold<double>& found,
                                    const Vec3& a,
                                    const Vec3& b,
                                    GroupContact contact)
{
    DirectPoint& point = contact.point;
    note_normal(found, contact);
    for (int k = 0; k < found.count; ++k) {
        const auto& at = found.points[static_cast<std::size_t>(k)];
        const Vec3 middle = manifolds_.at_first * at.position,
                   half = point.normal * (at.separation / 2);
        contact.separation = at.separation;
        point.arm_a = middle - half - a;
        point.arm_b = middle + half - b;
        if (!scene_.prescribed.body.empty()) point.walk = walk_at(contact);
        contacts_.push_back(contact);
    }
}

// As they are, or as they will be at the end of the way ahead.
EventDrivenGroup::Motions EventDrivenGroup::motions(bool ends) const
{
    Motions bodies(members_.size());
    for (std::size_t i = 0; i < members_.size(); ++i) {
        const std::uint32_t body = members_[i];
        const bool carried = i < bodies_.size();
        bodies[i].velocity = carried && ends ? ends_[i].velocity : scene_.velocities.linear[body];
        bodies[i].spin = carried && ends ? ends_[i].spin : scene_.velocities.angular[body];
        if (!carried) continue;
        bodies[i].inverse_mass = scene_.masses.inverse_mass[body];
        if (rule_.turns)
            bodies[i].inverse_inertia =
                in_world_axes(scene_.masses.inverse_inertia[body], scene_.poses.orientation[body]);
    }
    return bodies;
}

double EventDrivenGroup::restitution_of(const GroupContact& contact) const
{
    const auto is_hit = impact_counts_.find(contact.key);
    const bool worn = is_hit != impact_counts_.end() && is_hit->second >= kMostStrikes;
    return worn ? 0 : contact.restitution;
}

// Whether it is as near as what touches.
bool EventDrivenGroup::touches(const GroupContact& contact)
{
    return contact.separation <= kAlike * contact.tolerance;
}

// Whether who meets or leaves at this speed, m/s, does not rest.
bool EventDrivenGroup::bounces(const GroupContact& contact, double speed) const
{
    return restitution_of(contact) > 0 && speed > contact.least_speed;
}

// The impacts of reflected bodies with friction, where every struck point leaves with the speed
// that it has now. False, and nothing done, where that takes energy that nobody gave.
bool EventDrivenGroup::leave_as_reflected(std::vector<DirectPoint>& points, Motions& bodies)
{
    const Motions before = motions(false);
    const double work = work_of(points, before, bodies);
    double size = 0;
    for (const DirectPoint& point : points)
        size += point.impulse.norm() * relative_velocity(point, before).norm();
    std::vector<DirectPoint> held = points;
    for (DirectPoint& point : held) point.impulse.setZero();
    Motions after = before;
    solve(after, held);
    if (work_of(held, before, after) > work + Impacts::kRounding * size) return false;
    bodies = std::move(after);
    points = std::move(held);
    return true;
}

// Friction of impacts. Where points that leave as they are reflected would win energy, or impacts
// came to no end and somebody is on his way back, friction bears its share of what struck instead,
// and they leave as they come.
void EventDrivenGroup::apply_friction(Motions& bodies, bool ended)
{
    std::vector<DirectPoint> points;
    std::vector<std::size_t> struck;
    bool grips = false;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        if (!(struck_[i] > 0)) continue;
        struck.push_back(i);
        points.push_back(contacts_[i].point);
        points.back().impulse = points.back().normal * struck_[i];
        points.back().least = std::max(0.0, relative_normal_velocity(points.back(), bodies));
        grips = grips || points.back().friction > 0 || points.back().rolling > 0;
    }
    if (grips && !(ended && leave_as_reflected(points, bodies)))
        for (DirectPoint& point : points)
            apply_impact_friction(point.normal.dot(point.impulse), point, bodies);
    for (std::size_t k = 0; k < struck.size(); ++k)
        note_push(contacts_[struck[k]], points[k].impulse);
}

void EventDrivenGroup::note_push(const GroupContact& contact, const Vec3& impulse)
{
    outcome_.pushes.try_emplace(contact.body_a, Vec3::Zero()).first->second -= impulse;
    outcome_.pushes.try_emplace(contact.body_b, Vec3::Zero()).first->second += impulse;
}

// Impacts of this moment. False if there is none.
bool EventDrivenGroup::resolve_impacts()
{
    Motions bodies = motions(false);
    double greatest = 0;
    for (const GroupContact& contact : contacts_)
        greatest = std::max(greatest, std::abs(relative_normal_velocity(contact.point, bodies)));
    bool any = false;
    for (GroupContact& contact : contacts_) {
        contact.least_speed = std::max(contact.least_speed, Impacts::kRounding * greatest);
        const double separating_speed = relative_normal_velocity(contact.point, bodies);
        any = any || (touches(contact) && bounces(contact, -separating_speed));
    }
    if (!any) return false;
    // Those of two bodies bounce together, whatever shapes of theirs meet.
    impacts_.points.clear();
    std::map<std::pair<std::uint32_t, std::uint32_t>, PairKey> first_of_two;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        const GroupContact& contact = contacts_[i];
        if (!touches(contact)) continue;
        const auto two = std::minmax(contact.body_a, contact.body_b);
        const PairKey pair = first_of_two.try_emplace(two, contact.key).first->second;
        impacts_.points.push_back(
            {contact.point, i, pair, restitution_of(contact), contact.least_speed, 0});
    }
    std::stable_sort(impacts_.points.begin(), impacts_.points.end(),
                     [](const ImpactPoint& x, const ImpactPoint& y) { return x.pair < y.pair; });
    const bool in_order = scene_.parameters.impact_law == ImpactLaw::sequential;
    const auto stop = [&](auto& stopped, auto& points) { solve(stopped, points); };
    bool closes = true;
    for (int left = Impacts::kMostPasses; left > 0 && closes && may_go_on(); --left)
        closes = impacts_.pass(in_order, bodies, stop);
    struck_.assign(contacts_.size(), 0);
    for (const ImpactPoint& impact : impacts_.points) struck_[impact.at] = impact.impulse;
    apply_friction(bodies, !closes);
    for (std::size_t i = 0; i < contacts_.size(); ++i)
        if (struck_[i] > 0) impact_counts_[contacts_[i].key] += closes ? kMostStrikes : 1;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        scene_.velocities.linear[bodies_[i]] = bodies[i].velocity;
        scene_.velocities.angular[bodies_[i]] = bodies[i].spin;
    }
    return true;
}

// All impacts of this moment.
void EventDrivenGroup::settle_impacts()
{
    for (int left = kMostStrikes; left > 0 && resolve_impacts() && may_go_on();) --left;
}

// What rests is pressed as it was in the span before: then the solve has little left to do.
void EventDrivenGroup::guess(double span, std::vector<DirectPoint>& points) const
{
    auto before = pressing_.begin();
    for (std::size_t k = 0; k < points.size(); ++k) {
        const PairKey key = contacts_[resting_[k]].key;
        while (before != pressing_.end() && before->key < key) ++before;
        if (before == pressing_.end() || before->key != key) continue;
        points[k].impulse = before->force * span;
        points[k].torque = before->torque * span;
        ++before;
    }
}

// Who is carried by what turns meets it where the middle of the way ahead finds the two.
void EventDrivenGroup::carry(const GroupContact& contact,
                             const Motions& bodies,
                             double half,
                             DirectPoint& point) const
{
    const auto body = [&](std::int32_t member) {
        return member < 0 ? DirectBody{} : bodies[static_cast<std::size_t>(member)];
    };
    const DirectBody a = body(point.a), b = body(point.b);
    const auto carried_by = [&](const DirectBody& carrier, const DirectBody& carried) {
        return carries(carrier.spin, inverse_mass_of(carrier), inverse_mass_of(carried),
                       scene_.context.dt);
    };
    const bool by_a = carried_by(a, b);
    if (!by_a && !carried_by(b, a)) return;
    if (!point.walk.isZero(0)) return;  // it is told for where it was
    const Vec3 core_a = point.arm_a - point.normal * contact.round_a;
    const Vec3 core_b = point.arm_b + point.normal * contact.round_b;
    carry_arms(carried_side(Vec3::Zero(), Quat::Identity(), a, core_a, half),
               carried_side(Vec3::Zero(), Quat::Identity(), b, core_b, half),
               goes_with_b(contact.round_a, contact.round_b, by_a), point);
}

// Whether a contact holds or may hold bodies that go as `bodies` do, and went as `now` before.
bool EventDrivenGroup::may_rest(const GroupContact& contact,
                                const Motions& now,
                                const Motions& bodies,
                                double span) const
{
    // Who has just bounced flies, and falls back in a span of its own; but for those that would
    // not come out of one another by that. Who is about to bounce is let come.
    const double separating_speed = relative_normal_velocity(contact.point, now);
    if (bounces(contact, separating_speed)
        && contact.separation + separating_speed * span > -kSunk * contact.tolerance)
        return false;
    if (!touches(contact) && bounces(contact, -separating_speed)) return false;
    return contact.separation + relative_normal_velocity(contact.point, bodies) * span
        <= kClear * contact.tolerance;
}

// Takes the contacts that may hold bodies that go so. False if all of those are held already.
bool EventDrivenGroup::take_resting(const Motions& now, const Motions& bodies, double span)
{
    const std::vector<std::size_t> held = std::exchange(resting_, {});
    auto next = held.begin();
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        const bool is_held = next != held.end() && *next == i;
        if (is_held) ++next;
        if (is_held || may_rest(contacts_[i], now, bodies, span)) resting_.push_back(i);
    }
    return resting_.size() > held.size();
}

// Holds those that would be too near at the end of the way ahead, and those that others, held
// there, would let them come to. False if there are none.
bool EventDrivenGroup::solve_resting(double span)
{
    const Motions flown = motions(true), now = motions(false);
    Motions held = flown;
    std::vector<DirectPoint> points;
    resting_.clear();
    while (take_resting(now, held, span)) {
        points.clear();
        for (const std::size_t at : resting_) {
            const GroupContact& contact = contacts_[at];
            points.push_back(contact.point);
            points.back().least =
                -std::max(contact.separation - contact.rest_separation, 0.0) / span;
            carry(contact, now, span / 2, points.back());
        }
        guess(span, points);
        held = flown;
        solve(held, points);
    }
    if (resting_.empty()) return false;
    pressing_.clear();
    for (std::size_t k = 0; k < points.size(); ++k)
        pressing_.push_back(
            {contacts_[resting_[k]].key, points[k].impulse / span, points[k].torque / span});
    pressed_ = std::move(points);
    part(span, held);
    return true;
}

// Those nearer than they rest are moved apart, on top of what else they do.
void EventDrivenGroup::part(double span, const Motions& solved)
{
    std::vector<DirectPoint> points;
    bool any = false;
    for (const std::size_t at : resting_) {
        const GroupContact& contact = contacts_[at];
        points.push_back(contact.point);
        points.back().friction = points.back().rolling = 0;
        points.back().least = -std::max(contact.separation - contact.rest_separation, 0.0) / span;
        if (!(contact.separation < contact.rest_separation * (1 - kRounding))) continue;
        any = true;
        points.back().least =
            std::min((contact.rest_separation - contact.separation) * kPartShare / span,
                     scene_.parameters.push_limit);
    }
    Motions ways = solved;
    if (any) solve(ways, points);
    end_with(solved, ways, span);
}

// Bodies that a contact may hold go where the solve has them go; others fly.
void EventDrivenGroup::end_with(const Motions& speeds, const Motions& ways, double span)
{
    for (const std::size_t at : resting_)
        for (const std::int32_t member : {contacts_[at].point.a, contacts_[at].point.b}) {
            const auto i = static_cast<std::size_t>(member);
            if (member < 0 || i >= bodies_.size()) continue;
            End& end = ends_[i];
            const std::uint32_t body = bodies_[i];
            end.flew = false;
            end.velocity = speeds[i].velocity;
            end.spin = speeds[i].spin;
            end.pose.position = scene_.poses.position[body] + ways[i].velocity * span;
            end.pose.orientation = turned(scene_.poses.orientation[body], ways[i].spin, span);
        }
}

}  // namespace throng
