// Blocks on plain threads: the twin of blocks_tbb.cpp that a race checker can see through.
//
// A pool of std::thread takes blocks from a counter under one mutex. Simple rather than fast.
#include "kernels/parallel/block_watch.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/parallel/work_count.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace throng {

namespace {

class Crew {
public:
    explicit Crew(int threads)
    {
        for (int i = 1; i < threads; ++i) helpers_.emplace_back([this] { serve(); });
    }
    ~Crew()
    {
        {
            const std::lock_guard lock(guard_);
            closing_ = true;
        }
        wake_.notify_all();
        for (std::thread& helper : helpers_) helper.join();
    }
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

    // Runs blocks [0, blocks) on all threads and waits for the last one.
    void run(std::size_t blocks, const BlockBody& body)
    {
        std::unique_lock lock(guard_);
        if (body_ != nullptr) {  // a loop within a loop runs where it is
            lock.unlock();
            for (std::size_t block = 0; block < blocks; ++block) body(block, block + 1, block);
            return;
        }
        body_ = &body;
        next_ = 0;
        end_ = blocks;
        left_ = blocks;
        wake_.notify_all();
        work(lock);
        done_.wait(lock, [this] { return left_ == 0; });
        body_ = nullptr;
    }

private:
    void work(std::unique_lock<std::mutex>& lock)
    {
        while (next_ < end_) {
            const std::size_t block = next_++;
            const BlockBody* body = body_;
            lock.unlock();
            (*body)(block, block + 1, block);
            lock.lock();
            if (--left_ == 0) done_.notify_all();
        }
    }
    void serve()
    {
        std::unique_lock lock(guard_);
        while (true) {
            wake_.wait(lock, [this] { return closing_ || next_ < end_; });
            if (closing_) return;
            work(lock);
        }
    }

    std::mutex guard_;
    std::condition_variable wake_, done_;
    std::vector<std::thread> helpers_;
    const BlockBody* body_ = nullptr;
    std::size_t next_ = 0, end_ = 0, left_ = 0;
    bool closing_ = false;
};

// The crew that the calling thread works for, if any.
thread_local Crew* current_crew = nullptr;  // NOLINT: one thread, one crew

}  // namespace

void for_each_block(std::size_t count, std::size_t grain, BlockBody body)
{
    if (run_watched(count, grain, body)) return;
    const std::size_t blocks = block_count(count, grain);
    WorkCount* const count_of_work = work_count();
    const auto run = [&](std::size_t block, std::size_t, std::size_t) {
        const WorkCountScope counted(count_of_work);
        body(block * grain, std::min(count, (block + 1) * grain), block);
    };
    if (blocks <= 1 || current_crew == nullptr) {
        for (std::size_t block = 0; block < blocks; ++block) run(block, block + 1, block);
        return;
    }
    current_crew->run(blocks, run);
}

struct ThreadPool::Inside {
    explicit Inside(int threads) : crew(threads) { }
    Crew crew;
};

ThreadPool::ThreadPool(int threads)
    : threads_(threads > 0 ? threads
                           : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))),
      met_(threads_), inside_(std::make_unique<Inside>(threads_))
{ }

ThreadPool::~ThreadPool() = default;

void ThreadPool::run(const BlockBody& body)
{
    Crew* const before = current_crew;
    current_crew = &inside_->crew;
    body(0, 1, 0);
    current_crew = before;
}

}  // namespace throng
