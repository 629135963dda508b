// Body state: where bodies are and how they move, of many at once.
#pragma once

#include "throng/math.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace throng {

/// The state of all bodies as a world keeps it, by index; places of removed bodies included, whose
/// numbers mean nothing. Nothing is copied; good until the next step or change of the world.
///
///   center      m: the center of mass, or the pivot of a body that is on one
///   generation  of the body at each place: with the index its BodyId, where it is alive
///   awake       1 for who moves or may begin to; 0 for sleepers, static and removed bodies
///   active_dynamic, active_kinematic  indices of those who were as the last step began, ascending
struct StateSpans {
    std::span<const Vec3> center;
    std::span<const Quat> orientation;
    std::span<const Vec3> velocity, angular_velocity;  // m/s, rad/s, world axes
    std::span<const std::uint32_t> generation;
    std::span<const std::uint8_t> awake;
    std::span<const std::uint32_t> active_dynamic, active_kinematic;
};

/// Some numbers of each of many bodies, wherever a program keeps them: those of one lie `stride`
/// bytes behind those of the one before. Without a first, they are left out.
template <class Number>
struct Strided {
    Number* first = nullptr;
    std::size_t stride = 0;

    Number* of(std::size_t i) const
    {
        using Byte = std::conditional_t<std::is_const_v<Number>, const std::byte, std::byte>;
        return reinterpret_cast<Number*>(reinterpret_cast<Byte*>(first) + i * stride);
    }
};

/// What is read or written of each body. Position and orientation are of the body's own frame,
/// orientation as w, x, y, z; velocity is of the center of mass.
template <class Number>
struct StateColumns {
    Strided<Number> position;          // 3 numbers
    Strided<Number> orientation;       // 4
    Strided<Number> velocity;          // 3
    Strided<Number> angular_velocity;  // 3
};

}  // namespace throng
