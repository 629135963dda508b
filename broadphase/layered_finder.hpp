// Layered finder: the body of the template that layers.hpp declares, for the sources of finders.
#pragma once

#include "broadphase/layers.hpp"
#include "kernels/parallel/sort_keys.hpp"

namespace throng {

template <BoxIndex Index>
void LayeredFinder<Index>::find(const OverlapQuery& query, std::vector<PairKey>& pairs)
{
    pairs.clear();
    layers_.update(query);
    if (layers_.still_renewed) still_.build(layers_.still, query.boxes, layers_.origin);
    if (layers_.settled_renewed) settled_.build(layers_.settled, query.boxes, layers_.origin);

    if (layers_.join_all) {
        settled_.join({query, layers_, Place::settled, true}, pairs);
        settled_.find_overlaps(still_, {query, layers_, Place::still, true}, pairs);
    } else if (layers_.askers == layers_.moved) {
        moved_.build(layers_.moved, query.boxes, layers_.origin);
        ask(moved_, query, pairs);
    } else {
        if (!layers_.moved.empty()) moved_.build(layers_.moved, query.boxes, layers_.origin);
        askers_.build(layers_.askers, query.boxes, layers_.origin);
        ask(askers_, query, pairs);
    }
    compare_aside(query, layers_, lists_, pairs);
    sort_keys(pairs, scratch_);
}

template <BoxIndex Index>
void LayeredFinder<Index>::ask(Index& askers,
                               const OverlapQuery& query,
                               std::vector<PairKey>& pairs)
{
    if (layers_.askers.empty()) return;
    askers.find_overlaps(settled_, {query, layers_, Place::settled}, pairs);
    askers.find_overlaps(still_, {query, layers_, Place::still}, pairs);
    if (layers_.moved.empty()) return;
    if (&askers == &moved_)
        moved_.join({query, layers_, Place::moved, true}, pairs);
    else
        askers.find_overlaps(moved_, {query, layers_, Place::moved}, pairs);
}

}  // namespace throng
