// Flight: bodies that nothing touches, through a whole step, several side by side.
//
// Free of Eigen: the wide kernel is compiled once for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

namespace throng {

/// What holds for all bodies of a step.
struct FlightRule {
    double substep = 0;  // s
    int substeps = 1;
    double gravity[3] = {0, 0, 0};  // m/s2, of those with mass
    bool turns = false;             // bodies may turn at all
    // How uneven spins go: they stay; by implicit Euler, see after_gyroscopic_torque(); in exact
    // parts, see free_rotation.hpp.
    enum class Precession : std::uint8_t { none, implicit, split } precession = Precession::none;
};

/// The arrays of all bodies, as plain numbers.
///
///   position, linear, angular  [bodies * 3]
///   orientation                [bodies * 4]  x, y, z, w; of unit length
///   inertia                    [bodies * 6]  xx, yy, zz, xy, xz, yz in body axes
///   inverse_mass               [bodies]      0: does not fall
///   spins                      [bodies]      see Masses::gyroscopic_kind
struct FlightArrays {
    double* position;
    double* orientation;
    double* linear;
    double* angular;
    const double* inertia;
    const double* inverse_mass;
    const std::uint8_t* spins;
};

/// Takes some bodies (ids, ascending) through one step. Those that spin too fast for the kernel's
/// series or for parts as long as a substep, whose inertia has products or that would leave what a
/// step can hold are left as they are; their ids go to `left`, which has room for all. Returns how
/// many they are.
///
/// Linear motion is summed up in closed form; turning goes substep by substep in body axes, about
/// which an angular velocity stays as it is while the body turns about it. A body's result depends
/// on that body alone, and is the same bits at every width.
using FlyKernel = std::size_t (*)(const FlightRule& rule,
                                  const FlightArrays& arrays,
                                  const std::uint32_t* bodies,
                                  std::size_t count,
                                  std::uint32_t* left);

/// The kernel of the width that this run takes; see lane_width().
const FlyKernel& fly_kernel();
/// That of a width by name; null where this machine has not got it.
const FlyKernel* fly_kernel_of(const char* width);

}  // namespace throng
