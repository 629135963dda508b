// Places between: further points of a patch that bends, where those that span it do not tell what
// lies between them.
#pragma once

#include "kernels/data/manifolds.hpp"

#include <vector>

namespace throng {

/// Takes one after another of the points that is furthest from all that are taken, until none is
/// further than `spacing` or `most` were added. What lies shallower than the deepest counts as
/// nearer: by `shallow` times what its depth lacks.
///
///   taken  places in `points`, to which others are appended; empty: the deepest comes first
void take_between(const std::vector<LocalManifold<double>::Point>& points,
                  double spacing,
                  double shallow,
                  std::size_t most,
                  std::vector<std::size_t>& taken);

}  // namespace throng
