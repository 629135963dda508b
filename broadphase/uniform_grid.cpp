#include "broadphase/uniform_grid.hpp"

#include "broadphase/cell_table.hpp"
#include "kernels/parallel/compact.hpp"
#include "kernels/parallel/sort_keys.hpp"

#include <algorithm>

namespace throng {
namespace {

constexpr std::size_t kGrain = 128;  // colliders a block: some 50 microseconds of work

}  // namespace

struct UniformGrid::Inside {
    CellTable table;
    BlockLists<PairKey> lists;
    std::vector<PairKey> scratch;
};

UniformGrid::UniformGrid() : inside_(std::make_unique<Inside>()) { }
UniformGrid::~UniformGrid() = default;
UniformGrid::UniformGrid(UniformGrid&&) noexcept = default;
UniformGrid& UniformGrid::operator=(UniformGrid&&) noexcept = default;

void UniformGrid::find(const OverlapQuery& query, std::vector<PairKey>& pairs)
{
    pairs.clear();
    inside_->table.update(query);
    BlockLists<PairKey>& lists = inside_->lists;
    const std::vector<std::uint32_t>& searched = inside_->table.searched();
    lists.start(block_count(searched.size(), kGrain));
    for_each_block(searched.size(), kGrain, [&](auto begin, auto end, auto block) {
        for (std::size_t i = begin; i < end; ++i)
            inside_->table.find_overlaps(query, searched[i], lists[block]);
    });
    lists.append_to(pairs);
    sort_keys(pairs, inside_->scratch);
    clear_closely(inside_->scratch);
    // Two cells of one search may share a bucket.
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace throng
