// Follow: a list whose items move to other places and keep their order, some gone and some new,
// without a second list.
//
// Each block of places first draws its items together where they are; then blocks move as a whole,
// those that go down from the first on and those that go up from the last on, so that none lands on
// one that has yet to move; then each spreads its items out from the front, with room between them
// for the new ones.
#pragma once

#include "kernels/parallel/blocks.hpp"
#include "kernels/parallel/room.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace throng {

/// In place of where an item was: it is new.
inline constexpr std::uint32_t kNewItem = 0xffffffffu;

namespace detail {

/// What becomes of a block of places: its items lie from `begin` on before they move as a whole.
struct FollowedBlock {
    std::size_t begin = 0, kept = 0, fresh = 0;
};

constexpr std::size_t kFollowGrain = 8192;

// The first of the old items behind all that places before this one hold.
inline std::size_t behind(std::span<const std::uint32_t> from, std::size_t place)
{
    while (place > 0 && from[place - 1] == kNewItem) --place;
    return place > 0 ? from[place - 1] + std::size_t{1} : 0;
}

template <class T>
void move_blocks(const std::vector<FollowedBlock>& blocks, std::size_t count, std::vector<T>& items)
{
    const auto at = [&](std::size_t place) {
        return items.begin() + static_cast<std::ptrdiff_t>(place);
    };
    const auto target = [&](std::size_t block) {
        return std::min(count, (block + 1) * kFollowGrain) - blocks[block].kept;
    };
    for (std::size_t i = 0; i < blocks.size(); ++i)
        if (const auto [begin, kept, fresh] = blocks[i]; target(i) < begin)
            std::copy(at(begin), at(begin + kept), at(target(i)));
    for (std::size_t i = blocks.size(); i-- > 0;)
        if (const auto [begin, kept, fresh] = blocks[i]; target(i) > begin)
            std::copy_backward(at(begin), at(begin + kept), at(target(i) + kept));
}

}  // namespace detail

/// Blocks that follow() cuts a list of so many into; what is lost may belong to one more.
constexpr std::size_t follow_blocks(std::size_t count)
{
    return block_count(count, detail::kFollowGrain) + 1;
}

/// Puts at each place i what was at from[i]. Where that is kNewItem, make(n) is put there, for the
/// n-th new one. What is named nowhere is gone: lose(item, block) is told of it, of those of a
/// block in order; blocks may run at once.
///
/// Needs:   all of `from` but the new ones ascending.
template <class T, class Make, class Lose>
void follow(std::span<const std::uint32_t> from,
            std::vector<T>& items,
            const Make& make,
            const Lose& lose)
{
    const std::size_t count = from.size(), before = items.size();
    std::vector<detail::FollowedBlock> blocks(block_count(count, detail::kFollowGrain));
    const auto lose_all = [&](std::size_t begin, std::size_t end, std::size_t block) {
        for (std::size_t i = begin; i < end; ++i) lose(items[i], block);
    };
    for_each_block(count, detail::kFollowGrain, [&](auto begin, auto end, auto block) {
        std::size_t next = detail::behind(from, begin), to = next;
        detail::FollowedBlock& part = blocks[block];
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t old = from[i];
            if (old == kNewItem) continue;
            lose_all(next, old, block);
            if (part.kept++ == 0) part.begin = to = old;
            if (to != old) items[to] = items[old];
            ++to;
            next = old + std::size_t{1};
        }
    });
    lose_all(detail::behind(from, count), before, blocks.size());

    std::size_t fresh = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        blocks[i].fresh = fresh;
        const std::size_t begin = i * detail::kFollowGrain;
        fresh += std::min(count - begin, detail::kFollowGrain) - blocks[i].kept;
    }
    resize_closely(items, std::max(count, before));
    detail::move_blocks(blocks, count, items);
    for_each_block(count, detail::kFollowGrain, [&](auto begin, auto end, auto block) {
        std::size_t next = end - blocks[block].kept, n = blocks[block].fresh;
        for (std::size_t i = begin; i < next; ++i)
            items[i] = from[i] == kNewItem ? make(n++) : items[next++];
    });
    items.resize(count);
}

}  // namespace throng
