// Blocks on oneTBB.
//
// The pool is an arena of its own. oneTBB starts workers only on demand and may start fewer than
// asked for, so the constructor holds a rendezvous: no task of it ends before all have begun.
#include "kernels/parallel/block_watch.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/parallel/work_count.hpp"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

namespace throng {

void for_each_block(std::size_t count, std::size_t grain, BlockBody body)
{
    if (run_watched(count, grain, body)) return;
    const std::size_t blocks = block_count(count, grain);
    const auto run = [&](std::size_t block) {
        body(block * grain, std::min(count, (block + 1) * grain), block);
    };
    // One thread gains nothing from being asked through the scheduler.
    if (blocks <= 1 || tbb::this_task_arena::max_concurrency() == 1) {
        for (std::size_t block = 0; block < blocks; ++block) run(block);
        return;
    }
    WorkCount* const count_of_work = work_count();
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, blocks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            const WorkCountScope counted(count_of_work);
            for (std::size_t block = range.begin(); block < range.end(); ++block) run(block);
        },
        tbb::simple_partitioner());
}

namespace {

// More threads than cores have to be asked for, and what is asked holds for the whole program: a
// pool that has no need to leaves the host's own oneTBB alone. oneTBB obeys the least of all limits
// that live, so pools share one: that of the largest, until the last of them is gone.
class SharedLimit {
public:
    static bool wanted(int threads) { return threads > tbb::info::default_concurrency(); }

    void enter(int threads)
    {
        if (!wanted(threads)) return;
        const std::lock_guard lock(guard_);
        ++pools_;
        if (limit_ && threads <= most_) return;
        most_ = threads;
        limit_.reset();
        limit_.emplace(tbb::global_control::max_allowed_parallelism,
                       static_cast<std::size_t>(threads));
    }
    void leave(int threads)
    {
        if (!wanted(threads)) return;
        const std::lock_guard lock(guard_);
        if (--pools_ == 0) limit_.reset();
    }

private:
    std::mutex guard_;
    std::optional<tbb::global_control> limit_;
    int pools_ = 0, most_ = 0;
};

SharedLimit& shared_limit()
{
    static SharedLimit limit;
    return limit;
}

}  // namespace

struct ThreadPool::Inside {
    explicit Inside(int thread_count) : threads(thread_count), arena(thread_count)
    {
        shared_limit().enter(threads);
    }
    ~Inside() { shared_limit().leave(threads); }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;

    int threads;
    tbb::task_arena arena;
};

namespace {

// Counts the threads that can be made to stand at one spot at the same time.
int meet(tbb::task_arena& arena, int threads)
{
    using Clock = std::chrono::steady_clock;
    std::atomic<int> arrived{0};
    std::mutex guard;
    std::set<std::thread::id> who;
    const auto deadline = Clock::now() + std::chrono::seconds(2);
    arena.execute([&] {
        tbb::task_group group;
        for (int i = 0; i < threads; ++i)
            group.run([&] {
                {
                    const std::lock_guard lock(guard);
                    who.insert(std::this_thread::get_id());
                }
                ++arrived;
                while (arrived < threads && Clock::now() < deadline) std::this_thread::yield();
            });
        group.wait();
    });
    return static_cast<int>(who.size());
}

}  // namespace

ThreadPool::ThreadPool(int threads)
    : threads_(threads > 0 ? threads
                           : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))),
      inside_(std::make_unique<Inside>(threads_))
{
    met_ = threads_ == 1 ? 1 : meet(inside_->arena, threads_);
}

ThreadPool::~ThreadPool() = default;

void ThreadPool::run(const BlockBody& body)
{
    inside_->arena.execute([&] { body(0, 1, 0); });
}

}  // namespace throng
