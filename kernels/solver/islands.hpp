// Islands: union-find over the contacts of movable bodies.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/contacts.hpp"
#include "kernels/data/islands.hpp"
#include "kernels/parallel/bucket_sort.hpp"
#include "kernels/parallel/compact.hpp"
#include "kernels/parallel/disjoint_sets.hpp"

namespace throng {

/// Bodies that are joined by something else than contacts.
using BodyGroups = std::vector<std::vector<std::uint32_t>>;

/// Splits the bodies that can move into islands by the contacts between them. A contact belongs to
/// the island of its movable side; still and kinematic bodies join nothing. A group of which one
/// body is in an island is in it with all that can move.
class IslandFinder {
public:
    ///   movable  all of them, ascending; others take no time
    void find(const ActiveContacts& contacts,
              const BodyStates& states,
              std::span<const std::uint32_t> movable,
              const BodyGroups& groups,
              Islands& islands);

private:
    void join(const ActiveContacts& contacts, const BodyStates& states);
    void join(const BodyGroups& groups, const BodyStates& states);
    std::size_t number_islands(Islands& islands);

    DisjointSets sets_;                   // of bodies that can move and that something touches
    std::vector<std::uint32_t> movable_;  // as they were given, until the next time
    std::vector<std::uint32_t> roots_, of_body_, of_movable_, of_contact_;  // islands
    BlockLists<std::uint32_t> roots_of_block_, lone_of_block_;
    BucketSort sort_;
};

}  // namespace throng
