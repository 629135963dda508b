// Islands: union-find over the contacts of movable bodies.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/contacts.hpp"
#include "kernels/data/islands.hpp"

namespace throng {

/// Sets of numbers that were joined. The representative of a set is its smallest number, whatever
/// the order of joining.
class DisjointSets {
public:
    void reset(std::size_t count);
    std::uint32_t find(std::uint32_t x);
    void join(std::uint32_t a, std::uint32_t b);

private:
    std::vector<std::uint32_t> parent_;
};

/// Splits the awake dynamic bodies into islands by the contacts between them. A contact belongs to
/// the island of its movable side; still and kinematic bodies join nothing.
void build_islands(const ActiveContacts& contacts,
                   const BodyStates& states,
                   DisjointSets& sets,
                   Islands& islands);

}  // namespace throng
