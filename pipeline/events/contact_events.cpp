// Contact events: contacts and touches of the last step, told by bodies and parts.
#include "throng/contact_events.hpp"

#include "pipeline/contacts/collide.hpp"
#include "pipeline/contacts/contact_lists.hpp"
#include "pipeline/events/parts_order.hpp"
#include "pipeline/world/contact_impulses.hpp"
#include "pipeline/world/world_state.hpp"
#include "throng/dials.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace throng {

namespace {

void warn_once(std::vector<std::string>& warnings, std::string warning)
{
    if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
        warnings.push_back(std::move(warning));
}

template <class Real>
class Listing {
public:
    Listing(const WorldState& state, const StepData<Real>& data)
        : state_(state), data_(data), substep_(std::get<StepContext>(data).last_substep)
    { }

    std::vector<ContactReport> run()
    {
        const auto add = [&](PairKey key, const Contact<Real>& contact) { put(key, contact); };
        const auto& pairs = std::get<Pairs>(data_);
        const auto& convex = std::get<ConvexContacts<Real>>(data_);
        of_convex_.resize(convex.contacts.size());
        for (std::size_t i = 0; i < convex.of_pair.size(); ++i) {
            const Contact<Real>* const contact = convex.at(i);
            if (contact == nullptr) continue;
            of_convex_[convex.of_pair[i].contact] = reports_.size();
            put(pairs.keys[i], *contact);
        }
        first_mesh_ = reports_.size();
        for (const auto& entry : std::get<MeshContacts<Real>>(data_).entries)
            put(pairs.keys[entry.pair], entry.contact);
        first_solid_ = reports_.size();
        for (const auto& entry : std::get<SolidContacts<Real>>(data_).entries)
            put(pairs.keys[entry.pair], entry.contact);
        for_each_sleeping_contact(std::get<SleepingPairs>(data_),
                                  std::get<SleepingContacts<Real>>(data_), add);
        if (state_.contacts_as_stepped && state_.effects.on.has(Effect::restitution)) add_impacts();
        std::erase_if(reports_, [](const ContactReport& report) { return report.count == 0; });
        // Contacts of one pair stay in the order of the list.
        std::stable_sort(reports_.begin(), reports_.end(), comes_before);
        return std::move(reports_);
    }

private:
    void put(PairKey key, const Contact<Real>& contact)
    {
        ContactReport report{
            state_.parts_of(key), contact.normal.template cast<double>(), {}, 0, {}};
        const Vec3& center = anchor_origin(report.a.index, report.b.index,
                                           std::get<BodyStates>(data_), std::get<Poses>(data_));
        Vec3 impulse = contact.friction.template cast<double>();
        for (; report.count < contact.count; ++report.count) {
            const auto k = static_cast<std::size_t>(report.count);
            const auto& point = contact.points[k];
            report.points[k] = {center + point.anchor_a.template cast<double>(),
                                double{point.separation}, double{point.impulse}};
            impulse += report.normal * double{point.impulse};
        }
        report.force = substep_ > 0 ? Vec3(impulse / substep_) : Vec3(Vec3::Zero());
        reports_.push_back(report);
    }

    std::size_t place_of(const ActiveContacts::Entry& entry) const
    {
        switch (entry.list) {
        case ContactList::mesh:
            return first_mesh_ + entry.list_index;
        case ContactList::solid:
            return first_solid_ + entry.list_index;
        default:
            return of_convex_[entry.list_index];
        }
    }

    void add_impacts()
    {
        if (substep_ <= 0) return;
        const auto& joined = std::get<JoinedContacts<Real>>(data_);
        for_each_impact(std::get<ActiveContacts>(data_), std::get<Layout>(data_),
                        std::get<ContactConstraints<Real>>(data_),
                        [&](const ActiveContacts::Entry& entry, const Vec3T<Real>& on_b) {
                            const Vec3 force = on_b.template cast<double>() / substep_;
                            if (entry.list != ContactList::joined) {
                                reports_[place_of(entry)].force += force;
                                return;
                            }
                            // Which of those that were solved as one it was is not known.
                            const auto& one = joined.contacts[entry.list_index];
                            for (std::uint32_t k = 0; k < one.count; ++k)
                                reports_[place_of(joined.sources[one.first + k])].force +=
                                    force / one.count;
                        });
    }

    const WorldState& state_;
    const StepData<Real>& data_;
    double substep_;
    std::vector<ContactReport> reports_;
    std::vector<std::size_t> of_convex_;  // [contacts] their reports
    std::size_t first_mesh_ = 0, first_solid_ = 0;
};

}  // namespace

ColliderOwner WorldState::owner_of(std::uint32_t collider) const
{
    if (const auto former = gone.find(collider); former != gone.end()) return former->second;
    const auto& colliders = get<Colliders>();
    const std::uint32_t body = colliders.body[collider];
    return {{body, generation[body]}, collider - colliders.begin[body]};
}

TouchingParts WorldState::parts_of(std::uint32_t collider_a, std::uint32_t collider_b) const
{
    const ColliderOwner a = owner_of(collider_a), b = owner_of(collider_b);
    return {a.body, b.body, a.part, b.part};
}

bool WorldState::listens() const { return effects.on.has(Effect::events); }

void WorldState::end_touches_of_gone()
{
    auto& touching = get<TouchingPairs>();
    touching.follow(get<SleepingPairs>().changes);
    std::erase_if(touching.keys, [&](PairKey key) {
        if (((edits[first_of(key)] | edits[second_of(key)]) & kGone) == 0) return false;
        ended_with_gone.push_back(parts_of(key));
        return true;
    });
    gone.clear();
}

void WorldState::follow_touching_pairs()
{
    if (!listens()) return;
    const std::uint64_t step_now = report.step + 1;
    const auto& touching = get<TouchingPairs>();
    const std::size_t begun = events.begun.size(), ended = events.ended.size(),
                      hits = events.hits.size();
    if (listening.touches) {
        for (const TouchingParts& parts : ended_with_gone)
            events.ended.push_back({parts, step_now});
        for (const PairKey key : touching.begun) events.begun.push_back({parts_of(key), step_now});
        for (const PairKey key : touching.ended) events.ended.push_back({parts_of(key), step_now});
    }
    ended_with_gone.clear();
    for (const auto& hit : touching.hits)
        events.hits.push_back({{parts_of(hit.key), step_now}, hit.point, hit.normal, hit.speed});
    // Colliders that took the places of others are not in the order of their bodies.
    const auto put_in_order = [](auto& list, std::size_t from) {
        const auto first = list.begin() + static_cast<std::ptrdiff_t>(from);
        if (!std::is_sorted(first, list.end(), comes_before))
            std::sort(first, list.end(), comes_before);
    };
    put_in_order(events.begun, begun);
    put_in_order(events.ended, ended);
    put_in_order(events.hits, hits);
}

void World::listen(const Listening& to)
{
    const Door::Entry entry(state_->door, "listen");
    if (!(to.hit_speed > 0))
        throw std::invalid_argument(
            "listen: hit_speed: give a speed above 0, m/s, or infinity for no hits");
    WorldState& state = *state_;
    state.settle();
    auto& touching = state.get<TouchingPairs>();
    // Of those who touch already nobody was told.
    if (to.touches && !state.listening.touches) touching = {};
    state.listening = to;
    touching.hit_speed = to.hit_speed;
    std::string& cause = state.requests.first[static_cast<std::size_t>(Effect::events)];
    cause.clear();
    const bool any = to.touches || std::isfinite(to.hit_speed);
    if (any) {
        cause = "program listens";
    } else {
        touching = {};
        state.gone.clear();
        state.ended_with_gone.clear();
    }
    state.call_sensors();
    if (any && state.settings.overlap != Overlap::allow)
        warn_once(state.warnings,
                  "listen: overlap=" + dial_value(state.settings, "overlap")
                      + " keeps no list of contacts: nobody is told of touches and hits; take "
                        "overlap=allow, or ask overlapping_pairs()");
    state.get<SleepingPairs>().told = any;
    if (!any) state.get<SleepingPairs>().changes.clear();
    state.effects_stale = true;
}

const Events& World::events() const
{
    state_->door.need_no_step("events");
    return state_->events;
}

std::span<const ContactReport> World::contacts() const
{
    const Door::Entry entry(state_->door, "contacts", Door::Use::looks);
    state_->settle();
    state_->contacts = std::visit(
        [&](const auto& chosen) {
            using Real = typename std::decay_t<decltype(chosen)>::Number;
            return Listing<Real>(*state_, chosen.data).run();
        },
        state_->step);
    return state_->contacts;
}

}  // namespace throng
