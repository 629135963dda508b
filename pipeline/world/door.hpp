// Door: who may come into a world while something is done to it.
//
// A world is changed and stepped by one call at a time. A program that calls it from a function of
// its own that a step calls, or from two threads, is told so, and the world is left as it is: it
// would be read half done otherwise, or never come back. To read between steps is for any number of
// threads.
#pragma once

#include <atomic>
#include <cstdint>

namespace throng {

class Door {
public:
    /// Throws std::logic_error, naming both calls, while the world is stepped.
    void need_no_step(const char* call) const
    {
        if (within_.load(std::memory_order_relaxed) == kStep) refuse(call);
    }

    /// What may be done with a world that a step left halfway.
    enum class Use : std::uint8_t { looks, changes };

    /// What is at work in a world, until its end. Who looks, too, where something is made of the
    /// world for that and kept.
    class Entry {
    public:
        /// Throws std::logic_error, naming the calls, while another is at work; and who changes the
        /// world once a step was ended halfway.
        Entry(Door& door, const char* call, Use use = Use::changes) : door_(door)
        {
            door.enter(call, use);
        }
        Entry(const Entry&) = delete;
        Entry& operator=(const Entry&) = delete;
        ~Entry() { door_.within_.store(nullptr, std::memory_order_release); }

    private:
        Door& door_;
    };

    /// A step. Where its end is not told, an exception has left the world halfway.
    class Step {
    public:
        explicit Step(Door& door) : door_(door), entry_(door, kStep) { }
        ~Step()
        {
            if (!ended_) door_.halfway_ = true;
        }
        void end() { ended_ = true; }

    private:
        Door& door_;
        bool ended_ = false;
        Entry entry_;
    };

private:
    static constexpr const char kStep[] = "step";

    void enter(const char* call, Use use);
    [[noreturn]] void refuse(const char* call) const;

    std::atomic<const char*> within_ = nullptr;  // the call at work
    bool halfway_ = false;
};

}  // namespace throng
