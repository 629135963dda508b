#include "pipeline/event_driven/event_driven_group.hpp"

#include "kernels/dynamics/stiff_flight.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "kernels/math/rotation.hpp"
#include "pipeline/forces/rigid_law.hpp"
#include "pipeline/forces/state_dependent_forces.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// In work: of what is small, so many make one.
constexpr std::size_t kBoxPairs = 64, kEvaluations = 4;

}  // namespace

Box3 GroupScene::box_of(std::uint32_t collider, const Pose& body) const
{
    Box3 box = shape_bounds(shapes, colliders.shape[collider], body * colliders.local[collider]);
    const double beyond = beyond_mesh(collider);
    box.lower.array() -= beyond;
    box.upper.array() += beyond;
    return box;
}

double GroupScene::beyond_mesh(std::uint32_t collider) const
{
    const ShapeRef shape = colliders.shape[collider];
    return shape.kind == ShapeKind::solid ? shapes.solids[shape.index].error : 0;
}

double GroupScene::touching_margin(std::uint32_t collider) const
{
    return 2 * impacts.tolerance * colliders.inner_extent[collider];
}

EventDrivenGroup::EventDrivenGroup(GroupScene& scene,
                                   std::span<const std::uint32_t> bodies,
                                   std::uint64_t most_work)
    : scene_(scene), bodies_(bodies), most_work_(most_work), rule_(rigid_rule(scene.context)),
      law_(rule_, {scene.forces, scene.masses, scene.poses, scene.velocities}), ends_(bodies.size())
{ }

// Asked wherever work could go on without end.
bool EventDrivenGroup::may_go_on()
{
    outcome_.short_of_work = outcome_.short_of_work || outcome_.work >= most_work_;
    return !outcome_.short_of_work;
}

std::int32_t EventDrivenGroup::member_of(std::uint32_t body) const
{
    const auto at = std::lower_bound(bodies_.begin(), bodies_.end(), body);
    return at != bodies_.end() && *at == body ? static_cast<std::int32_t>(at - bodies_.begin())
                                              : -1;
}

// s since the step began; others than its own move by themselves, or not at all.
Pose EventDrivenGroup::pose_at(std::uint32_t body, double time) const
{
    const Pose now = scene_.poses.at(body);
    if (member_of(body) >= 0 || scene_.states.kind[body] != BodyKind::kinematic) return now;
    const Velocities& velocities = scene_.velocities;
    return {now.position + velocities.linear[body] * time,
            turned(now.orientation, velocities.angular[body], time)};
}

Pose EventDrivenGroup::end_of(std::uint32_t body, double time) const
{
    const std::int32_t member = member_of(body);
    return member >= 0 ? ends_[static_cast<std::size_t>(member)].pose : pose_at(body, time);
}

double EventDrivenGroup::tolerance_of(PairKey key) const
{
    const auto& shape = scene_.colliders.shape;
    return scene_.impacts.tolerance
        * impact_size(scene_.shapes, shape[first_of(key)], shape[second_of(key)]);
}

// Where the bodies will be when nothing meets them. False where a step cannot hold that.
bool EventDrivenGroup::fly(double begin, double span)
{
    const bool acted_on = std::any_of(bodies_.begin(), bodies_.end(), [&](std::uint32_t body) {
        return scene_.forces.act_on(body);
    });
    spend(bodies_.size());
    const RigidFacts facts{scene_.forces, scene_.masses, scene_.poses, scene_.velocities};
    if (!scene_.forces.springs.empty() && by_stiff_springs(scene_.context, facts, bodies_)) {
        StiffFlight flight(rule_, facts, bodies_, scene_.flights);
        flight.carry(begin, span);
        return note_ends(flight.law());
    }
    law_.take(bodies_, scene_.flights);
    law_.advance(integrator_of(scene_.context, acted_on), begin, span, scratch_);
    law_.settle();
    return note_ends(law_);
}

bool EventDrivenGroup::note_ends(const RigidMotion& law)
{
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const RigidMotion::Outcome now = law.outcome(i);
        ends_[i] = {{now.position, now.orientation}, now.linear, now.angular, now.memory, true};
        if (!holdable(now)) return false;
    }
    return true;
}

void EventDrivenGroup::add_pair(std::uint32_t a, std::uint32_t b)
{
    if (scene_.filter.allows(a, b)) pairs_.push_back(pair_key(a, b));
}

// Those whose boxes round the way just ahead meet.
void EventDrivenGroup::find_pairs(double begin, double span)
{
    const Colliders& colliders = scene_.colliders;
    boxes_.clear();
    pairs_.clear();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const std::uint32_t body = bodies_[i];
        const double beyond = beyond_ends(ends_[i].spin.norm() * span);
        for (std::uint32_t k = 0; k < colliders.count[body]; ++k) {
            const std::uint32_t at = colliders.begin[body] + k;
            Box3 box =
                joined(scene_.box_of(at, scene_.poses.at(body)), scene_.box_of(at, ends_[i].pose));
            const double slack = beyond * (colliders.outer_radius[at] + scene_.beyond_mesh(at))
                + scene_.touching_margin(at);
            box.lower.array() -= slack;
            box.upper.array() += slack;
            scene_.ways[body] = joined(scene_.ways[body], box);
            boxes_.emplace_back(at, box);
        }
    }
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        for (std::size_t j = i + 1; j < boxes_.size(); ++j)
            if (boxes_[i].second.overlaps(boxes_[j].second))
                add_pair(boxes_[i].first, boxes_[j].first);
        for (const std::uint32_t at : scene_.obstacles) {
            const std::uint32_t body = colliders.body[at];
            Box3 box = scene_.box_of(at, pose_at(body, begin));
            if (scene_.states.kind[body] == BodyKind::kinematic) {
                box = joined(box, scene_.box_of(at, pose_at(body, begin + span)));
                const double angle = scene_.velocities.angular[body].norm() * span;
                const double slack =
                    beyond_ends(angle) * (colliders.outer_radius[at] + scene_.beyond_mesh(at));
                box.lower.array() -= slack;
                box.upper.array() += slack;
            }
            if (boxes_[i].second.overlaps(box)) add_pair(boxes_[i].first, at);
        }
    }
    std::sort(pairs_.begin(), pairs_.end());
    spend(boxes_.size() * (boxes_.size() + scene_.obstacles.size()) / kBoxPairs);
}

// The first touch of those asked about that do not touch yet.
FirstImpact EventDrivenGroup::look_ahead(std::span<const PairKey> asked, double begin, double span)
{
    const Colliders& colliders = scene_.colliders;
    std::vector<MovingShape> shapes;
    std::vector<ImpactPair> pairs;
    const auto add = [&](std::uint32_t at) {
        const std::uint32_t body = colliders.body[at];
        const std::int32_t member = member_of(body);
        const Vec3 spin = member >= 0 ? ends_[static_cast<std::size_t>(member)].spin
                                      : scene_.velocities.angular[body];
        const Pose from = pose_at(body, begin), to = end_of(body, begin + span);
        const ShapeRef shape = colliders.shape[at];
        shapes.push_back({shape, trajectory_of(scene_.masses, body, from, to, spin * span),
                          colliders.local[at]});
        shapes.back().pieces = shape.kind == ShapeKind::solid;
        return static_cast<std::uint32_t>(shapes.size() - 1);
    };
    for (const PairKey key : asked) {
        const std::uint32_t a = add(first_of(key)), b = add(second_of(key));
        pairs.push_back({a, b});
    }
    const FirstImpact first = first_impact(scene_.shapes, shapes, pairs, 0, 1,
                                           scene_.impacts.method, scene_.impacts.tolerance);
    spend(pairs.size() + static_cast<std::size_t>(first.impact.evaluations) / kEvaluations);
    return first;
}

void EventDrivenGroup::commit()
{
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const std::uint32_t body = bodies_[i];
        const End& end = ends_[i];
        scene_.poses.position[body] = end.pose.position;
        scene_.poses.orientation[body] = end.pose.orientation;
        scene_.velocities.linear[body] = end.velocity;
        scene_.velocities.angular[body] = end.spin;
        if (end.flew) scene_.flights.memory[body] = end.memory;
    }
    for (std::size_t k = 0; k < resting_.size(); ++k)
        note_push(contacts_[resting_[k]], pressed_[k].impulse);
}

GroupOutcome EventDrivenGroup::outcome() const
{
    GroupOutcome outcome = outcome_;
    outcome.pairs = pairs_.size();
    outcome.touching = separation_now_.size();
    outcome.points = contacts_.size();
    return outcome;
}

}  // namespace throng
