// Same bytes: whether two objects are alike to the last bit, which tells the two zeros apart.
#pragma once

#include <cstring>

namespace throng::given {

/// Of objects that have no padding.
template <class T>
bool same_bytes(const T& x, const T& y)
{
    // By way of void, which says that bytes are meant and no values.
    const void *const a = &x, *const b = &y;
    return std::memcmp(a, b, sizeof(T)) == 0;
}

}  // namespace throng::given
