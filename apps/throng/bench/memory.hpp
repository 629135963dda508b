// Memory: what a piece of work leaves behind, in the heap and in the machine's memory.
#pragma once

#include <cstdint>

namespace throng::bench {

/// Bytes that grew while something ran; several of these may be at work in turns.
class MemoryGrowth {
public:
    void begin();
    void end();
    double heap() const { return static_cast<double>(heap_); }  // handed out by malloc
    double resident() const { return static_cast<double>(resident_); }

private:
    std::int64_t heap_ = 0, resident_ = 0;
    std::int64_t heap_at_ = 0, resident_at_ = 0;
};

/// Gives back what is free, so that what comes next grows from nothing.
void trim_memory();

}  // namespace throng::bench
