// Mesh sides: from which side a shape meets each triangle of a mesh.
//
// A piece that encloses a volume is met from outside. Any other has two sides, and a shape is on
// the one that its center is on. Once it touches there it stays there, until it has gone round a
// rim: pressed in so deep that its center has come through, it is pushed back the way it came.
#pragma once

#include "kernels/data/mesh.hpp"
#include "narrowphase/convex/pair_input.hpp"
#include "narrowphase/mesh/mesh_pairs.hpp"

#include <span>

namespace throng {

/// In the number of a triangle: it is touched from behind.
inline constexpr std::uint32_t kBehind = 0x80000000u;

class MeshSides {
public:
    /// near    triangles that the shape may touch, ascending
    /// held    those that it touched in the last step, each with its side
    /// through m, its smallest half extent: a center further than this behind a triangle has come
    ///         through only where no other is in the way, as one that touches the other flank of a
    ///         ridge is behind this one too
    MeshSides(const Mesh& mesh,
              std::span<const std::uint32_t> near,
              std::span<const std::uint32_t> held,
              const Vec3& center,
              double through);

    struct Approach {
        bool any = true;       // it may touch at all
        bool behind = false;   // from behind
        bool through = false;  // its center has come through
        bool known = false;    // it did so before, here or over an edge
    };
    Approach approach(std::uint32_t triangle) const;

    /// Whether the place of a triangle that is nearest to a point of its plane is hidden from the
    /// center by another that is near.
    bool is_hidden(const Vec3& point, std::uint32_t triangle) const;

private:
    double height(std::uint32_t triangle) const;
    int side_held(std::uint32_t triangle) const;
    Approach crossed(std::uint32_t triangle, bool behind) const;
    bool is_inside_of(std::uint32_t triangle) const;

    const Mesh& mesh_;
    std::span<const std::uint32_t> near_, held_;
    Vec3 center_;
    double through_;
    bool came_ = false;  // through one of those that it touched
};

/// The same as collide_mesh() of mesh_pairs.hpp for a shape that touched the triangles `held` in
/// the last step; those that are touched from behind have kBehind in their number.
///
///   near  what NearTriangles found of the pair; those held are added to it
void collide_mesh(const PairInput<double>& in,
                  std::span<const std::uint32_t> held,
                  std::vector<std::uint32_t>& near,
                  std::vector<PartManifold>& out);

}  // namespace throng
