// Wide hull: what a hull keeps of itself for wide arithmetic.
#pragma once

#include "kernels/data/wide_polytope.hpp"

#include <vector>

namespace throng {

/// Made once, with the hull. Without vertices where the hull is too big, or too thin for float.
struct WideHull {
    struct alignas(64) Group {
        float at[kWideGroup];
    };
    int vertices = 0, faces = 0;
    float inner = 0, outer = 0;
    // In the order of WidePolytope.
    std::vector<Group> numbers;
    std::vector<WideEdge> edges;
    std::vector<std::uint16_t> indices;

    /// It lives as long as this does, unchanged.
    WidePolytope view() const
    {
        return {numbers.data()->at,
                edges.data(),
                indices.data(),
                vertices,
                faces,
                static_cast<int>(edges.size()),
                inner,
                outer};
    }
};

}  // namespace throng
