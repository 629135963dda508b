// Rest bodies: who has been quiet long enough, and is borne steadily, comes to rest by itself; and
// whom a rest does not suit any more, as contacts bear something else on it than they did, is told
// to wake.
#include "pipeline/contacts/contact_lists.hpp"
#include "pipeline/contacts/fall_asleep.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

using Borne = RestingBodies::Borne;
using May = RestingBodies::Scratch::May;

// Of the tolerance: who changes by more from one step to the next is not borne steadily.
constexpr double kSteady = 0.5;

// Of the tolerance: a change that is felt as far as may be in the same step; any other by who
// touches him whom it wakes.
constexpr double kGreat = 10;
constexpr std::uint32_t kNear = 1;

// One call of the stage.
template <class Real>
class ComingToRest {
public:
    ComingToRest(const SleepParameters& parameters,
                 const Pairs& pairs,
                 const Colliders& colliders,
                 const ConvexContacts<Real>& convex,
                 const MeshContacts<Real>& meshes,
                 const SolidContacts<Real>& solids,
                 BodyStates& states,
                 SleepingIslands& sleeping_islands,
                 Velocities& velocities,
                 RestingBodies& resting,
                 SleepEvents& sleep_events)
        : parameters_(parameters), pairs_(pairs), colliders_(colliders), convex_(convex),
          meshes_(meshes), solids_(solids), states_(states), sleeping_islands_(sleeping_islands),
          velocities_(velocities), resting_(resting), sleep_events_(sleep_events)
    {
        const std::size_t bodies = states.kind.size();
        resting_.borne.resize(bodies);
        resting_.scratch.now.resize(bodies);
        resting_.scratch.may.resize(bodies, May::no);
        resting_.scratch.candidates.clear();
        resting_.scratch.touched.clear();
    }

    // Whose bodies have been counted already. What a pivot bears nobody asks.
    void find_candidates(std::span<const std::uint32_t> island, const Forces& forces)
    {
        const auto waited = [&](std::uint32_t body) {
            return states_.sleep_time[body] >= parameters_.time;
        };
        const bool all = parameters_.islands && std::all_of(island.begin(), island.end(), waited);
        for (const std::uint32_t body : island) {
            if (waited(body) && (all || !forces.on_pivot(body))) {
                may(body) = all ? May::yes : May::if_steady;
                resting_.scratch.candidates.push_back(body);
            } else {
                resting_.borne[body].load = -1;
            }
        }
    }

    void run()
    {
        std::vector<std::uint32_t>& candidates = resting_.scratch.candidates;
        std::sort(candidates.begin(), candidates.end());
        if (!candidates.empty() || sleeping_islands_.bodies.size() > sleeping_islands_.free.size())
            add_up();
        wake_changed();
        for (const std::uint32_t body : candidates) rest(body);
        for (const std::uint32_t body : candidates) may(body) = May::no;
        for (const std::uint32_t body : resting_.scratch.touched) now(body) = {};
    }

    void rest_alone(std::uint32_t body)
    {
        resting_.borne[body] = {{}, 0};
        sleep(body);
    }

private:
    Borne& now(std::uint32_t body) { return resting_.scratch.now[body]; }
    May& may(std::uint32_t body) { return resting_.scratch.may[body]; }

    void sleep(std::uint32_t body)
    {
        fall_asleep({&body, 1}, states_, sleeping_islands_, velocities_, sleep_events_);
    }

    // What contacts bear on who rests and who may come to.
    void add_up()
    {
        for_each_contact(pairs_, convex_, meshes_, solids_,
                         [&](PairKey key, const Contact<Real>& contact) {
                             const std::uint32_t a = colliders_.body[first_of(key)];
                             const std::uint32_t b = colliders_.body[second_of(key)];
                             add(contact, a, b, false);
                             add(contact, b, a, true);
                         });
    }

    void add(const Contact<Real>& contact, std::uint32_t body, std::uint32_t other, bool is_b)
    {
        if (contact.count == 0 || (may(body) == May::no && !states_.rests(body))) return;
        // What carries it, or may at any time, does not press it the more for it.
        if (may(body) == May::if_steady && carries(other)) may(body) = May::no;
        Borne& sum = now(body);
        if (sum.load < 0) {
            sum.load = 0;
            resting_.scratch.touched.push_back(body);
        }
        sum.load += load_of(contact);
        sum.impulse.add(borne_impulse(contact, is_b), 1);
    }

    bool carries(std::uint32_t body) const
    {
        return states_.carries(body)
            || (states_.kind[body] == BodyKind::kinematic
                && !(velocities_.linear[body].isZero(0) && velocities_.angular[body].isZero(0)));
    }

    // In units of what it bore: by how much that changed.
    double change(std::uint32_t body, const Borne& from, const Borne& to) const
    {
        const double load = std::max(from.load, std::numeric_limits<double>::min());
        return std::max((to.impulse.linear - from.impulse.linear).norm(),
                        (to.impulse.angular - from.impulse.angular).norm() / states_.radius[body])
            / load;
    }

    void wake_changed()
    {
        std::vector<std::uint32_t>& border = resting_.border;
        for (const std::uint32_t body : resting_.scratch.touched)
            if (states_.rests(body)) border.push_back(body);
        keep_each_once(border);
        resting_.waking.clear();
        const double most = parameters_.rest_force;
        for (const std::uint32_t body : border) {
            if (!states_.rests(body)) continue;
            const double by = change(body, resting_.borne[body], now(body));
            if (by > most)
                resting_.waking.push_back(
                    {body, by > kGreat * most ? RestingBodies::kFarthest : kNear});
        }
        std::erase_if(
            border, [&](std::uint32_t body) { return !states_.rests(body) || now(body).load < 0; });
    }

    void rest(std::uint32_t body)
    {
        const Borne& is = now(body);
        Borne& was = resting_.borne[body];
        const bool steady = is.load > 0 && was.load >= 0
            && change(body, is, was) <= kSteady * parameters_.rest_force;
        const bool comes = may(body) == May::yes || (may(body) == May::if_steady && steady);
        was = is;
        if (!comes) return;
        sleep(body);
        resting_.border.push_back(body);
    }

    const SleepParameters& parameters_;
    const Pairs& pairs_;
    const Colliders& colliders_;
    const ConvexContacts<Real>& convex_;
    const MeshContacts<Real>& meshes_;
    const SolidContacts<Real>& solids_;
    BodyStates& states_;
    SleepingIslands& sleeping_islands_;
    Velocities& velocities_;
    RestingBodies& resting_;
    SleepEvents& sleep_events_;
};

}  // namespace

template <class Real>
void rest_bodies(const StepContext& context,
                 const SleepParameters& parameters,
                 const PrescribedVelocities& prescribed,
                 const Forces& forces,
                 const Islands& islands,
                 const SplitImpulse& split_impulse,
                 const Colliders& colliders,
                 const Pairs& pairs,
                 const ConvexContacts<Real>& convex,
                 const MeshContacts<Real>& meshes,
                 const SolidContacts<Real>& solids,
                 BodyStates& states,
                 SleepingIslands& sleeping_islands,
                 Velocities& velocities,
                 RestingBodies& resting_bodies,
                 SleepEvents& sleep_events)
{
    sleep_events.fell_asleep.clear();
    const Quiet quiet{context, parameters, prescribed, forces, split_impulse, velocities};
    ComingToRest<Real> resting(parameters, pairs, colliders, convex, meshes, solids, states,
                               sleeping_islands, velocities, resting_bodies, sleep_events);
    for (std::size_t island = 0; island < islands.size(); ++island) {
        const auto bodies = islands.bodies_of(island);
        for (const std::uint32_t body : bodies) quiet.count(body, states);
        resting.find_candidates(bodies, forces);
    }
    resting.run();
    // What nothing holds is at rest only where it stands: a slow one drifts, or turns back to fall.
    for (const std::uint32_t body : islands.lone) {
        if (!states.moves(body)) continue;
        resting_bodies.borne[body].load = -1;
        if (quiet.count(body, states) >= parameters.time && parameters.islands
            && speed_of(velocities, states, body) == 0)
            resting.rest_alone(body);
    }
    std::sort(sleep_events.fell_asleep.begin(), sleep_events.fell_asleep.end());
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void rest_bodies<Real>(                                                               \
        const StepContext&, const SleepParameters&, const PrescribedVelocities&, const Forces&,    \
        const Islands&, const SplitImpulse&, const Colliders&, const Pairs&,                       \
        const ConvexContacts<Real>&, const MeshContacts<Real>&, const SolidContacts<Real>&,        \
        BodyStates&, SleepingIslands&, Velocities&, RestingBodies&, SleepEvents&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
