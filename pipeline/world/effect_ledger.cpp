#include "throng/effect_ledger.hpp"

#include "pipeline/step/step_table.hpp"
#include "pipeline/world/world_state.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

template <class... Lists>
std::size_t bytes_of(const Lists&... lists)
{
    return (std::size_t{0} + ... + (lists.capacity() * sizeof(lists[0])));
}

class Bookkeeping {
public:
    Bookkeeping(const WorldState& state, std::span<const StageReport> stages)
        : state_(state), on_(state.effects.on), facts_(state.effect_facts()), stages_(stages)
    { }

    EffectEntry entry(Effect effect) const
    {
        EffectEntry entry;
        entry.effect = effect;
        entry.on = on_.has(effect);
        entry.first = state_.effects.cause_of(effect);
        if (entry.on) {
            entry.callers = callers(effect);
            entry.rows = rows(effect);
            const NeglectedEffects::Share neglected = neglected_of(effect);
            entry.neglected = neglected.callers;
            entry.bound = neglected.bound;
        }
        std::visit(
            [&](const auto& chosen) {
                using Real = typename std::decay_t<decltype(chosen)>::Number;
                entry.bytes = bytes<Real>(effect, chosen.data);
                if (entry.on) share_stages<Real>(effect, entry);
            },
            state_.step);
        return entry;
    }

private:
    template <class Real>
    void share_stages(Effect effect, EffectEntry& entry) const
    {
        for (const Stage<Real>& stage : stages_for<Real>(on_, state_.settings)) {
            if (!stage.called_for_by.has(effect)) continue;
            entry.stages.push_back(stage.name);
            const auto same = [&](const StageReport& report) { return report.name == stage.name; };
            const auto found = std::find_if(stages_.begin(), stages_.end(), same);
            if (found == stages_.end()) continue;
            int sharers = 0;
            for (int i = 0; i < kEffects; ++i) {
                const auto other = static_cast<Effect>(i);
                sharers += on_.has(other) && stage.called_for_by.has(other) ? 1 : 0;
            }
            entry.ms += found->time_ms / sharers;
        }
    }

    NeglectedEffects::Share neglected_of(Effect effect) const
    {
        const auto& neglected = state_.get<NeglectedEffects>();
        if (effect == Effect::gyroscopic) return neglected.gyroscopic;
        if (effect == Effect::rolling_friction) return neglected.rolling_friction;
        return {};
    }

    bool meets() const { return on_.has(Effect::contact) || on_.meets(kEventDriven); }

    std::size_t callers(Effect effect) const
    {
        const EffectCensus& census = state_.get<EffectCensus>();
        const Forces& forces = facts_.bodies.forces;
        const bool rubs = on_.has(Effect::friction);
        switch (effect) {
        case Effect::motion:
            return census.count(Call::motion);
        case Effect::gravity:
            return census.count(Call::falls);
        case Effect::forces:
            return forces.field ? census.count(Call::dynamic) : census.count(Call::forces);
        case Effect::drive:
            return facts_.prescribed.body.size();
        case Effect::rotation:
            return census.count_any({Call::turns, meets() ? Call::turns_touched : Call::turns,
                                     meets() && rubs ? Call::turns_rubbed : Call::turns});
        case Effect::gyroscopic:
            return census.count_any(
                {Call::uneven_turns, meets() ? Call::uneven_turns_touched : Call::uneven_turns,
                 meets() && rubs ? Call::uneven_turns_rubbed : Call::uneven_turns});
        case Effect::contact:
        case Effect::no_overlap:
        case Effect::little_overlap:
        case Effect::sleeping:
            return census.count(Call::dynamic);
        case Effect::friction:
        case Effect::rolling_friction:
        case Effect::restitution:
            return material_pairs(effect);
        case Effect::fast_motion:
            return std::max<std::size_t>(1, census.count(Call::fast));
        case Effect::mesh_contact:
            return census.count(Call::mesh_contact);
        case Effect::voxel_contact:
            return census.count(Call::voxel_contact);
        case Effect::sphere_contact:
            return census.count(Call::sphere_contact);
        case Effect::image_contact:
            return census.count(Call::image_contact);
        case Effect::seams:
            return census.count(Call::rimmed_seam);
        case Effect::springs:
            return forces.springs.size();
        case Effect::attractors:
            return forces.attractors.size();
        case Effect::wind:
        case Effect::drag:
            return std::max<std::size_t>(1, census.count(Call::drag));
        case Effect::pivot:
            return census.count(Call::pivot);
        case Effect::escalation:
            return state_.get<OverloadedIslands>().strained.size();
        case Effect::events:
            return 1;
        case Effect::sensors:
            return state_.sensors.size();
        }
        return 0;
    }

    std::size_t material_pairs(Effect effect) const
    {
        std::size_t pairs = 0;
        const auto& materials = state_.get<EffectCensus>().materials();
        for (const auto& [a, use_a] : materials)
            for (const auto& [b, use_b] : materials) {
                if (b < a || use_a.on_dynamic + use_b.on_dynamic == 0) continue;
                const Surfaces::MaterialPair both = facts_.surfaces.between(a, b);
                const double value = effect == Effect::friction ? both.friction
                    : effect == Effect::restitution             ? both.restitution
                                                                : both.rolling_friction;
                pairs += value > 0 ? 1 : 0;
            }
        return pairs;
    }

    // Normal rows a point; friction two and a twist at each manifold, or two a point; rolling
    // three.
    std::size_t rows(Effect effect) const
    {
        const bool at_points = state_.get<SolverParameters>().friction_at_points_or_pyramid(on_);
        std::size_t rows = 0;
        for (const ActiveContacts::Entry& entry : state_.get<ActiveContacts>().entries) {
            if (effect == Effect::contact) rows += entry.points;
            if (effect == Effect::friction && entry.friction > 0)
                rows += at_points ? 2u * entry.points : 3u;
            if (effect == Effect::restitution && entry.restitution > 0) rows += entry.points;
            if (effect == Effect::rolling_friction && entry.rolling_friction > 0) rows += 3;
        }
        if (effect == Effect::springs) rows = facts_.bodies.forces.springs.size();
        if (effect == Effect::drive)
            for (const PrescribedVelocity& velocity : facts_.prescribed.velocity)
                rows += static_cast<std::size_t>(std::count_if(
                    velocity.begin(), velocity.end(), [](double v) { return !std::isnan(v); }));
        return rows;
    }

    template <class Real>
    std::size_t bytes(Effect effect, const StepData<Real>& data) const
    {
        const auto& constraints = std::get<ContactConstraints<Real>>(data);
        const Forces& forces = facts_.bodies.forces;
        switch (effect) {
        case Effect::contact:
            return contact_bytes<Real>(data);
        case Effect::friction:
            return bytes_of(constraints.point_frictions);
        case Effect::rolling_friction:
            return bytes_of(constraints.rolling_frictions);
        case Effect::restitution:
            return bytes_of(constraints.restitutions,
                            std::get<JoinedContacts<Real>>(data).contacts);
        case Effect::gyroscopic:
            return bytes_of(constraints.inertias);
        case Effect::fast_motion:
            return bytes_of(std::get<Bounds>(data).kept, std::get<Bounds>(data).fast);
        case Effect::seams:
            return bytes_of(std::get<GhostMarks>(data).touches);
        case Effect::mesh_contact: {
            const auto& meshes = std::get<MeshContacts<Real>>(data);
            return bytes_of(meshes.entries, meshes.before, meshes.found.manifolds);
        }
        case Effect::voxel_contact:
        case Effect::sphere_contact:
        case Effect::image_contact: {
            // They share their lists.
            if (!on_.has(effect) && on_.meets(kSolidContact)) return 0;
            const auto& solids = std::get<SolidContacts<Real>>(data);
            return bytes_of(solids.entries, solids.before, solids.found.manifolds);
        }
        case Effect::springs:
            return bytes_of(forces.springs, forces.spring_of, forces.first_spring, forces.group_of);
        case Effect::forces:
            return bytes_of(forces.force, forces.torque);
        case Effect::attractors:
            return bytes_of(forces.attractors);
        case Effect::drag:
            return bytes_of(forces.linear_drag, forces.angular_drag);
        case Effect::pivot:
            return bytes_of(forces.pivot_to_center, forces.has_pivot);
        case Effect::drive:
            return bytes_of(facts_.prescribed.body, facts_.prescribed.velocity,
                            constraints.prescribed);
        case Effect::sleeping: {
            const auto& contacts = std::get<SleepingContacts<Real>>(data);
            return bytes_of(std::get<SleepingPairs>(data).kept,
                            std::get<SleepingIslands>(data).bodies, contacts.of_kept,
                            contacts.contacts, contacts.found, std::get<RestingBodies>(data).borne);
        }
        case Effect::escalation:
            return bytes_of(std::get<OverloadedIslands>(data).efforts);
        case Effect::events: {
            const auto& touching = std::get<TouchingPairs>(data);
            return bytes_of(touching.keys, touching.scratch.before, touching.approaches);
        }
        default:
            return 0;
        }
    }

    template <class Real>
    static std::size_t contact_bytes(const StepData<Real>& data)
    {
        const auto& pairs = std::get<Pairs>(data);
        const auto& convex = std::get<ConvexContacts<Real>>(data);
        const auto& constraints = std::get<ContactConstraints<Real>>(data);
        const auto& layout = std::get<Layout>(data);
        const auto& bounds = std::get<Bounds>(data);
        const auto& overloaded = std::get<OverloadedIslands>(data);
        return bytes_of(overloaded.strain, overloaded.strained, pairs.keys, pairs.from,
                        convex.of_pair, convex.contacts, convex.found,
                        std::get<ActiveContacts>(data).entries, constraints.blocks,
                        constraints.points, constraints.bodies, layout.lanes,
                        layout.body_of_solver_index, bounds.boxes, bounds.near, bounds.placed);
    }

    const WorldState& state_;
    Set<Effect> on_;
    EffectFacts facts_;
    std::span<const StageReport> stages_;
};

}  // namespace

std::vector<EffectEntry> effect_ledger(World& world, std::span<const StageReport> stages)
{
    static_cast<void>(world.effects());  // with the names of who calls
    const Bookkeeping books(state_of(world), stages);
    std::vector<EffectEntry> entries;
    for (int i = 0; i < kEffects; ++i) entries.push_back(books.entry(static_cast<Effect>(i)));
    return entries;
}

}  // namespace throng
