// Sort islands: what each calls for of its solve, and those that call for the same side by side.
//
// Batches are made of neighbors that call for the same. So what is not called for is not in the
// solve of an island whatever others do, far away, and its bits are those that it would have alone.
#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/coloring.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "pipeline/contacts/contact_lists.hpp"
#include "pipeline/forces/state_dependent_forces.hpp"
#include "pipeline/step/neglect.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

constexpr std::size_t kIslands = 16;  // a block

// What contacts alone tell.
constexpr Set<Effect> kByContacts = {Effect::friction, Effect::rolling_friction,
                                     Effect::restitution};

constexpr std::uint32_t kMayTurn = EffectCensus::bit(Call::turns)
    | EffectCensus::bit(Call::turns_touched) | EffectCensus::bit(Call::turns_rubbed);
constexpr std::uint32_t kActedOn = EffectCensus::bit(Call::forces) | EffectCensus::bit(Call::drag)
    | EffectCensus::bit(Call::pivot);

// Who is held at more places rolls nowhere: in a heap to follow him would cost a fifth of the step.
constexpr std::uint32_t kMostRimContacts = 2;
constexpr double kRollSeen = 1e-4;  // rad, in a step

// Overlap from which who was put somewhere may have to part, and who is wedged: less than
// split_impulse.cpp has, as shares of the half extent.
constexpr double kMayPart = 1e-5, kMayBeWedged = 0.1;

// Rolling friction may be neglected in what has been slow enough to sleep for this share of the
// time that it takes to.
constexpr double kSoon = 0.25;

// A carrier is looked for with this much to spare: contacts decide, in their own precision.
constexpr double kToSpare = 1 + 1e-5;

template <class Real>
struct IslandFacts {
    const StepContext& context;
    const NeglectParameters& neglect;
    const SleepParameters& sleep;
    const ActiveContacts& contacts;
    const BodyStates& states;
    const Poses& poses;
    const Velocities& velocities;
    const Masses& masses;
    const Forces& forces;
    const Shapes& shapes;
    const Colliders& colliders;
    const EffectCensus& census;
    const PrescribedVelocities& prescribed;
    const SplitImpulse& split_impulse;
    const ConvexContacts<Real>& convex;
    const MeshContacts<Real>& meshes;
    const SolidContacts<Real>& solids;
    const JoinedContacts<Real>& joined;

    const Set<Effect> by_contacts = context.effects & kByContacts;
    const bool acted_on = context.effects.meets(kForces), drives = context.has(Effect::drive),
               turn = context.has(Effect::rotation),
               // Touched by what moves by itself; by what is round, for flat ones.
        sides = !states.active_bodies.kinematic.empty() || states.conveyors,
               rounds = !shapes.capsules.empty() || !shapes.cylinders.empty(),
               wedges = !solids.entries.empty() || colliders.compounds,
               acts_on_all = acted_on && (forces.field || !forces.attractors.empty()),
               springs_act = acted_on && !forces.springs.empty(),
               neglects = neglect.some && context.has(Effect::sleeping) && context.last_substep > 0;
};

// One island.
template <class Real>
class IslandSearch {
public:
    IslandSearch(const IslandFacts<Real>& scene, const Islands& islands, std::size_t island)
        : scene_(scene), bodies_(islands.bodies_of(island)), contacts_(islands.contacts_of(island))
    { }

    // Adds to the bodies whose rims are followed.
    IslandCalls find(std::vector<Islands::Rolling>& rolling, NeglectedEffects::Share& neglected)
    {
        for (const std::uint32_t body : bodies_) shapes_ |= scene_.colliders.shape_bits[body];
        ask_contacts();  // first: friction turns bodies
        const std::uint32_t asked = (scene_.turn ? kMayTurn : 0) | (scene_.acted_on ? kActedOn : 0);
        for (const std::uint32_t body : bodies_) {
            const std::uint32_t calls = scene_.census.calls_of(body) & asked;
            if ((calls & kMayTurn) != 0) find_turning(body);
            if ((calls & kActedOn) != 0 || scene_.acts_on_all
                || (scene_.springs_act && scene_.forces.has_springs(body)))
                find_forces(body);
            if (scene_.drives && scene_.prescribed.drives(body)) calls_.effects.add(Effect::drive);
        }
        if (!calls_.alone) calls_.alone = may_part();
        if (spins_ || !sides_.empty()) find_carriers();
        if (spins_ && calls_.effects.has(Effect::gyroscopic)
            && calls_.effects.has(Effect::friction))
            find_turning_axes();
        if ((shapes_ & Colliders::kRim) != 0) find_rolling(rolling);
        if (scene_.neglects && calls_.effects.has(Effect::rolling_friction) && sleeps_soon())
            neglect_rolling_friction(neglected);
        const unsigned swings =
            Colliders::kMayHang | ((all_shapes_ & Colliders::kRound) != 0 ? Colliders::kFlat : 0u);
        calls_.swings = calls_.rolls || (shapes_ & swings) != 0;
        return calls_;
    }

private:
    bool on(Effect effect) const { return scene_.context.has(effect); }
    void call_if(bool calls, Effect effect)
    {
        if (calls) calls_.effects.add(effect);
    }

    // Of a big island as far as there is something left to find.
    void ask_contacts()
    {
        all_shapes_ = shapes_;
        const bool small = contacts_.size() <= kBatchContacts;
        const bool sides = scene_.sides || (scene_.rounds && (shapes_ & Colliders::kFlat) != 0);
        std::size_t on_faces = 0, on_points = 0;
        for (const std::uint32_t place : contacts_) {
            const bool found = (calls_.effects & kByContacts) == scene_.by_contacts;
            if (!small && !sides && found) break;
            const ActiveContacts::Entry& entry = scene_.contacts.entries[place];
            on_faces += entry.points >= 3 ? 1 : 0;
            on_points += entry.points == 1 ? 1 : 0;
            if (!found) ask_materials(place);
            if (!sides) continue;
            ask_side(entry.body_a);
            ask_side(entry.body_b);
        }
        calls_.on_faces = small && 2 * on_faces > contacts_.size();
        calls_.on_points = small && on_points == contacts_.size();
    }

    // What is too little for float to hold is still called for.
    void ask_materials(std::uint32_t place)
    {
        const auto ask = [&](const auto& pair) {
            const auto call = [&](auto value, Effect effect) {
                if (value > 0 && scene_.by_contacts.has(effect)) calls_.effects.add(effect);
            };
            call(pair.friction, Effect::friction);
            call(pair.rolling_friction, Effect::rolling_friction);
            call(pair.restitution, Effect::restitution);
        };
        if (scene_.contacts.materials.empty())
            ask(scene_.contacts.entries[place]);
        else
            ask(scene_.contacts.materials[place]);
    }

    // Whether somebody may lie too deep in another for the usual push.
    bool may_part() const
    {
        const bool placed = scene_.split_impulse.some
            && std::any_of(bodies_.begin(), bodies_.end(),
                           [&](std::uint32_t body) { return scene_.split_impulse.knows(body); });
        if (!placed && !scene_.wedges) return false;
        const auto& count = scene_.colliders.count;
        return std::any_of(contacts_.begin(), contacts_.end(), [&](std::uint32_t place) {
            const ActiveContacts::Entry& entry = scene_.contacts.entries[place];
            const bool wedges = entry.list == ContactList::solid
                || (count[entry.body_a] > 1 && count[entry.body_b] > 1);
            if (!placed && !wedges) return false;
            return double{contact_at(entry).overlap(entry.points)}
            > (placed ? kMayPart : kMayBeWedged) * double{entry.extent};
        });
    }

    // Whether all of it has lain still for long, on what does not move.
    bool sleeps_soon() const
    {
        const double soon = kSoon * scene_.sleep.time;
        return sides_.empty() && !calls_.driven && !calls_.effects.has(Effect::drive)
            && std::all_of(bodies_.begin(), bodies_.end(), [&](std::uint32_t body) {
                   return scene_.states.sleep_time[body] >= soon;
               });
    }

    // What it gave in the last step that had it would hardly turn anybody.
    void neglect_rolling_friction(NeglectedEffects::Share& neglected)
    {
        NeglectedEffects::Share share;
        std::vector<double> impulses(bodies_.size());  // N m s on each, in a substep
        for (const std::uint32_t place : contacts_) {
            const ActiveContacts::Entry& entry = scene_.contacts.entries[place];
            if (!(entry.rolling_friction > 0)) continue;
            ++share.callers;
            const double impulse = contact_at(entry).rolling.template cast<double>().norm();
            for (const std::uint32_t body : {entry.body_a, entry.body_b})
                if (scene_.states.movable(body)) impulses[place_of(body)] += impulse;
        }
        for (std::size_t i = 0; i < bodies_.size(); ++i)
            share.bound =
                std::max(share.bound,
                         turned_in_window(impulses[i] * inverse_mass_of(bodies_[i]).angular
                                          / scene_.context.last_substep));
        if (!(share.bound <= kOfError * scene_.neglect.error)) return;
        calls_.effects.remove(Effect::rolling_friction);
        neglected.add(share);
    }

    std::size_t place_of(std::uint32_t body) const
    {
        const auto at = std::lower_bound(bodies_.begin(), bodies_.end(), body);
        return static_cast<std::size_t>(at - bodies_.begin());
    }

    const Contact<Real>& contact_at(const ActiveContacts::Entry& entry) const
    {
        return contact_of(scene_.convex, scene_.meshes, scene_.solids, scene_.joined, entry);
    }

    // What contacts do not push.
    void ask_side(std::uint32_t body)
    {
        if (scene_.states.movable(body)) return;
        all_shapes_ |= scene_.colliders.shape_bits[body];
        const bool moves = scene_.states.kind[body] == BodyKind::kinematic;
        calls_.driven = calls_.driven || moves;
        call_if(on(Effect::rotation) && !scene_.velocities.angular[body].isZero(0),
                Effect::rotation);
        if ((moves || scene_.states.carries(body)) && (sides_.empty() || sides_.back() != body))
            sides_.push_back(body);
    }

    bool turns_free(std::uint32_t body) const
    {
        return scene_.masses.inverse_inertia[body] != Sym3{};
    }

    // As the census has it (see Call), of these bodies and contacts.
    void find_turning(std::uint32_t body)
    {
        const bool uneven = on(Effect::gyroscopic) && scene_.masses.gyroscopic_kind[body] != 0;
        const Effect asked = uneven ? Effect::gyroscopic : Effect::rotation;
        if (spins_ && calls_.effects.has(asked)) return;
        const bool spins = !scene_.velocities.angular[body].isZero(0);
        spins_ = spins_ || spins;
        if (calls_.effects.has(asked)) return;
        const bool touched = (scene_.colliders.shape_bits[body] & Colliders::kOffCenter) != 0
            || calls_.effects.has(Effect::friction);
        const bool turns = spins
            || (turns_free(body)
                && (scene_.forces.turn(body) || (touched && scene_.colliders.count[body] > 0)));
        call_if(turns, Effect::rotation);
        call_if(turns && uneven, Effect::gyroscopic);
    }

    void find_forces(std::uint32_t body)
    {
        const Forces& forces = scene_.forces;
        calls_.alone = calls_.alone || is_held_by_forces(body);
        const auto call = [&](bool acts, Effect effect) { call_if(acts && on(effect), effect); };
        call(forces.field || forces.push(body), Effect::forces);
        call(forces.has_springs(body), Effect::springs);
        call(!forces.attractors.empty(), Effect::attractors);
        call(forces.is_damped(body), Effect::drag);
        call(forces.is_damped(body) && !forces.wind.isZero(0), Effect::wind);
        call(forces.on_pivot(body), Effect::pivot);
    }

    // By what takes an island of its own: somebody on a pivot, or springs that are too stiff.
    bool is_held_by_forces(std::uint32_t body) const
    {
        const Forces& forces = scene_.forces;
        if (forces.on_pivot(body)) return true;
        if (!forces.depends_on_state(body)) return false;
        if (!(scene_.masses.inverse_mass[body] > 0)) return true;
        return forces.has_springs(body)
            && too_stiff(scene_.context, {forces, scene_.masses, scene_.poses, scene_.velocities},
                         forces.groups[forces.group_of[body]]);
    }

    InverseMass inverse_mass_of(std::uint32_t body) const
    {
        if (!scene_.states.dynamic(body)) return {};
        const Sym3& inverse = scene_.masses.inverse_inertia[body];
        return {scene_.masses.inverse_mass[body], inverse.xx + inverse.yy + inverse.zz};
    }

    // Whether anybody turns who would carry what is as light as any, and as easily turned. In most
    // islands nobody is ten times as heavy as another.
    void find_carriers()
    {
        const double dt = kToSpare * scene_.context.dt;
        const auto spin_of = [&](std::uint32_t body) { return scene_.velocities.angular[body]; };
        calls_.carries = std::any_of(sides_.begin(), sides_.end(), [&](std::uint32_t side) {
            return carries(spin_of(side), {}, {}, dt);
        });
        double heaviest = std::numeric_limits<double>::infinity(), lightest = 0;  // 1/kg
        for (const std::uint32_t body : bodies_) {
            heaviest = std::min(heaviest, scene_.masses.inverse_mass[body]);
            lightest = std::max(lightest, scene_.masses.inverse_mass[body]);
        }
        if (calls_.carries || heaviest * kHeavier > kToSpare * lightest) return;
        InverseMass carried;
        for (const std::uint32_t body : bodies_) {
            const InverseMass inverse_mass = inverse_mass_of(body);
            carried = {std::max(carried.linear, kToSpare * inverse_mass.linear),
                       std::max(carried.angular, kToSpare * inverse_mass.angular)};
        }
        calls_.carries = std::any_of(bodies_.begin(), bodies_.end(), [&](std::uint32_t body) {
            return carries(spin_of(body), inverse_mass_of(body), carried, dt);
        });
    }

    // Whether the axis of anybody goes along.
    void find_turning_axes()
    {
        calls_.axes_turn = std::any_of(bodies_.begin(), bodies_.end(), [&](std::uint32_t body) {
            const Vec3& spin = scene_.velocities.angular[body];
            const Vec3& axis = scene_.masses.symmetry_axis[body];
            return scene_.masses.gyroscopic_kind[body] != 0 && !spin.isZero(0) && !axis.isZero(0)
                && scene_.masses.inverse_mass[body] > 0
                && axis_turns(scene_.poses.orientation[body] * axis, spin, scene_.context.dt);
        });
    }

    bool has_rim(std::uint32_t body) const
    {
        return (scene_.colliders.shape_bits[body] & Colliders::kRim) != 0
            && scene_.states.movable(body);
    }

    // Those that turn, or touch somebody who does.
    void find_rolling(std::vector<Islands::Rolling>& rolling)
    {
        struct Rim {
            std::uint32_t contacts = 0;
            bool rolls = false;
        };
        std::vector<Rim> rims(bodies_.size());
        const double least = kRollSeen / scene_.context.dt;
        const auto turns = [&](std::uint32_t body) {
            return scene_.states.movable(body)
                && scene_.velocities.angular[body].squaredNorm() > least * least;
        };
        for (const std::uint32_t place : contacts_) {
            const ActiveContacts::Entry& entry = scene_.contacts.entries[place];
            const bool rolls = turns(entry.body_a) || turns(entry.body_b);
            for (const std::uint32_t body : {entry.body_a, entry.body_b}) {
                if (!has_rim(body)) continue;
                Rim& rim = rims[place_of(body)];
                ++rim.contacts;
                rim.rolls = rim.rolls || rolls;
            }
        }
        for (std::size_t i = 0; i < rims.size(); ++i) {
            calls_.rolls = calls_.rolls || rims[i].rolls;
            if (rims[i].rolls && rims[i].contacts <= kMostRimContacts)
                rolling.push_back({bodies_[i], rims[i].contacts});
        }
    }

    const IslandFacts<Real>& scene_;
    std::span<const std::uint32_t> bodies_, contacts_;
    IslandCalls calls_;
    unsigned shapes_ = 0, all_shapes_ = 0;  // bits of its bodies; and of all that they touch
    bool spins_ = false;
    std::vector<std::uint32_t> sides_;  // that it touches and that move or carry
};

// Islands side by side that call for the same.
struct Run {
    std::uint32_t kind = 0, first = 0, last = 0;
};

// Kinds count up in the order in which they come first.
std::vector<Run> runs_of(const std::vector<IslandCalls>& calls)
{
    std::vector<Run> runs;
    std::vector<std::uint32_t> first_of;  // [kinds] island
    for (std::uint32_t first = 0, last = 0; first < calls.size(); first = last) {
        while (last < calls.size() && calls[last] == calls[first]) ++last;
        const auto same = [&](std::uint32_t island) { return calls[island] == calls[first]; };
        const auto known = std::find_if(first_of.begin(), first_of.end(), same);
        const auto kind = static_cast<std::uint32_t>(known - first_of.begin());
        if (known == first_of.end()) first_of.push_back(first);
        runs.push_back({kind, first, last});
    }
    return runs;
}

// Lists by island in another order, run by run.
class Sorting {
public:
    explicit Sorting(Islands& islands) : islands_(islands), sorted_(islands.scratch)
    {
        sorted_.calls.resize(islands.calls.size());
        sorted_.bodies.resize(islands.bodies.size());
        sorted_.contacts.resize(islands.contacts.size());
        sorted_.body_begin.resize(islands.body_begin.size());
        sorted_.contact_begin.resize(islands.contact_begin.size());
        sorted_.body_begin.back() = islands.body_begin.back();
        sorted_.contact_begin.back() = islands.contact_begin.back();
    }

    void append(const Run& run)
    {
        const auto first = run.first, count = run.last - run.first;
        std::copy_n(islands_.calls.begin() + first, count, sorted_.calls.begin() + done_);
        append(first, count, islands_.body_begin, islands_.bodies, bodies_done_,
               sorted_.body_begin.data() + done_, sorted_.bodies);
        append(first, count, islands_.contact_begin, islands_.contacts, contacts_done_,
               sorted_.contact_begin.data() + done_, sorted_.contacts);
        done_ += count;
    }

    void finish()
    {
        sorted_.calls.swap(islands_.calls);
        sorted_.bodies.swap(islands_.bodies);
        sorted_.contacts.swap(islands_.contacts);
        sorted_.body_begin.swap(islands_.body_begin);
        sorted_.contact_begin.swap(islands_.contact_begin);
    }

private:
    static void append(std::size_t first,
                       std::size_t count,
                       const std::vector<std::uint32_t>& begins,
                       const std::vector<std::uint32_t>& items,
                       std::uint32_t& done,
                       std::uint32_t* new_begins,
                       std::vector<std::uint32_t>& sorted)
    {
        const std::uint32_t begin = begins[first], moved = done - begin;
        for (std::size_t i = 0; i < count; ++i) new_begins[i] = begins[first + i] + moved;
        const std::uint32_t items_of_run = begins[first + count] - begin;
        std::copy_n(items.begin() + begin, items_of_run, sorted.begin() + done);
        done += items_of_run;
    }

    Islands& islands_;
    Islands::Scratch& sorted_;
    std::size_t done_ = 0;
    std::uint32_t bodies_done_ = 0, contacts_done_ = 0;
};

void sort_by_calls(Islands& islands)
{
    std::vector<Run> runs = runs_of(islands.calls);
    const auto before = [](const Run& a, const Run& b) { return a.kind < b.kind; };
    if (std::is_sorted(runs.begin(), runs.end(), before)) return;
    std::stable_sort(runs.begin(), runs.end(), before);
    Sorting sorting(islands);
    for (const Run& run : runs) sorting.append(run);
    sorting.finish();
}

}  // namespace

template <class Real>
void sort_islands(const StepContext& context,
                  const NeglectParameters& neglect,
                  const SleepParameters& sleep,
                  const ActiveContacts& contacts,
                  const BodyStates& states,
                  const Poses& poses,
                  const Velocities& velocities,
                  const Masses& masses,
                  const Forces& forces,
                  const Shapes& shapes,
                  const Colliders& colliders,
                  const EffectCensus& census,
                  const PrescribedVelocities& prescribed,
                  const SplitImpulse& split_impulse,
                  const ConvexContacts<Real>& convex,
                  const MeshContacts<Real>& meshes,
                  const SolidContacts<Real>& solids,
                  const JoinedContacts<Real>& joined,
                  NeglectedEffects& neglected,
                  Islands& islands)
{
    const IslandFacts<Real> scene{context,    neglect,       sleep,  contacts, states,    poses,
                                  velocities, masses,        forces, shapes,   colliders, census,
                                  prescribed, split_impulse, convex, meshes,   solids,    joined};
    islands.calls.assign(islands.size(), {});
    const std::size_t blocks = block_count(islands.size(), kIslands);
    BlockLists<Islands::Rolling> rolling;
    rolling.start(blocks);
    std::vector<NeglectedEffects::Share>& of_block = neglected.scratch.of_block;
    of_block.assign(blocks, {});
    for_each_block(islands.size(), kIslands, [&](auto begin, auto end, auto block) {
        for (std::size_t island = begin; island < end; ++island)
            islands.calls[island] =
                IslandSearch<Real>(scene, islands, island).find(rolling[block], of_block[block]);
    });
    neglected.rolling_friction = {};
    for (const NeglectedEffects::Share& share : of_block) neglected.rolling_friction.add(share);
    islands.rolling.clear();
    rolling.append_to(islands.rolling);
    sort_by_calls(islands);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void sort_islands<Real>(                                                              \
        const StepContext&, const NeglectParameters&, const SleepParameters&,                      \
        const ActiveContacts&, const BodyStates&, const Poses&, const Velocities&, const Masses&,  \
        const Forces&, const Shapes&, const Colliders&, const EffectCensus&,                       \
        const PrescribedVelocities&, const SplitImpulse&, const ConvexContacts<Real>&,             \
        const MeshContacts<Real>&, const SolidContacts<Real>&, const JoinedContacts<Real>&,        \
        NeglectedEffects&, Islands&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
