// Ray layers: where parallel rays are inside a shape, as intervals of depth.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace throng {

/// Rays along z through an evenly spaced grid of x and y.
///
///   pixel   m, from one ray to the next
///   first   of the grid's first ray, in pixels: whole numbers, by which a ray is known again
///   shift   in pixels, added to all of them
///   count   of rays along x and along y
struct RayGrid {
    double pixel = 0;
    std::array<std::int32_t, 2> first{};
    std::array<double, 2> shift{};
    std::array<std::int32_t, 2> count{};

    double at(std::size_t axis, std::int32_t i) const
    {
        return (first[axis] + i + shift[axis]) * pixel;
    }
    std::size_t rays() const
    {
        return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]);
    }
};

/// A part of a ray inside a body.
///
///   enter, leave   m, z where it begins and ends; infinite for what has no end
///   *_face         for DepthImage::normal(), of a mesh the triangle; kNoFace where there is no
///                  surface
struct RayInterval {
    static constexpr std::uint32_t kNoFace = std::numeric_limits<std::uint32_t>::max();

    double enter = 0, leave = 0;
    std::uint32_t enter_face = kNoFace, leave_face = kNoFace;
};

/// The intervals of all rays of a grid, x fastest.
///
///   begin  [rays + 1] into intervals; those of a ray do not overlap, and ascend
struct RayLayers {
    RayGrid grid;
    std::vector<std::uint32_t> begin;
    std::vector<RayInterval> intervals;
};

}  // namespace throng
