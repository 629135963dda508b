// Follow: a list whose items move to other places and keep their order, some gone and some new,
// without a second list.
//
// Runs of items that go down move from the first on, those that go up from the last on, so that
// none lands on one that has yet to move. One thread does it: each item moves once, which is what
// the memory takes; shared among threads it would move three times.
#pragma once

#include "kernels/parallel/capacity.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace throng {

/// In place of where an item was: it is new.
inline constexpr std::uint32_t kNewItem = 0xffffffffu;

/// Puts at each place i what was at from[i]. Where that is kNewItem, make(n) is put there, for the
/// n-th new one. What is named nowhere is gone: lose(item) is told of it, in order.
///
/// Needs:   all of `from` but the new ones ascending.
template <class T, class Make, class Lose>
void follow(std::span<const std::uint32_t> from,
            std::vector<T>& items,
            const Make& make,
            const Lose& lose)
{
    const std::size_t count = from.size(), before = items.size();
    const auto at = [&](std::size_t place) {
        return items.begin() + static_cast<std::ptrdiff_t>(place);
    };
    resize_closely(items, std::max(count, before));

    std::size_t fresh = 0, next = 0;
    for (std::size_t i = 0; i < count;) {
        const std::uint32_t old = from[i];
        if (old == kNewItem) {
            ++fresh;
            ++i;
            continue;
        }
        std::size_t run = 1;
        while (i + run < count && from[i + run] == old + run) ++run;
        std::for_each(at(next), at(old), lose);
        if (i < old) std::copy(at(old), at(old + run), at(i));
        next = old + run;
        i += run;
    }
    std::for_each(at(next), at(before), lose);

    // Nothing goes up before the first new one.
    for (std::size_t end = count; fresh > 0;) {
        const std::uint32_t last = from[end - 1];
        if (last == kNewItem) {
            items[--end] = make(--fresh);
            continue;
        }
        std::size_t run = 1;
        while (run < end && from[end - 1 - run] + run == last) ++run;
        const std::size_t old = last + 1 - run;
        if (end - run > old) std::copy_backward(at(old), at(old + run), at(end));
        end -= run;
    }
    items.resize(count);
}

}  // namespace throng
