// Chung-Wang: the search for a direction along which two convex shapes lie apart.
#pragma once

#include "narrowphase/alternatives/convex_methods.hpp"

namespace throng {

/// Whether two shapes touch, and the normal of a plane that parts them where they do not.
///
/// Takes a direction s and the points of the two that are furthest along it and against it. If
/// these lie apart along s, so do the shapes; if not, s is mirrored in the plane across their
/// difference r, which turns it towards every direction that parts the two:
///
///     s' = s - 2 (r . s) r
///
/// All r so far are kept, as the cone of directions that none of them speaks against. Once it is
/// empty the shapes touch, and a mirrored direction outside of it is not tried, for it cannot part
/// them: the middle of the cone is. So each round leaves a good part of the directions behind, and
/// the search cannot go round in circles as it does by mirroring alone. Within rounding (1e-14 of
/// the size) of just touching, shapes count as touching. After 96 rounds the search is cut short,
/// undecided: shapes with a separation or depth of 1e-9 of their size have not been seen to need
/// 40.
///
/// Round shapes are points of their core pushed outwards along s. The first direction leads from
/// center to center. Vertices of boxes and hulls are climbed to from those of the round before;
/// plain looks at every one.
///
/// Remembered: the direction last tried and the vertices found along it; of polytopes that touch,
/// the up to four pairs of vertices whose differences leave no direction. Either is seen in one
/// round to hold still.
///
/// Source: Chung, Wang, Quick Collision Detection of Polytopes in Virtual Environments (1996);
///         Chung, An Efficient Collision Detection Algorithm for Polytopes in Virtual Environments
///         (thesis, 1996).
MethodAnswer query_chung_wang(const ConvexPair& pair,
                              double speculative_margin,
                              MethodStart start,
                              MethodMemory& memory);

}  // namespace throng
