// GJK as a method: distance of what is apart, and by EPA the depth of what is not.
#pragma once

#include "kernels/geometry/hill_climbing.hpp"
#include "narrowphase/convex/convex_pair.hpp"

namespace throng {

/// Touch, distance and depth of two convex shapes of any kind.
///
/// `plain` looks at every vertex for each support, the others climb (hill_climbing.hpp) and walk
/// the same way. `cached` first asks whether the direction that parted the two last time still
/// parts them by more than the speculative margin, then begins with the differences that the last
/// walk ended on. Rounds are those of GJK, at most 128, and of EPA, at most 508, and the supports
/// that prove an answer. Allocates nothing but the marks of climbing.
///
/// Error: distances within 1e-13 of the size; depths within 1e-13 of it for polytopes and 1e-6 for
///        cylinders, where it is not cut short.
/// Source: Cameron, Enhancing GJK (1997), for the climbing and for what is kept between steps.
MethodAnswer query_gjk(const ConvexPair& pair,
                       double speculative_margin,
                       MethodStart start,
                       MethodMemory& memory);

/// The same; adds what climbing took to the count.
MethodAnswer query_gjk(const ConvexPair& pair,
                       double speculative_margin,
                       MethodStart start,
                       MethodMemory& memory,
                       HillClimbingCount& count);

}  // namespace throng
