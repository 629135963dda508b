// Instructions: how many the program takes, by the processor's own counter.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace throng {

/// Counts those of this thread, and of threads that it begins later, outside of the kernel. Of
/// Linux (perf_event_open); many virtual machines hide the counter, and containers forbid it.
class InstructionCounter {
public:
    InstructionCounter();
    ~InstructionCounter();
    InstructionCounter(const InstructionCounter&) = delete;
    InstructionCounter& operator=(const InstructionCounter&) = delete;

    /// Why they cannot be counted; empty where they can.
    const std::string& trouble() const { return trouble_; }
    /// Since it was made; none where they cannot be counted.
    std::optional<std::uint64_t> count() const;

private:
    int file_ = -1;
    std::string trouble_;
};

}  // namespace throng
