// Race notes: who waits for whom, told to the race checker where it cannot see it: oneTBB is not
// built for it. In any other build nothing is left of them.
//
// Each tells no more than what the scheduler promises, so that whatever is not ordered by that is a
// race still.
#pragma once

#if defined(__SANITIZE_THREAD__)

#include <sanitizer/tsan_interface.h>

// What a scheduler calls, and hands its own copy of: the copy it made out of sight.
#define THRONG_CALLED_BY_SCHEDULER __attribute__((no_sanitize_thread))

namespace throng {

inline constexpr bool kChecksRaces = true;

/// All that this thread has done comes before whatever follows the event.
inline void note_before(const char& event) { __tsan_release(const_cast<char*>(&event)); }
/// All that came before the event comes before what this thread does from now on.
inline void note_after(const char& event) { __tsan_acquire(const_cast<char*>(&event)); }

}  // namespace throng

#else

#define THRONG_CALLED_BY_SCHEDULER

namespace throng {

inline constexpr bool kChecksRaces = false;
inline void note_before(const char&) { }
inline void note_after(const char&) { }

}  // namespace throng

#endif

namespace throng {

/// A task that somebody else is to run: it comes after who has it done, and before who has waited
/// for it.
class TaskNotes {
public:
    TaskNotes() { note_before(begun_); }
    ~TaskNotes() { note_after(ended_); }
    TaskNotes(const TaskNotes&) = delete;
    TaskNotes& operator=(const TaskNotes&) = delete;

    /// Lives while the task runs, or a part of it.
    class Run {
    public:
        explicit Run(const TaskNotes& notes) : notes_(notes) { note_after(notes_.begun_); }
        ~Run() { note_before(notes_.ended_); }
        Run(const Run&) = delete;
        Run& operator=(const Run&) = delete;

    private:
        const TaskNotes& notes_;
    };

private:
    char begun_ = 0, ended_ = 0;
};

}  // namespace throng
