// Work count: how many threads had a share in some work.
//
// A pool may be larger than what it is given to do: a step of a few bodies is over before a second
// thread is awake.
#pragma once

#include <cstdint>
#include <mutex>
#include <set>
#include <thread>

namespace throng {

class WorkCount {
public:
    WorkCount();
    WorkCount(const WorkCount&) = delete;
    WorkCount& operator=(const WorkCount&) = delete;

    /// How many threads have worked so far.
    int threads() const;

private:
    friend class WorkCountScope;
    void note();

    std::uint64_t number_;  // none has another's
    mutable std::mutex guard_;
    std::set<std::thread::id> seen_;
};

/// The count that the calling thread's work goes to; null for none. Blocks of a loop that is begun
/// there go to it wherever they run.
WorkCount*& work_count();

/// Counts the calling thread, and sends its work to a count for a while; null for nothing of it.
class WorkCountScope {
public:
    explicit WorkCountScope(WorkCount* count) : before_(work_count())
    {
        work_count() = count;
        if (count != nullptr) count->note();
    }
    ~WorkCountScope() { work_count() = before_; }
    WorkCountScope(const WorkCountScope&) = delete;
    WorkCountScope& operator=(const WorkCountScope&) = delete;

private:
    WorkCount* before_;
};

}  // namespace throng
