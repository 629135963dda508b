// Active bounds: boxes of colliders that move, several side by side.
//
// Free of Eigen: the wide kernel is compiled once for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

namespace throng {

/// What holds for all colliders of a call.
struct ActiveBoundsRule {
    double dt = 0;  // s, the step
    double resting =
        0;             // share of the smallest half extent that the speculative margin is at least
    double falls = 0;  // m, that it is at least besides
    double base = 0, steps = 0, longest = 0;  // see MarginRule
    double loose = 1e300;                     // see MarginRule
};

/// How the kernel can place a shape: all that lie at the center of their body, and are a box
/// (which a sphere or capsule is, thickened by a radius) or a cylinder.
enum class ActiveBoundsForm : std::uint8_t { other, box, cylinder };

/// The arrays of all bodies and colliders, as plain numbers.
///
///   position, linear, angular  [bodies * 3]
///   orientation                [bodies * 4]     x, y, z, w
///   half                       [colliders] each  m, half extents along the shape's axes
///   round                      [colliders]      m, on every side beyond them; the cylinder's
///   radius form, inner, outer         [colliders]      see Colliders::inner_extent, outer_radius
///   placed              [colliders * 7]  position and orientation
///   boxes               [colliders * 6]  lower and upper corner, margin included
///   speculative_margin  [colliders]      m
///   near                [colliders * 8]  see NearBox
struct ActiveBoundsArrays {
    const double *position, *linear, *angular, *orientation;
    const float *half[3], *round;
    const std::uint8_t* form;
    const double *inner, *outer;
    double *placed, *boxes, *speculative_margin;
    float* near;
};

/// Brings some colliders (ids, ascending, none `other`) up to date: placed,
/// reach and near of all, boxes of those that left theirs. The ids of these go to `asked`, which
/// has room for all; returns how many they are. The same bits at every width.
using ActiveBoundsKernel = std::size_t (*)(const ActiveBoundsRule& rule,
                                           const ActiveBoundsArrays& arrays,
                                           const std::uint32_t* colliders,
                                           const std::uint32_t* bodies,
                                           std::size_t count,
                                           std::uint32_t* asked);

/// The kernel of the width that this run takes; see lane_width().
const ActiveBoundsKernel& active_bounds_kernel();
/// That of a width by name; null where this machine has not got it.
const ActiveBoundsKernel* active_bounds_kernel_of(const char* width);

}  // namespace throng
