// Blocks: a loop cut the same way whatever the number of threads.
//
// The cut depends on count and grain alone, so whatever a block computes is the same on one thread
// and on sixty-four; only who runs it and when differs.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace throng {

/// A function that is called and not kept: no allocation, no copy.
class BlockBody {
public:
    template <class Function>
    BlockBody(const Function& function)  // NOLINT(google-explicit-constructor): reads as a lambda
        : object_(&function),
          call_([](const void* object, std::size_t begin, std::size_t end, std::size_t block) {
              (*static_cast<const Function*>(object))(begin, end, block);
          })
    { }
    void operator()(std::size_t begin, std::size_t end, std::size_t block) const
    {
        call_(object_, begin, end, block);
    }

private:
    const void* object_;
    void (*call_)(const void*, std::size_t, std::size_t, std::size_t);
};

constexpr std::size_t block_count(std::size_t count, std::size_t grain)
{
    return (count + grain - 1) / grain;
}

/// Calls body(begin, end, block) for each block of `grain` of the numbers below `count` (the last
/// may be shorter), on the threads of the pool that the caller runs in. A single block runs on the
/// calling thread at once. Blocks may run at the same time and in any order.
void for_each_block(std::size_t count, std::size_t grain, BlockBody body);

/// The threads that run blocks. While one lives, for_each_block() inside run() uses it.
class ThreadPool {
public:
    /// threads: at least 1; 0 for as many as the machine has cores. Every one of them is started
    /// and met before the constructor returns, even where there are fewer cores than threads.
    explicit ThreadPool(int threads);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    int threads() const { return threads_; }
    /// How many threads were met when the pool was made: the ones that really run.
    int threads_met() const { return met_; }
    /// Runs the body inside the pool and waits for it.
    void run(const BlockBody& body);

private:
    struct Inside;
    int threads_ = 1;
    int met_ = 1;
    std::unique_ptr<Inside> inside_;
};

}  // namespace throng
