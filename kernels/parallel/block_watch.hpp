// Block watch: somebody who wants to see which blocks of a loop ran, where and when.
//
// A loop looks for a watch once, before it begins; while nobody watches that is all it costs.
#pragma once

#include "kernels/parallel/blocks.hpp"

namespace throng {

class BlockWatch {
public:
    virtual ~BlockWatch() = default;
    /// Runs block(begin, end, number) once, on the thread that it is called on.
    virtual void
    run_block(const BlockBody& block, std::size_t begin, std::size_t end, std::size_t number) = 0;
};

/// The watch of loops that the calling thread begins; null for nobody. Blocks of a watched loop are
/// watched wherever they run, and so are loops within them.
BlockWatch*& block_watch();

/// Sets the calling thread's watch for a while.
class BlockWatchScope {
public:
    explicit BlockWatchScope(BlockWatch* watch) : before_(block_watch()) { block_watch() = watch; }
    ~BlockWatchScope() { block_watch() = before_; }
    BlockWatchScope(const BlockWatchScope&) = delete;
    BlockWatchScope& operator=(const BlockWatchScope&) = delete;

private:
    BlockWatch* before_;
};

/// For the loop itself: runs it with its blocks watched and gives true, where somebody watches.
bool run_watched(std::size_t count, std::size_t grain, const BlockBody& body);

}  // namespace throng
