#include "pipeline/contacts/wake_pairs.hpp"

#include "kernels/parallel/follow.hpp"
#include "pipeline/contacts/many_contacts.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

using Holder = SleepingPairs::Holder;
using Held = SleepingPairs::Held;
using Ref = SleepingPairs::Ref;

// A list of no more references is never cleared of stale ones.
constexpr std::size_t kFewRefs = 16;

Held& held_by(const Holder& holder, SleepingPairs& sleeping)
{
    if (holder.still) return sleeping.of_still[holder.place];
    if (sleeping.of_island.size() <= holder.place) sleeping.of_island.resize(holder.place + 1);
    return sleeping.of_island[holder.place];
}

// Its pair was called by its other holder.
void note_stale(const Holder& holder, SleepingPairs& sleeping)
{
    Held& held = held_by(holder, sleeping);
    ++held.stale;
    if (held.refs.size() <= kFewRefs || 2 * held.stale <= held.refs.size()) return;
    std::erase_if(held.refs, [&](const Ref& ref) { return !sleeping.holds(ref); });
    held.stale = 0;
    if (held.refs.empty() && holder.still) sleeping.of_still.erase(holder.place);
}

void call_island(std::uint32_t island, SleepingPairs& sleeping)
{
    if (island >= sleeping.of_island.size()) return;
    Held held;
    std::swap(held, sleeping.of_island[island]);
    for (const Ref& ref : held.refs) {
        if (!sleeping.holds(ref)) continue;
        SleepingPairs::Kept& kept = sleeping.kept[ref.at];
        ++kept.generation;
        sleeping.called.push_back(ref.at);
        for (const Holder& holder : kept.holders)
            if (holder.place != kNoBody && (holder.still || holder.place != island))
                note_stale(holder, sleeping);
    }
}

std::uint32_t take_place(std::vector<std::uint32_t>& free, std::size_t size)
{
    if (free.empty()) return static_cast<std::uint32_t>(size);
    const std::uint32_t place = free.back();
    free.pop_back();
    return place;
}

// Where every item of a list goes whose items are gone or stay in order, or make room for others.
struct Moves {
    std::vector<std::uint32_t> from;  // [after] as follow() wants it
    std::vector<std::uint32_t> to;    // [before] kNewItem: gone
};

template <class Item>
void renumber(const std::vector<std::uint32_t>& to, std::vector<Item>& items)
{
    const auto place = [&](const Item& item) {
        if constexpr (std::is_same_v<Item, std::uint32_t>)
            return item;
        else
            return item.pair;
    };
    std::erase_if(items, [&](const Item& item) {
        return place(item) >= to.size() || to[place(item)] == kNewItem;
    });
    for (Item& item : items) {
        if constexpr (std::is_same_v<Item, std::uint32_t>)
            item = to[item];
        else
            item.pair = to[item.pair];
    }
}

// Puts items in that are in order of their pairs.
template <class Item, class Before>
void merge_in(const std::vector<Item>& fresh, std::vector<Item>& items, const Before& before)
{
    const auto middle = static_cast<std::ptrdiff_t>(items.size());
    items.insert(items.end(), fresh.begin(), fresh.end());
    std::inplace_merge(items.begin(), items.begin() + middle, items.end(), before);
}

// All lists in which pairs have a place.
template <class Real>
class PairLists {
protected:
    explicit PairLists(const PairData<Real>& data)
        : pairs_(data.template get<Pairs>()), convex_(data.template get<ConvexContacts<Real>>()),
          meshes_(data.template get<MeshContacts<Real>>()),
          solids_(data.template get<SolidContacts<Real>>()),
          methods_(data.template get<MethodPairs>()), sleeping_(data.template get<SleepingPairs>()),
          contacts_(data.template get<SleepingContacts<Real>>()),
          resting_(data.template get<RestingBodies>())
    { }

    /// Pairs go to other places, or are gone; of the n-th that is new it is asked what it knows.
    template <class KeyOf, class StateOf, class ApartOf, class MemoryOf>
    void move_all(const KeyOf& key_of,
                  const StateOf& state_of,
                  const ApartOf& apart_of,
                  const MemoryOf& memory_of)
    {
        const bool apart = !convex_.apart_until.empty(), methods = !methods_.of_pair.empty();
        follow(moves_.from, pairs_.keys, key_of, [](PairKey) {});
        follow(moves_.from, convex_.of_pair, state_of, [](const PairState&) {});
        if (apart) follow(moves_.from, convex_.apart_until, apart_of, [](float) {});
        if (methods) follow(moves_.from, methods_.of_pair, memory_of, [](const MethodMemory&) {});
        for (auto* list : {&pairs_.on_mesh, &pairs_.on_solid, &convex_.followed, &meshes_.followed})
            renumber(moves_.to, *list);
        renumber(moves_.to, meshes_.entries);
        renumber(moves_.to, solids_.entries);
        renumber(moves_.to, meshes_.found.pairs);
        renumber(moves_.to, solids_.found.pairs);
    }

    /// Tells leave(pair) of each that does not stay, makes room before by make_room(how many), and
    /// takes all of them out of the lists.
    template <class Stays, class MakeRoom, class Leave>
    void keep(const Stays& stays, const MakeRoom& make_room, const Leave& leave)
    {
        const std::size_t count = pairs_.keys.size();
        moves_.to.assign(count, kNewItem);
        for (std::uint32_t i = 0; i < count; ++i) {
            if (!stays(pairs_.keys[i])) continue;
            moves_.to[i] = static_cast<std::uint32_t>(moves_.from.size());
            moves_.from.push_back(i);
        }
        if (moves_.from.size() == count) return;
        make_room(count - moves_.from.size());
        for (std::uint32_t i = 0; i < count; ++i)
            if (moves_.to[i] == kNewItem) leave(i);
        move_all([](std::size_t) { return PairKey{}; }, [](std::size_t) { return PairState{}; },
                 [](std::size_t) { return 0.0F; }, [](std::size_t) { return MethodMemory{}; });
    }

    Pairs& pairs_;
    ConvexContacts<Real>& convex_;
    MeshContacts<Real>& meshes_;
    SolidContacts<Real>& solids_;
    MethodPairs& methods_;
    SleepingPairs& sleeping_;
    SleepingContacts<Real>& contacts_;
    RestingBodies& resting_;
    Moves moves_;
};

// One call for pairs that come back.
template <class Real>
class Waking : PairLists<Real> {
public:
    Waking(const Colliders& colliders, const PairData<Real>& data)
        : PairLists<Real>(data), colliders_(colliders)
    { }

    void run()
    {
        if (pairs_.changed) follow_with_meshes();
        std::vector<std::uint32_t>& called = sleeping_.called;
        std::sort(called.begin(), called.end(), [&](std::uint32_t a, std::uint32_t b) {
            return sleeping_.kept[a].key < sleeping_.kept[b].key;
        });
        if (!resting_.borne.empty()) follow_contacts();
        find_moves();
        make_room();
        this->move_all([&](std::size_t n) { return sleeping_.kept[called[n]].key; },
                       [&](std::size_t n) { return state_of(called[n]); },
                       [&](std::size_t n) { return contacts_.of_kept[called[n]].apart_until; },
                       [&](std::size_t n) { return memory_of(called[n]); });
        if (!contacts_.many.empty()) wake_many();
        for (const std::uint32_t at : called) contacts_.of_kept[at] = {};
        if (sleeping_.told)
            for (const std::uint32_t at : called)
                sleeping_.changes.push_back({sleeping_.kept[at].key, false});
        sleeping_.free.insert(sleeping_.free.end(), called.begin(), called.end());
        called.clear();
    }

private:
    using PairLists<Real>::pairs_, PairLists<Real>::convex_, PairLists<Real>::meshes_,
        PairLists<Real>::solids_, PairLists<Real>::sleeping_, PairLists<Real>::contacts_,
        PairLists<Real>::resting_, PairLists<Real>::moves_;

    // What they bear on those who rest on is what these remember once more.
    void follow_contacts()
    {
        for (const std::uint32_t at : sleeping_.called)
            for_each_contact_at(at, sleeping_, contacts_,
                                [&](PairKey key, const Contact<Real>& contact) {
                                    resting_.follow(contact, colliders_.body[first_of(key)],
                                                    colliders_.body[second_of(key)], 1);
                                });
    }

    // Contacts with meshes are the last to follow the list of pairs.
    void follow_with_meshes()
    {
        std::vector<std::uint32_t> to;
        for (std::uint32_t i = 0; i < pairs_.from.size(); ++i) {
            const std::uint32_t from = pairs_.from[i];
            if (from == Pairs::kNewPair) continue;
            to.resize(from + std::size_t{1}, kNewItem);
            to[from] = i;
        }
        renumber(to, meshes_.entries);
        renumber(to, meshes_.found.pairs);
        pairs_.changed = false;
    }

    void find_moves()
    {
        const std::vector<std::uint32_t>& called = sleeping_.called;
        const std::size_t count = pairs_.keys.size();
        moves_.to.resize(count);
        moves_.from.clear();
        moves_.from.reserve(count + called.size());
        std::size_t next = 0;
        const auto put_until = [&](PairKey key) {
            for (; next < called.size() && sleeping_.kept[called[next]].key < key; ++next) {
                came_.push_back(static_cast<std::uint32_t>(moves_.from.size()));
                moves_.from.push_back(kNewItem);
            }
        };
        for (std::uint32_t i = 0; i < count; ++i) {
            put_until(pairs_.keys[i]);
            moves_.to[i] = static_cast<std::uint32_t>(moves_.from.size());
            moves_.from.push_back(i);
        }
        put_until(std::numeric_limits<PairKey>::max());
    }

    void make_room()
    {
        const auto touches = [&](std::uint32_t at) {
            return contacts_.of_kept[at].state.contact != PairState::kApart;
        };
        const auto touching = static_cast<std::size_t>(
            std::count_if(sleeping_.called.begin(), sleeping_.called.end(), touches));
        const std::size_t more = touching - std::min(touching, convex_.free.size());
        reserve_closely(convex_.contacts, convex_.contacts.size() + more);
        reserve_closely(convex_.astray, convex_.astray.size() + more);
    }

    PairState state_of(std::uint32_t at)
    {
        PairState state = contacts_.of_kept[at].state;
        if (state.contact == PairState::kApart) return state;
        const std::uint32_t place = take_place(convex_.free, convex_.contacts.size());
        if (place == convex_.contacts.size()) {
            resize_closely(convex_.contacts, place + std::size_t{1});
            resize_closely(convex_.astray, place + std::size_t{1});
        }
        convex_.contacts[place].take(contacts_.contacts[state.contact]);
        convex_.astray[place] = 1;
        ++convex_.strayed;
        if (convex_.recycles) {
            if (convex_.found.size() <= place)
                resize_closely(convex_.found, convex_.contacts.size());
            convex_.found[place] = found_at(state.contact);
        }
        contacts_.free_contacts.push_back(state.contact);
        state.contact = place;
        return state;
    }

    CachedManifold<Real> found_at(std::uint32_t place) const
    {
        if (place < contacts_.found.size()) return contacts_.found[place];
        CachedManifold<Real> nothing;
        nothing.b_in_a.position.setConstant(std::numeric_limits<Real>::quiet_NaN());
        return nothing;
    }

    MethodMemory memory_of(std::uint32_t at) const
    {
        return at < contacts_.memories.size() ? contacts_.memories[at] : MethodMemory{};
    }

    void wake_many()
    {
        std::vector<std::uint32_t> on_mesh, on_solid;
        ContactEntries<Real> of_meshes, of_solids;
        for (std::size_t k = 0; k < came_.size(); ++k) {
            auto& of_kept = contacts_.of_kept[sleeping_.called[k]];
            if (of_kept.many == kNoBody) continue;
            auto& many = contacts_.many[of_kept.many];
            const std::uint32_t pair = came_[k];
            (many.on_mesh ? on_mesh : on_solid).push_back(pair);
            ContactEntries<Real>& entries = many.on_mesh ? of_meshes : of_solids;
            for (auto& entry : many.entries) {
                entry.pair = pair;
                entries.push_back(entry);
            }
            contacts_.free_many.push_back(of_kept.many);
            many = {};
        }
        const auto less = [](std::uint32_t a, std::uint32_t b) { return a < b; };
        const auto before = [](const auto& a, const auto& b) { return a.pair < b.pair; };
        merge_in(on_mesh, pairs_.on_mesh, less);
        merge_in(on_solid, pairs_.on_solid, less);
        merge_in(of_meshes, meshes_.entries, before);
        merge_in(of_solids, solids_.entries, before);
    }

    const Colliders& colliders_;
    std::vector<std::uint32_t> came_;  // [called] to which places
};

// One call for pairs that leave.
template <class Real>
class FallingAsleep : PairLists<Real> {
public:
    FallingAsleep(const Colliders& colliders, const BodyStates& states, const PairData<Real>& data)
        : PairLists<Real>(data), colliders_(colliders), states_(states)
    { }

    void run()
    {
        this->keep([&](PairKey key) { return !sleeps(key); },
                   [&](std::size_t leaving) { make_room(leaving); },
                   [&](std::uint32_t pair) { leave(pair); });
    }

private:
    using PairLists<Real>::pairs_, PairLists<Real>::convex_, PairLists<Real>::meshes_,
        PairLists<Real>::solids_, PairLists<Real>::methods_, PairLists<Real>::sleeping_,
        PairLists<Real>::contacts_, PairLists<Real>::resting_, PairLists<Real>::moves_;

    // For all at once: lists of many contacts are long in growing.
    void make_room(std::size_t leaving)
    {
        const auto need = [](auto& list, std::size_t more, std::size_t free) {
            reserve_closely(list, list.size() + more - std::min(more, free));
        };
        std::size_t touching = 0;
        for (std::size_t i = 0; i < moves_.to.size(); ++i)
            touching +=
                moves_.to[i] == kNewItem && convex_.of_pair[i].contact != PairState::kApart ? 1 : 0;
        need(sleeping_.kept, leaving, sleeping_.free.size());
        need(contacts_.of_kept, leaving, sleeping_.free.size());
        need(contacts_.contacts, touching, contacts_.free_contacts.size());
    }

    bool sleeps(PairKey key) const
    {
        const std::uint32_t a = colliders_.body[first_of(key)];
        const std::uint32_t b = colliders_.body[second_of(key)];
        return !states_.moves(a) && !states_.moves(b)
            && (states_.sleeping_island[a] != kNoBody || states_.sleeping_island[b] != kNoBody);
    }

    void leave(std::uint32_t pair)
    {
        const std::uint32_t place = take_place(sleeping_.free, sleeping_.kept.size());
        if (place == sleeping_.kept.size()) {
            resize_closely(sleeping_.kept, place + std::size_t{1});
            resize_closely(contacts_.of_kept, place + std::size_t{1});
        }
        SleepingPairs::Kept& kept = sleeping_.kept[place];
        kept.key = pairs_.keys[pair];
        hold(place, kept);
        if (sleeping_.told) sleeping_.changes.push_back({kept.key, true});
        auto& of_kept = contacts_.of_kept[place] = {};
        of_kept.state = convex_.of_pair[pair];
        if (of_kept.state.contact != PairState::kApart) put_by_contact(of_kept.state.contact);
        if (!convex_.apart_until.empty()) of_kept.apart_until = convex_.apart_until[pair];
        if (!methods_.of_pair.empty()) {
            if (contacts_.memories.size() <= place)
                resize_closely(contacts_.memories, place + std::size_t{1});
            contacts_.memories[place] = methods_.of_pair[pair];
        }
        const bool on_mesh = std::binary_search(pairs_.on_mesh.begin(), pairs_.on_mesh.end(), pair);
        if (on_mesh || std::binary_search(pairs_.on_solid.begin(), pairs_.on_solid.end(), pair))
            put_by_many(pair, on_mesh, of_kept);
        if (resting_.borne.empty()) return;
        for_each_contact_at(place, sleeping_, contacts_,
                            [&](PairKey key, const Contact<Real>& contact) {
                                resting_.follow(contact, colliders_.body[first_of(key)],
                                                colliders_.body[second_of(key)], -1);
                            });
    }

    void hold(std::uint32_t place, SleepingPairs::Kept& kept)
    {
        kept.holders = {};
        std::size_t count = 0;
        for (const std::uint32_t collider : {first_of(kept.key), second_of(kept.key)}) {
            const std::uint32_t body = colliders_.body[collider];
            const std::uint32_t island = states_.sleeping_island[body];
            const Holder holder{island != kNoBody ? island : body, island == kNoBody};
            if (count > 0 && !holder.still && !kept.holders[0].still
                && kept.holders[0].place == holder.place)
                continue;
            kept.holders[count++] = holder;
            held_by(holder, sleeping_).refs.push_back({place, kept.generation});
        }
    }

    void put_by_contact(std::uint32_t& place)
    {
        const std::uint32_t to = take_place(contacts_.free_contacts, contacts_.contacts.size());
        if (to == contacts_.contacts.size())
            resize_closely(contacts_.contacts, to + std::size_t{1});
        contacts_.contacts[to].take(convex_.contacts[place]);
        if (convex_.recycles) {
            if (contacts_.found.size() <= to)
                resize_closely(contacts_.found, contacts_.contacts.size());
            contacts_.found[to] = convex_.found[place];
        }
        convex_.free.push_back(place);
        place = to;
    }

    void
    put_by_many(std::uint32_t pair, bool on_mesh, typename SleepingContacts<Real>::OfKept& of_kept)
    {
        of_kept.many = take_place(contacts_.free_many, contacts_.many.size());
        if (of_kept.many == contacts_.many.size()) contacts_.many.emplace_back();
        auto& many = contacts_.many[of_kept.many];
        many.on_mesh = on_mesh;
        const ContactEntries<Real>& all = on_mesh ? meshes_.entries : solids_.entries;
        const auto entries = items_of(all, pair);
        many.entries.assign(entries.begin(), entries.end());
    }

    const Colliders& colliders_;
    const BodyStates& states_;
};

// One call for pairs of somebody who is removed.
template <class Real>
class Dropping : PairLists<Real> {
public:
    explicit Dropping(const PairData<Real>& data) : PairLists<Real>(data) { }

    void run(const std::function<bool(PairKey)>& goes)
    {
        this->keep([&](PairKey key) { return !goes(key); }, [](std::size_t) {},
                   [&](std::uint32_t pair) {
                       const std::uint32_t place = this->convex_.of_pair[pair].contact;
                       if (place != PairState::kApart) this->convex_.free.push_back(place);
                   });
    }
};

}  // namespace

void wake_island(std::uint32_t island,
                 SleepingIslands& sleeping_islands,
                 BodyStates& states,
                 SleepingPairs& sleeping,
                 std::vector<std::uint32_t>& woke)
{
    for (const std::uint32_t body : sleeping_islands.bodies[island]) {
        states.awake[body] = 1;
        states.sleep_time[body] = 0;
        states.sleeping_island[body] = kNoBody;
        woke.push_back(body);
    }
    sleeping_islands.bodies[island].clear();
    sleeping_islands.free.push_back(island);
    call_island(island, sleeping);
}

std::vector<std::uint32_t> islands_beside(std::uint32_t body, const SleepingPairs& sleeping)
{
    std::vector<std::uint32_t> islands;
    const auto found = sleeping.of_still.find(body);
    if (found == sleeping.of_still.end()) return islands;
    for (const Ref& ref : found->second.refs) {
        if (!sleeping.holds(ref)) continue;
        for (const Holder& holder : sleeping.kept[ref.at].holders)
            if (!holder.still && holder.place != kNoBody) islands.push_back(holder.place);
    }
    return islands;
}

void call_all(SleepingPairs& sleeping)
{
    sleeping.mixed = true;
    sleeping.seen = false;
    for (std::uint32_t island = 0; island < sleeping.of_island.size(); ++island)
        call_island(island, sleeping);
    sleeping.of_still.clear();
}

template <class Real>
void wake_pairs(const Colliders& colliders, const PairData<Real>& data)
{
    if (!data.template get<SleepingPairs>().called.empty()) Waking<Real>(colliders, data).run();
}

template <class Real>
void put_to_sleep(const Colliders& colliders, const BodyStates& states, const PairData<Real>& data)
{
    FallingAsleep<Real>(colliders, states, data).run();
    data.template get<SleepingPairs>().mixed = false;
}

template <class Real>
void drop_pairs(const std::function<bool(PairKey)>& goes, const PairData<Real>& data)
{
    Dropping<Real>(data).run(goes);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void drop_pairs<Real>(const std::function<bool(PairKey)>&, const PairData<Real>&);    \
    template void wake_pairs<Real>(const Colliders&, const PairData<Real>&);                       \
    template void put_to_sleep<Real>(const Colliders&, const BodyStates&, const PairData<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
