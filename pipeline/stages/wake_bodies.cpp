// Wake bodies: who rests by itself wakes as what its contacts bear changes, and before the solve as
// somebody comes who will change it by much; with who rests within some contacts of it.
#include "pipeline/contacts/fall_asleep.hpp"
#include "pipeline/contacts/wake_pairs.hpp"

#include <algorithm>
#include <array>

namespace throng {

namespace {

// Of the tolerance: somebody whose momentum is more, in units of what is borne, wakes whom it
// touches. Less is left to what comes of it: in a heap that settles all would wake all.
constexpr double kImpact = 40;
constexpr std::uint32_t kFarthest = RestingBodies::kFarthest;

// One call of the stage.
template <class Real>
class WakingBodies {
public:
    WakingBodies(const SleepParameters& parameters,
                 const Colliders& colliders,
                 const Velocities& velocities,
                 const Masses& masses,
                 const PairData<Real>& data,
                 SleepingIslands& sleeping_islands,
                 BodyStates& states,
                 SleepEvents& sleep_events)
        : parameters_(parameters), colliders_(colliders), velocities_(velocities), masses_(masses),
          pairs_(data.template get<Pairs>()), convex_(data.template get<ConvexContacts<Real>>()),
          solids_(data.template get<SolidContacts<Real>>()),
          sleeping_(data.template get<SleepingPairs>()),
          sleeping_contacts_(data.template get<SleepingContacts<Real>>()),
          resting_(data.template get<RestingBodies>()), sleeping_islands_(sleeping_islands),
          states_(states), sleep_events_(sleep_events)
    { }

    void run()
    {
        for (const auto& [body, contacts] : resting_.waking) {
            wake(body, contacts);
            if (states_.movable(body)) woken_.push_back(body);
        }
        resting_.waking.clear();
        keep_each_once(woken_);
        const auto disturb_each_other = [&](std::uint32_t a, std::uint32_t b) {
            if (disturbs(a, b)) wake(b, kFarthest);
            if (disturbs(b, a)) wake(a, kFarthest);
        };
        for_each_touching(disturb_each_other);
        // A mesh that moves wakes whoever is near: contacts with it are not known yet.
        for (const std::uint32_t i : pairs_.on_mesh) {
            const auto [a, b] = bodies_of(pairs_.keys[i]);
            disturb_each_other(a, b);
        }
        wake_where_somebody_was_put();
        spread();
    }

private:
    std::array<std::uint32_t, 2> bodies_of(PairKey key) const
    {
        return {colliders_.body[first_of(key)], colliders_.body[second_of(key)]};
    }

    // To be woken, once all are known, with who rests within so many contacts.
    void wake(std::uint32_t body, std::uint32_t contacts)
    {
        if (states_.rests(body)) within_[contacts].push_back(body);
    }

    // Convex and solid ones, of pairs that a step goes through.
    template <class Each>
    void for_each_touching(const Each& each) const
    {
        for (std::size_t i = 0; i < pairs_.keys.size(); ++i) {
            if (convex_.of_pair[i].contact == PairState::kApart) continue;
            const auto [a, b] = bodies_of(pairs_.keys[i]);
            each(a, b);
        }
        for (const auto& entry : solids_.entries) {
            const auto [a, b] = bodies_of(pairs_.keys[entry.pair]);
            if (entry.contact.count > 0) each(a, b);
        }
    }

    bool disturbs(std::uint32_t a, std::uint32_t b) const
    {
        if (!states_.rests(b) || !states_.moves(a)) return false;
        if (std::binary_search(woken_.begin(), woken_.end(), a)) return true;
        if (!states_.dynamic(a))
            return !velocities_.linear[a].isZero(0) || !velocities_.angular[a].isZero(0);
        return masses_.mass[a] * speed_of(velocities_, states_, a)
            > kImpact * parameters_.rest_force * resting_.borne[b].load;
    }

    // Somebody who rests comes near what stands still only when one of them was put there.
    void wake_where_somebody_was_put()
    {
        if (!pairs_.changed) return;
        for (std::size_t i = 0; i < pairs_.keys.size(); ++i) {
            if (pairs_.from[i] != Pairs::kNewPair) continue;
            const auto [a, b] = bodies_of(pairs_.keys[i]);
            if (!states_.dynamic(a)) wake(b, 0);
            if (!states_.dynamic(b)) wake(a, 0);
        }
    }

    // From those with the most contacts to go on. Places of those who wake are taken again in
    // order of the bodies, wherever their pairs are kept.
    void spread()
    {
        for (std::size_t contacts = kFarthest + 1; contacts-- > 0;) {
            std::vector<std::uint32_t>& bodies = within_[contacts];
            keep_each_once(bodies);
            std::erase_if(bodies, [&](std::uint32_t body) { return !states_.rests(body); });
            if (contacts > 0) add_neighbors(bodies, within_[contacts - 1]);
            for (const std::uint32_t body : bodies)
                wake_island(states_.sleeping_island[body], sleeping_islands_, states_, sleeping_,
                            sleep_events_.woke);
        }
        std::sort(sleep_events_.woke.begin(), sleep_events_.woke.end());
    }

    void add_neighbors(const std::vector<std::uint32_t>& bodies,
                       std::vector<std::uint32_t>& neighbors) const
    {
        const auto add = [&](std::uint32_t body) {
            if (states_.rests(body)) neighbors.push_back(body);
        };
        for (const std::uint32_t body : bodies)
            for_each_touching_pair_of(states_.sleeping_island[body], sleeping_, sleeping_contacts_,
                                      [&](PairKey key) {
                                          for (const std::uint32_t one : bodies_of(key)) add(one);
                                      });
        // All pairs were called, and those of who rests are among the others.
        if (!sleeping_.mixed) return;
        for_each_touching([&](std::uint32_t a, std::uint32_t b) {
            if (std::binary_search(bodies.begin(), bodies.end(), a)) add(b);
            if (std::binary_search(bodies.begin(), bodies.end(), b)) add(a);
        });
    }

    const SleepParameters& parameters_;
    const Colliders& colliders_;
    const Velocities& velocities_;
    const Masses& masses_;
    const Pairs& pairs_;
    const ConvexContacts<Real>& convex_;
    const SolidContacts<Real>& solids_;
    SleepingPairs& sleeping_;
    const SleepingContacts<Real>& sleeping_contacts_;
    RestingBodies& resting_;
    SleepingIslands& sleeping_islands_;
    BodyStates& states_;
    SleepEvents& sleep_events_;
    std::vector<std::uint32_t> woken_;                              // by edits, ascending
    std::array<std::vector<std::uint32_t>, kFarthest + 1> within_;  // [contacts to go on]
};

}  // namespace

template <class Real>
void wake_bodies(const SleepParameters& parameters,
                 const Colliders& colliders,
                 const Velocities& velocities,
                 const Masses& masses,
                 const PairData<Real>& data,
                 SleepingIslands& sleeping_islands,
                 BodyStates& states,
                 SleepEvents& sleep_events)
{
    sleep_events.woke.clear();
    if (sleeping_islands.bodies.size() == sleeping_islands.free.size()) return;
    WakingBodies<Real>(parameters, colliders, velocities, masses, data, sleeping_islands, states,
                       sleep_events)
        .run();
    wake_pairs<Real>(colliders, data);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void wake_bodies<Real>(const SleepParameters&, const Colliders&, const Velocities&,   \
                                    const Masses&, const PairData<Real>&, SleepingIslands&,        \
                                    BodyStates&, SleepEvents&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
