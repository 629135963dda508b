// Block watch: somebody who wants to see which blocks of a loop ran, where and when.
#include "kernels/parallel/block_watch.hpp"

namespace throng {

BlockWatch*& block_watch()
{
    thread_local BlockWatch* watch = nullptr;  // NOLINT: each thread its own
    return watch;
}

bool run_watched(std::size_t count, std::size_t grain, const BlockBody& body)
{
    BlockWatch* const watch = block_watch();
    if (watch == nullptr) return false;
    const BlockWatchScope unwatched(nullptr);  // or the loop below would come here again
    for_each_block(count, grain, [&](std::size_t begin, std::size_t end, std::size_t number) {
        const BlockWatchScope within(watch);
        watch->run_block(body, begin, end, number);
    });
    return true;
}

}  // namespace throng
