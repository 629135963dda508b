#include "apps/throng/instructions.hpp"

#include <cerrno>
#include <cstring>
#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace throng {

InstructionCounter::InstructionCounter()
{
    perf_event_attr wanted = {};
    wanted.size = sizeof wanted;
    wanted.type = PERF_TYPE_HARDWARE;
    wanted.config = PERF_COUNT_HW_INSTRUCTIONS;
    wanted.inherit = 1;
    wanted.exclude_kernel = 1;
    wanted.exclude_hv = 1;
    constexpr int kThis = 0, kAnyProcessor = -1, kNoGroup = -1;
    file_ = static_cast<int>(
        syscall(SYS_perf_event_open, &wanted, kThis, kAnyProcessor, kNoGroup, 0UL));
    if (count()) return;
    trouble_ = errno == ENOENT || errno == EOPNOTSUPP
        ? "this machine does not show its processor's counter"
        : "the processor's counter is not for this user (perf_event_open: "
            + std::string(std::strerror(errno)) + ")";
}

InstructionCounter::~InstructionCounter()
{
    if (file_ >= 0) close(file_);
}

std::optional<std::uint64_t> InstructionCounter::count() const
{
    std::uint64_t counted = 0;
    if (file_ < 0 || read(file_, &counted, sizeof counted) != sizeof counted) return std::nullopt;
    return counted;
}

}  // namespace throng
