// Pair functions: the signature that every entry of the shape-by-shape table shares.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "narrowphase/convex/pair_input.hpp"

namespace throng {

/// Finds where two convex shapes touch or come within the margin of one another.
///
///   in     a's kind not after b's kind in ShapeKind (collide() sees to that)
///   cache  what the pair remembers
///   out    in a's frame; count 0 where nothing is within the margin
///
/// Never throws; finite input gives finite output. Instantiated for float and double.
template <class Real>
using PairFunction = void (*)(const PairInput<Real>& in,
                              PairCache& cache,
                              LocalManifold<Real>& out);

/// In a cache's kind, of this call alone: what `auto` asked came to its bound, and another method
/// answered.
inline constexpr std::uint32_t kFellBack = 1u << 31;

// One declaration for each function in the table of dispatch.cpp.
#define THRONG_PAIR_FUNCTION(name)                                                                 \
    template <class Real>                                                                          \
    void name(const PairInput<Real>&, PairCache&, LocalManifold<Real>&)

THRONG_PAIR_FUNCTION(sphere_sphere);  // sphere_pairs.cpp
THRONG_PAIR_FUNCTION(sphere_capsule);
THRONG_PAIR_FUNCTION(sphere_cylinder);
THRONG_PAIR_FUNCTION(sphere_box);
THRONG_PAIR_FUNCTION(sphere_hull);
THRONG_PAIR_FUNCTION(capsule_capsule);  // capsule_pairs.cpp
THRONG_PAIR_FUNCTION(capsule_box);      // capsule_box.cpp
THRONG_PAIR_FUNCTION(capsule_hull);     // capsule_hull.cpp
THRONG_PAIR_FUNCTION(box_box);          // box_box.cpp
THRONG_PAIR_FUNCTION(hull_hull);        // hull_hull.cpp: box-hull too, a box being a hull
THRONG_PAIR_FUNCTION(convex_plane);     // plane_pairs.cpp: any convex shape a, plane b
THRONG_PAIR_FUNCTION(convex_convex);    // convex_pairs.cpp: any two, by their cores

#undef THRONG_PAIR_FUNCTION

/// As hull_hull(), which may ask GJK where hulls are large, by all separating axes.
void hull_hull_by_axes(const PairInput<double>&, PairCache&, LocalManifold<double>&);

// For the file that defines one: its instances.
#define THRONG_PAIR_INSTANCE(name, Real)                                                           \
    template void name<Real>(const PairInput<Real>&, PairCache&, LocalManifold<Real>&);
#define THRONG_PAIR_INSTANCES(name)                                                                \
    THRONG_PAIR_INSTANCE(name, float) THRONG_PAIR_INSTANCE(name, double)

}  // namespace throng
