// Near triangles: those of a mesh that a shape may touch.
#pragma once

#include "kernels/geometry/mesh.hpp"
#include "narrowphase/convex/pair_input.hpp"

#include <vector>

namespace throng {

/// The triangles of a mesh, or of a solid, whose boxes, or k-DOPs where it has them, are within the
/// margin of a shape's; sought for several pairs side by side, as large meshes are far from the
/// processor.
class NearTriangles {
public:
    void clear() { count_ = waiting_ = 0; }
    /// Asks for those of a pair, a: mesh or solid; b: convex.
    void add(const PairInput<double>& in);
    /// Finds those of all that were added.
    void find();
    /// Of the n-th that was added, ascending.
    std::vector<std::uint32_t>& of(std::size_t n) { return found_[n]; }

private:
    std::size_t count_ = 0, waiting_ = 0;
    std::vector<std::vector<std::uint32_t>> found_;  // count_ of them in use
    std::vector<TriangleSearch> searches_;           // waiting_ of them in use
    std::vector<std::size_t> searched_for_;          // [searches_] places among found_
};

}  // namespace throng
