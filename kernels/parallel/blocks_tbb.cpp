// Blocks on oneTBB.
//
// The pool is an arena of its own. oneTBB starts workers only on demand and may start fewer than
// asked for, so the constructor holds a rendezvous: no task of it ends before all have begun.
#include "kernels/parallel/block_watch.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/parallel/race_notes.hpp"
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

namespace {

// A loop that threads share.
class SharedLoop {
public:
    SharedLoop(std::size_t count, std::size_t grain, const BlockBody& body)
        : count_(count), grain_(grain), body_(body), counted_(work_count())
    { }

    void run(std::size_t begin, std::size_t end) const
    {
        const TaskNotes::Run run(notes_);
        const WorkCountScope counted(counted_);
        for (std::size_t block = begin; block < end; ++block)
            body_(block * grain_, std::min(count_, (block + 1) * grain_), block);
    }

private:
    std::size_t count_, grain_;
    const BlockBody& body_;
    WorkCount* counted_;
    TaskNotes notes_;
};

struct LoopPart {
    const SharedLoop* loop;

    THRONG_CALLED_BY_SCHEDULER void operator()(const tbb::blocked_range<std::size_t>& range) const
    {
        loop->run(range.begin(), range.end());
    }
};

}  // namespace

void for_each_block(std::size_t count, std::size_t grain, BlockBody body)
{
    if (run_watched(count, grain, body)) return;
    const std::size_t blocks = block_count(count, grain);
    // One thread gains nothing from being asked through the scheduler.
    if (blocks <= 1 || tbb::this_task_arena::max_concurrency() == 1) {
        for (std::size_t block = 0; block < blocks; ++block)
            body(block * grain, std::min(count, (block + 1) * grain), block);
        return;
    }
    const SharedLoop loop(count, grain, body);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks, 1), LoopPart{&loop},
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
class Rendezvous {
public:
    explicit Rendezvous(int threads) : threads_(threads) { }

    void arrive()
    {
        const TaskNotes::Run run(notes_);
        {
            const std::lock_guard lock(guard_);
            who_.insert(std::this_thread::get_id());
        }
        ++arrived_;
        while (arrived_ < threads_ && Clock::now() < deadline_) std::this_thread::yield();
    }
    int met()
    {
        const std::lock_guard lock(guard_);
        return static_cast<int>(who_.size());
    }

private:
    using Clock = std::chrono::steady_clock;
    int threads_;
    std::atomic<int> arrived_{0};
    std::mutex guard_;
    std::set<std::thread::id> who_;
    Clock::time_point deadline_ = Clock::now() + std::chrono::seconds(2);
    TaskNotes notes_;
};

struct Arrival {
    Rendezvous* rendezvous;

    THRONG_CALLED_BY_SCHEDULER void operator()() const { rendezvous->arrive(); }
};

int wait_for_threads(tbb::task_arena& arena, int threads)
{
    Rendezvous rendezvous(threads);
    arena.execute([&] {
        tbb::task_group group;
        for (int i = 0; i < threads; ++i) group.run(Arrival{&rendezvous});
        group.wait();
    });
    return rendezvous.met();
}

}  // namespace

ThreadPool::ThreadPool(int threads)
    : threads_(threads > 0 ? threads
                           : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))),
      inside_(std::make_unique<Inside>(threads_))
{
    met_ = threads_ == 1 ? 1 : wait_for_threads(inside_->arena, threads_);
}

ThreadPool::~ThreadPool() = default;

void ThreadPool::run(const BlockBody& body)
{
    inside_->arena.execute([&] { body(0, 1, 0); });
}

}  // namespace throng
