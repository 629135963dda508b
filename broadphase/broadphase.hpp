// Broad phase: boxes in, pairs of boxes that overlap out.
//
// All finders report the same pairs, in the same order; they differ in speed alone. all_pairs is
// the plain answer sheet for the others. What is asked and what is right: overlap_query.hpp.
#pragma once

#include "broadphase/all_pairs.hpp"
#include "broadphase/embree_tree.hpp"
#include "broadphase/sweep_and_prune.hpp"
#include "broadphase/uniform_grid.hpp"

#include <variant>

namespace throng {

/// A way to find pairs: `pairs` becomes the answer, ascending, none twice.
template <class T>
concept PairFinder = requires(T finder, const OverlapQuery& query, std::vector<PairKey>& pairs)
{
    finder.find(query, pairs);
};

/// The finders on offer. To add one: write it, list it, and every finder test runs on it.
using AnyPairFinder = std::variant<EmbreeTree, UniformGrid, SweepAndPrune, AllPairs>;
enum class FinderKind : std::uint8_t { embree, grid, sweep, all_pairs };

void find_overlaps(const OverlapQuery& query, AnyPairFinder& finder, std::vector<PairKey>& pairs);

AnyPairFinder make_finder(FinderKind kind);

/// The finder that should be fastest for these boxes, by how many there are and how mixed their
/// sizes. Depends on the boxes alone. A finder that takes over from another
/// knows nothing: ask it about all, with still_changed.
FinderKind choose_finder(std::span<const Box3> boxes, std::span<const std::uint8_t> moving);

}  // namespace throng
