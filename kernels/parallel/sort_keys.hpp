// Sort keys: 64-bit numbers into ascending order, on the threads of the pool.
#pragma once

#include <cstdint>
#include <vector>

namespace throng {

/// Sorts ascending. Digits that all keys share cost nothing, so pairs of small ids sort faster than
/// random numbers. The result does not depend on threads.
///
///   scratch  as many more places as there are keys; kept by the caller between calls
void sort_keys(std::vector<std::uint64_t>& keys, std::vector<std::uint64_t>& scratch);

}  // namespace throng
