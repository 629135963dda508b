#include "kernels/parallel/work_count.hpp"

#include <atomic>

namespace throng {

WorkCount::WorkCount()
{
    static std::atomic<std::uint64_t> numbers{0};
    number_ = ++numbers;
}

int WorkCount::threads() const
{
    const std::lock_guard lock(guard_);
    return static_cast<int>(seen_.size());
}

// A thread mostly works for the count that it worked for last.
void WorkCount::note()
{
    thread_local std::uint64_t last = 0;  // NOLINT: each thread its own
    if (last == number_) return;
    last = number_;
    const std::lock_guard lock(guard_);
    seen_.insert(std::this_thread::get_id());
}

WorkCount*& work_count()
{
    thread_local WorkCount* count = nullptr;  // NOLINT: each thread its own
    return count;
}

}  // namespace throng
