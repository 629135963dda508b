#include "pipeline/world/door.hpp"

#include <stdexcept>
#include <string>

namespace throng {

void Door::enter(const char* call, Use use)
{
    const char* nobody = nullptr;
    if (!within_.compare_exchange_strong(nobody, call, std::memory_order_acquire)) refuse(call);
    if (!halfway_ || use == Use::looks) return;
    within_.store(nullptr, std::memory_order_release);
    throw std::logic_error(
        std::string(call)
        + ": an exception ended a step of this world halfway; it can be read, and"
          " has to be made anew");
}

void Door::refuse(const char* call) const
{
    const char* const within = within_.load(std::memory_order_relaxed);
    throw std::logic_error(std::string(call) + ": the world is within "
                           + (within != nullptr ? within : "another call")
                           + "(); call it once that has returned, and from one thread at a time");
}

}  // namespace throng
