// Island splitter: a big island cut across its longest side, so that each contact lies within a
// slice or between it and the next.
//
// Slices that are not neighbours share no body. Threads work on different ones at a time, and one
// thread takes a slice through several iterations while its constraints are in cache (see
// solve_batch).
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/bounds.hpp"
#include "kernels/data/contact_constraints.hpp"
#include "kernels/data/contacts.hpp"
#include "kernels/parallel/bucket_sort.hpp"

#include <span>

namespace throng {

/// When to cut, in contacts.
///
///   from   islands of fewer are not cut: their constraints fit into the last cache as they are,
///          and more lanes stay idle in many slices than in one
///   slice  of a slice, at least: enough that few lanes of its colors stay idle, few enough that
///          its constraints stay in one core's cache
struct SplitRule {
    std::size_t from = 1 << 16, slice = 1024;
};

class IslandSplitter {
public:
    /// An island to cut.
    ///
    ///   bodies    of the island, ascending; put in order of slices
    ///   contacts  of the island, places in `active`, ascending; put in order of slices
    ///   first     solver body and contact at which the island begins
    struct Island {
        std::span<std::uint32_t> bodies, contacts;
        Slice first;
    };

    /// Cuts an island and appends its slices, as far as bodies and contacts go; one slice of the
    /// whole where there is nothing to cut. Positions and ids alone decide.
    void split(const Island& island,
               const ActiveContacts& active,
               const BodyStates& states,
               std::span<const Vec3> positions,
               const SplitRule& rule,
               std::vector<Slice>& slices);

private:
    // A thin sheet across the island: the contacts whose nearer body lies in it, and the last bin
    // that one of them touches.
    struct Bin {
        std::uint32_t contacts = 0, last_bin = 0;
    };

    bool bin_bodies(std::span<const std::uint32_t> bodies, std::span<const Vec3> positions);
    void bin_contacts(std::span<const std::uint32_t> contacts,
                      const ActiveContacts& active,
                      const BodyStates& states);
    std::size_t choose_slices(std::size_t least);
    void put_in_order(std::vector<std::uint32_t>& bin_of_item,
                      std::size_t slices,
                      std::span<std::uint32_t> items,
                      std::vector<std::uint32_t>& begin);

    std::vector<Box3> boxes_;             // of blocks of bodies
    std::vector<std::uint32_t> bin_of_;   // by body
    std::vector<std::uint32_t> of_body_;  // bins of the island's bodies; then their slices
    std::vector<std::uint32_t> of_contact_;
    std::vector<std::vector<Bin>> of_block_;
    std::vector<Bin> bins_;
    std::vector<std::uint32_t> slice_of_bin_;
    std::vector<std::uint32_t> body_begin_, contact_begin_, ordered_;
    BucketSort sort_;
};

}  // namespace throng
