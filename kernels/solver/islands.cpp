#include "kernels/solver/islands.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::size_t kGrain = 4096;

}  // namespace

void IslandFinder::join(const ActiveContacts& contacts, const BodyStates& states)
{
    const auto find_set = [&](std::uint32_t body) {
        const bool movable = states.movable(body);
        if (movable) sets_.add(body);
        return movable;
    };
    for_each_block(contacts.entries.size(), kGrain,
                   [&](std::size_t begin, std::size_t end, std::size_t) {
                       for (std::size_t i = begin; i < end; ++i) {
                           const auto& contact = contacts.entries[i];
                           const bool a = find_set(contact.body_a), b = find_set(contact.body_b);
                           if (a && b) sets_.join(contact.body_a, contact.body_b);
                       }
                   });
}

void IslandFinder::join(const BodyGroups& groups, const BodyStates& states)
{
    for (const auto& group : groups) {
        const auto first = std::find_if(group.begin(), group.end(),
                                        [&](std::uint32_t body) { return sets_.holds(body); });
        if (first == group.end()) continue;
        for (const std::uint32_t body : group) {
            if (!states.movable(body)) continue;
            sets_.add(body);
            sets_.join(*first, body);
        }
    }
}

// Islands count up in order of their smallest body, which is their root. Returns how many there are
// and leaves the island of each body.
std::size_t IslandFinder::number_islands(Islands& islands)
{
    const std::size_t count = movable_.size(), blocks = block_count(count, kGrain);
    roots_of_block_.start(blocks);
    lone_of_block_.start(blocks);
    for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t body = movable_[i];
            if (!sets_.holds(body))
                lone_of_block_[block].push_back(body);
            else if (sets_.find(body) == body)
                roots_of_block_[block].push_back(body);
        }
    });
    islands.lone.clear();
    lone_of_block_.append_to(islands.lone);
    roots_.clear();
    roots_of_block_.append_to(roots_);

    for (std::size_t island = 0; island < roots_.size(); ++island)
        of_body_[roots_[island]] = static_cast<std::uint32_t>(island);
    of_movable_.resize(count);
    for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t body = movable_[i];
            of_movable_[i] = BucketSort::kNone;
            if (!sets_.holds(body)) continue;
            // That of a root is there already, and nobody writes it.
            const std::uint32_t root = sets_.find(body);
            of_movable_[i] = of_body_[root];
            if (root != body) of_body_[body] = of_body_[root];
        }
    });
    return roots_.size();
}

void IslandFinder::find(const ActiveContacts& contacts,
                        const BodyStates& states,
                        std::span<const std::uint32_t> movable,
                        const BodyGroups& groups,
                        Islands& islands)
{
    const std::size_t bodies = std::max(states.kind.size(), of_body_.size());
    sets_.reset(bodies, movable_);
    movable_.assign(movable.begin(), movable.end());
    sets_.reset(bodies, movable_);
    of_body_.resize(bodies);
    join(contacts, states);
    join(groups, states);
    const std::size_t found = number_islands(islands);
    const std::size_t count = contacts.entries.size();
    of_contact_.resize(count);
    for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto& contact = contacts.entries[i];
            of_contact_[i] =
                of_body_[sets_.holds(contact.body_a) ? contact.body_a : contact.body_b];
        }
    });
    islands.bodies.resize(movable_.size());
    islands.bodies.resize(
        sort_.sort(of_movable_, movable_, found, islands.body_begin, islands.bodies));
    islands.contacts.resize(count);
    islands.contacts.resize(
        sort_.sort(of_contact_, {}, found, islands.contact_begin, islands.contacts));
}

}  // namespace throng
