#include "kernels/solve/islands.hpp"

#include <numeric>

namespace throng {

void DisjointSets::reset(std::size_t count)
{
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0u);
}

std::uint32_t DisjointSets::find(std::uint32_t x)
{
    while (parent_[x] != x) {
        parent_[x] = parent_[parent_[x]];  // halves the path for the next one
        x = parent_[x];
    }
    return x;
}

void DisjointSets::join(std::uint32_t a, std::uint32_t b)
{
    a = find(a);
    b = find(b);
    if (a < b)
        parent_[b] = a;
    else
        parent_[a] = b;
}

namespace {

// Sorts items by island, keeping their order within each: begin[i] to begin[i + 1] are island i's.
template <class IslandOf>
void sort_by_island(std::size_t islands,
                    std::size_t count,
                    IslandOf island_of,
                    std::vector<std::uint32_t>& begin,
                    std::vector<std::uint32_t>& sorted)
{
    begin.assign(islands + 1, 0);
    std::size_t placed = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t island = island_of(i);
        if (island == kNobody) continue;
        ++begin[island + 1];
        ++placed;
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    sorted.resize(placed);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t island = island_of(i);
        if (island != kNobody) sorted[begin[island]++] = static_cast<std::uint32_t>(i);
    }
    // Filling moved each beginning to the next one's.
    for (std::size_t island = islands; island > 0; --island) begin[island] = begin[island - 1];
    begin[0] = 0;
}

}  // namespace

void build_islands(const ActiveContacts& contacts,
                   const BodyStates& states,
                   DisjointSets& sets,
                   Islands& islands)
{
    const std::size_t bodies = states.kind.size();
    const auto movable = [&](std::uint32_t body) {
        return states.dynamic(body) && states.moves(body);
    };
    sets.reset(bodies);
    std::vector<std::uint8_t> touched(bodies, 0);
    for (const auto& contact : contacts.entries) {
        const bool a = movable(contact.body_a), b = movable(contact.body_b);
        if (a && b) sets.join(contact.body_a, contact.body_b);
        if (a) touched[contact.body_a] = 1;
        if (b) touched[contact.body_b] = 1;
    }

    // Islands count up in order of their smallest body.
    islands.lone.clear();
    std::vector<std::uint32_t> island_of(bodies, kNobody);
    std::uint32_t count = 0;
    for (std::uint32_t body = 0; body < bodies; ++body) {
        if (!movable(body)) continue;
        if (touched[body] == 0) {
            islands.lone.push_back(body);
            continue;
        }
        const std::uint32_t root = sets.find(body);
        if (root == body) island_of[body] = count++;
        island_of[body] = island_of[root];
    }
    sort_by_island(
        count, bodies, [&](std::size_t body) { return island_of[body]; }, islands.body_begin,
        islands.bodies);
    sort_by_island(
        count, contacts.entries.size(),
        [&](std::size_t i) {
            const auto& contact = contacts.entries[i];
            return island_of[movable(contact.body_a) ? contact.body_a : contact.body_b];
        },
        islands.contact_begin, islands.contacts);
}

}  // namespace throng
