// All pairs: every asked collider against every other.
//
// Slow and plain, the answer sheet for the other finders; the fastest one for a handful of boxes.
#pragma once

#include "broadphase/overlap_query.hpp"

namespace throng {

class AllPairs {
public:
    void find(const OverlapQuery& query, std::vector<PairKey>& pairs);

private:
    std::vector<std::uint8_t> asked_;
};

}  // namespace throng
