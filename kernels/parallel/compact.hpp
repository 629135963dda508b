// Compact: the results of blocks, put end to end in block order.
//
// Each block of for_each_block() fills a list of its own, so nobody waits and nothing depends on
// who came first; joining them in block order gives the list that one thread would have written.
#pragma once

#include "kernels/parallel/blocks.hpp"
#include "kernels/parallel/capacity.hpp"

#include <algorithm>
#include <vector>

namespace throng {

/// Puts a list in ascending order, with nothing in it twice.
template <class T>
void keep_each_once(std::vector<T>& list)
{
    if (!std::is_sorted(list.begin(), list.end())) std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// One list per block. Lists keep their capacity from call to call, but for what they have no use
/// for.
template <class T>
class BlockLists {
public:
    /// Makes the lists of the first `blocks` blocks empty and ready.
    void start(std::size_t blocks)
    {
        if (lists_.size() < blocks) lists_.resize(blocks);
        used_ = blocks;
        for (std::size_t block = 0; block < used_; ++block) clear_closely(lists_[block]);
    }
    std::vector<T>& operator[](std::size_t block) { return lists_[block]; }
    std::size_t bytes() const
    {
        std::size_t sum = 0;
        for (const auto& list : lists_) sum += list.capacity() * sizeof(T);
        return sum;
    }

    /// Appends every list, in block order, to what `all` already holds.
    void append_to(std::vector<T>& all)
    {
        starts_.resize(used_ + 1);
        starts_[0] = all.size();
        for (std::size_t block = 0; block < used_; ++block)
            starts_[block + 1] = starts_[block] + lists_[block].size();
        all.resize(starts_[used_]);

        // Copies of some 64 KiB and more are worth another thread; a few blocks go to each.
        const std::size_t bytes = (starts_[used_] - starts_[0]) * sizeof(T);
        const std::size_t grain =
            std::max<std::size_t>(1, bytes == 0 ? used_ : used_ * kCopyBytes / bytes);
        for_each_block(used_, grain, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t block = begin; block < end; ++block)
                std::copy(lists_[block].begin(), lists_[block].end(),
                          all.begin() + static_cast<std::ptrdiff_t>(starts_[block]));
        });
    }

private:
    static constexpr std::size_t kCopyBytes = 1 << 18;
    std::vector<std::vector<T>> lists_;
    std::vector<std::size_t> starts_;
    std::size_t used_ = 0;
};

}  // namespace throng
