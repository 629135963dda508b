// Memory: what a piece of work leaves behind, in the heap and in the machine's memory.
#include "apps/throng/bench/memory.hpp"

#include <fstream>
#include <malloc.h>
#include <unistd.h>

namespace throng::bench {
namespace {

std::int64_t heap_bytes()
{
    const struct mallinfo2 info = ::mallinfo2();
    return static_cast<std::int64_t>(info.uordblks + info.hblkhd);
}

std::int64_t resident_bytes()
{
    std::int64_t all = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return resident * ::sysconf(_SC_PAGESIZE);
}

}  // namespace

void MemoryGrowth::begin()
{
    heap_at_ = heap_bytes();
    resident_at_ = resident_bytes();
}

void MemoryGrowth::end()
{
    heap_ += heap_bytes() - heap_at_;
    resident_ += resident_bytes() - resident_at_;
}

void trim_memory() { ::malloc_trim(0); }

}  // namespace throng::bench
