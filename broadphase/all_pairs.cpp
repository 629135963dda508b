#include "broadphase/all_pairs.hpp"

#include <algorithm>

namespace throng {

void AllPairs::find(const OverlapQuery& query, std::vector<PairKey>& pairs)
{
    const std::size_t count = query.boxes.size();
    asked_.assign(count, 0);
    for (const std::uint32_t id : query.asked) asked_[id] = 1;

    pairs.clear();
    for (const std::uint32_t a : query.asked) {
        if (meets_nothing(query.boxes[a])) continue;
        for (std::uint32_t b = 0; b < count; ++b) {
            // Two asked ones see each other; the lower id reports.
            if (b == a || (asked_[b] != 0 && b < a)) continue;
            if (query.moving[a] == 0 && query.moving[b] == 0) continue;
            if (!query.boxes[a].overlaps(query.boxes[b]) || meets_nothing(query.boxes[b])) continue;
            if (query.filter != nullptr && !query.filter->allows(a, b)) continue;
            pairs.push_back(pair_key(a, b));
        }
    }
    std::sort(pairs.begin(), pairs.end());
}

}  // namespace throng
