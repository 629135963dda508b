// World edit: bodies removed, moved and pushed from outside, between steps.
//
// The step keeps much from one step to the next; what a change from outside makes stale is put
// right here, so that no stage has to wonder.
#include "kernels/math/rotation.hpp"
#include "pipeline/contacts/wake_pairs.hpp"
#include "pipeline/world/force_builder.hpp"
#include "pipeline/world/world_state.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace throng {

void WorldState::wake(std::uint32_t body)
{
    auto& states = get<BodyStates>();
    states.sleep_time[body] = 0;
    if (const std::uint32_t island = states.sleeping_island[body]; island != kNoBody)
        wake_island(island, get<SleepingIslands>(), states, get<SleepingPairs>(), woken);
}

void WorldState::wake_beside(std::uint32_t body)
{
    wake(body);
    if (rests_by_force(settings) && get<BodyStates>().dynamic(body))
        get<RestingBodies>().waking.push_back({body, RestingBodies::kFarthest});
}

void WorldState::mark_changed(std::uint32_t body)
{
    const auto& colliders = get<Colliders>();
    auto& bounds = get<Bounds>();
    for (std::uint32_t i = 0; i < colliders.count[body]; ++i)
        bounds.touched.push_back(colliders.begin[body] + i);
    note_moved(body);
    get<SplitImpulse>().place(body);
    get<OverloadedIslands>().forget(body);
    auto& lags = get<Flights>().lags;
    if (body < lags.size()) lags[body] = 0;
}

void WorldState::note_moved(std::uint32_t body)
{
    if (queries == nullptr || moved.all) return;
    const auto& colliders = get<Colliders>();
    for (std::uint32_t i = 0; i < colliders.count[body]; ++i)
        moved.some.push_back(colliders.begin[body] + i);
    // Nobody has asked for long.
    moved.all = moved.some.size() > colliders.size();
    if (moved.all) moved.some.clear();
}

// Pairs are in order of their keys, so that to find those of one body takes a look at all of them:
// once a step, for whatever was done since the last one.
void WorldState::disturb(std::uint32_t body, bool goes)
{
    const auto& colliders = get<Colliders>();
    edits.resize(colliders.size(), 0);
    for (std::uint32_t i = 0; i < colliders.count[body]; ++i) {
        const std::uint32_t collider = colliders.begin[body] + i;
        if (edits[collider] == 0) edited.push_back(collider);
        edits[collider] |= goes ? kDisturbed | kGone : kDisturbed;
    }
    for (const std::uint32_t island : islands_beside(body, get<SleepingPairs>()))
        if (const auto& bodies = get<SleepingIslands>().bodies[island]; !bodies.empty())
            wake_beside(bodies.front());
}

void WorldState::wake_pairs()
{
    contacts_as_stepped = false;
    get<Pairs>().changed = false;  // whatever follows the list has followed it by now
    std::visit(
        [](auto& chosen) {
            using Real = typename std::decay_t<decltype(chosen)>::Number;
            throng::wake_pairs<Real>(std::get<Colliders>(chosen.data), pair_data(chosen.data));
        },
        step);
}

void WorldState::call_all_pairs()
{
    call_all(get<SleepingPairs>());
    wake_pairs();
}

void WorldState::settle()
{
    if (!get<SleepingPairs>().called.empty()) wake_pairs();
    if (edited.empty()) return;
    const auto& colliders = get<Colliders>();
    edits.resize(colliders.size(), 0);
    bool gone = false;
    for (const PairKey key : get<Pairs>().keys) {
        const std::uint32_t a = first_of(key), b = second_of(key);
        const std::uint8_t edit_a = edits[a], edit_b = edits[b];
        if ((edit_a | edit_b) == 0) continue;
        gone = gone || ((edit_a | edit_b) & kGone) != 0;
        if (edit_a != 0 && colliders.body[b] != kNoBody) wake_beside(colliders.body[b]);
        if (edit_b != 0 && colliders.body[a] != kNoBody) wake_beside(colliders.body[a]);
    }
    wake_pairs();
    if (gone && listens()) end_touches_of_gone();
    if (gone) forget_pairs();
    for (const std::uint32_t collider : edited) edits[collider] = 0;
    edited.clear();
}

void WorldState::forget_pairs()
{
    contacts_as_stepped = false;
    const auto goes = [&](PairKey key) {
        return ((edits[first_of(key)] | edits[second_of(key)]) & kGone) != 0;
    };
    std::visit(
        [&](auto& chosen) {
            using Real = typename std::decay_t<decltype(chosen)>::Number;
            drop_pairs<Real>(goes, pair_data(chosen.data));
        },
        step);
}

void WorldState::wake_all()
{
    for (std::uint32_t body = 0; body < generation.size(); ++body) wake(body);
}

void WorldState::quarantine(std::uint32_t body)
{
    StepDiagnostics diagnostics;
    diagnostics.quarantined = {body};
    quarantine_bodies(diagnostics, get<BodyStates>(), get<Masses>(), get<Velocities>());
    ++report.bodies_quarantined;
    mark_changed(body);
    changed.push_back(body);
    active_bodies_stopped = true;
}

void WorldState::set_velocities(std::uint32_t body, const Vec3& linear, const Vec3& angular)
{
    const auto& states = get<BodyStates>();
    const auto& masses = get<Masses>();
    auto& velocities = get<Velocities>();
    wake(body);
    if (states.kind[body] == BodyKind::static_) return;
    // What is locked stays locked.
    const bool moves = !states.dynamic(body) || masses.inverse_mass[body] > 0;
    const bool turns = !states.dynamic(body) || masses.inverse_inertia[body] != Sym3{};
    velocities.linear[body] = moves ? linear : Vec3(Vec3::Zero());
    velocities.angular[body] = turns ? angular : Vec3(Vec3::Zero());
    if (!holdable(velocities.linear[body]) || !holdable(velocities.angular[body])) quarantine(body);
    changed.push_back(body);
}

void WorldState::empty_unused()
{
    const Set<Effect> on = effects.on;
    if (!on.has(Effect::sleeping)) {
        wake_all();
        wake_pairs();
    }
    if (!on.has(Effect::sleeping) || !rests_by_force(settings)) get<RestingBodies>() = {};
    if (!on.has(Effect::escalation)) get<OverloadedIslands>().efforts.clear();
    if (!may_escalate(settings)) get<OverloadedIslands>().forget_all();
    if (!on.meets(kEventDriven)) {
        auto& diagnostics = get<StepDiagnostics>();
        diagnostics.held_groups = diagnostics.deep_pieces = 0;
        diagnostics.deepest = 0;
        get<EventDrivenContacts>() = {};
    }
    std::visit(
        [&](auto& chosen) {
            using Real = typename std::decay_t<decltype(chosen)>::Number;
            const auto empty = [&](auto... kinds) {
                ((std::get<decltype(kinds)>(chosen.data) = {}), ...);
            };
            if (!on.has(Effect::mesh_contact)) empty(MeshContacts<Real>{});
            if (!on.meets(kSolidContact)) empty(SolidContacts<Real>{});
            if (on.has(Effect::contact)) return;
            empty(Pairs{}, ConvexContacts<Real>{}, MethodPairs{}, SleepingPairs{},
                  SleepingContacts<Real>{}, ActiveContacts{}, Islands{}, Layout{},
                  ContactConstraints<Real>{}, ExternalAcceleration{});
        },
        step);
}

void World::remove(std::span<const BodyId> bodies)
{
    const Door::Entry entry(state_->door, "remove");
    WorldState& state = *state_;
    for (const BodyId id : bodies) state.place_of(id, "remove");
    state.follow_changes();
    auto& states = state.get<BodyStates>();
    auto& colliders = state.get<Colliders>();
    const EffectFacts facts = state.effect_facts();
    std::vector<std::uint32_t> going;
    bool sensor_goes = false;
    // What rested on them has to notice; and whoever takes their places next is somebody else.
    for (const BodyId id : bodies) {
        const std::uint32_t body = id.index;
        if (states.kind[body] == BodyKind::removed) continue;
        going.push_back(body);
        state.wake(body);
        state.disturb(body, true);
        state.mark_changed(body);
        states.kind[body] = BodyKind::removed;
        states.awake[body] = 0;
        state.get<EffectCensus>().recount(body, facts.bodies);
        const std::uint32_t first = colliders.begin[body], count = colliders.count[body];
        for (std::uint32_t i = 0; i < count; ++i) {
            // Of those who held a place since the last step, the first touched somebody.
            if (state.listens()) state.gone.emplace(first + i, state.owner_of(first + i));
            colliders.body[first + i] = kNoBody;
            state.get<PairFilter>().mask[first + i] = 0;
        }
        if (count > 0) state.free_colliders[count].push_back(first);
        state.get<PrescribedVelocities>().erase(body);
        if (body < state.names.size()) state.names[body].clear();
        state.applied_forces.erase(body);
        if (body < state.user_data.size()) state.user_data[body] = 0;
        state.kept_masses.erase(body);
        sensor_goes = state.sensors.erase(body) > 0 || sensor_goes;
        ++state.generation[body];
        state.free_bodies.push_back(body);
        std::push_heap(state.free_bodies.begin(), state.free_bodies.end(), std::greater<>());
        --state.alive;
    }
    if (sensor_goes) state.call_sensors();
    if (!state.get<Forces>().springs.empty()) state.census_stale = true;
    drop_forces(going, states, state.get<Forces>());
    if (state.fields.remove(going, state.get<Forces>())) state.wake_all();
    state.effects_stale = state.active_bodies_stopped = true;
    // Whoever comes into an empty world begins from nothing, as in its first step.
    if (!state.get<EffectCensus>().any(Call::dynamic)) state.get<StepContext>().last_substep = 0;
}

void World::set_force_field(ForceField field)
{
    const Door::Entry entry(state_->door, "set_force_field");
    WorldState& state = *state_;
    state.get<Forces>().field = std::move(field);
    state.wake_all();
    state.effects_stale = state.census_stale = true;
}

void WorldState::place(std::uint32_t body, const Pose& pose)
{
    auto& poses = get<Poses>();
    poses.orientation[body] =
        Quat(pose.orientation.coeffs() / std::sqrt(pose.orientation.squaredNorm()));
    poses.position[body] = poses.orientation[body] * center[body] + pose.position;
    disturb(body, false);
    wake(body);
    mark_changed(body);
}

void World::set_pose(BodyId body, const Pose& pose)
{
    const Door::Entry entry(state_->door, "set_pose");
    const std::uint32_t at = state_->place_of(body, "set_pose");
    const double length = std::sqrt(pose.orientation.squaredNorm());
    if (!holdable(pose.position) || !(std::abs(length - 1) < 1e-6))
        throw std::invalid_argument("set_pose: give a finite position and a unit quaternion");
    state_->place(at, pose);
}

void World::set_velocity(BodyId body, const Vec3& linear, const Vec3& angular)
{
    const Door::Entry entry(state_->door, "set_velocity");
    const std::uint32_t at = state_->place_of(body, "set_velocity");
    if (!linear.allFinite() || !angular.allFinite())
        throw std::invalid_argument("set_velocity: give finite numbers, m/s and rad/s");
    state_->set_velocities(at, linear, angular);
}

}  // namespace throng
