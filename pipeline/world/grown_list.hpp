// Grown list: a list by body or collider that is as long as its last entry wants it.
#pragma once

#include <cstddef>
#include <utility>

namespace throng {

template <class List, class Value>
void put(List& list, std::size_t at, Value value)
{
    if (list.size() <= at) list.resize(at + 1);
    list[at] = std::move(value);
}

}  // namespace throng
