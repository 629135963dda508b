// Capacity: how lists that follow the size of a world grow, so that little of them lies idle.
//
// Doubling leaves a list a third empty on average. These grow by an eighth: what settles is copied
// a few times more on its way there, once.
#pragma once

#include <cstddef>
#include <vector>

namespace throng {

/// Sees to it that `count` items fit.
template <class T>
void reserve_closely(std::vector<T>& list, std::size_t count)
{
    if (count > list.capacity()) list.reserve(count + count / 8);
}

/// resize() that grows by an eighth.
template <class T>
void resize_closely(std::vector<T>& list, std::size_t count)
{
    reserve_closely(list, count);
    list.resize(count);
}

/// Empties a scratch list, and gives its memory back where it has room for far more than it held.
template <class T>
void clear_closely(std::vector<T>& list)
{
    constexpr std::size_t kFew = 4096 / sizeof(T);
    if (list.capacity() > 4 * list.size() + kFew)
        std::vector<T>().swap(list);
    else
        list.clear();
}

}  // namespace throng
