// Pair input: what every function that looks at a pair of shapes is given.
#pragma once

#include "kernels/data/shapes.hpp"

namespace throng {

/// Two shapes, b placed in a's frame. In a braced list: {shapes, a, b, b_in_a, speculative_margin}.
///
///   b_in_a              computed in double: exact however far from the origin
///   speculative_margin  m, points further apart than this are left out (at least 0)
template <class Real>
struct PairInput {
    const Shapes& shapes;
    ShapeRef a, b;
    const PoseT<Real>& b_in_a;
    Real speculative_margin = 0;
};

}  // namespace throng
