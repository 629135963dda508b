// Errors: how far a setting drifts from the reference in a window, each with a name and a unit.
#pragma once

#include "cost/windows/body_states.hpp"

#include <array>
#include <span>
#include <string_view>

namespace throng {

/// What is measured of a window:
///
///   drift     m, of the centers of mass from where the reference has them at the window's end
///   turn      rad, between the orientations there and the reference's
///   velocity  m/s, of the centers' velocities from the reference's
///   overlap   m, the greatest at the window's end, of any two shapes
///   energy    J, that the window's steps made from nothing, by the energy ledger
enum class Measure : std::uint8_t { drift, turn, velocity, overlap, energy };
inline constexpr std::size_t kMeasures = 5;

struct MeasureInfo {
    std::string_view name, unit, about;
};
const MeasureInfo& info(Measure measure);
/// The names, in order.
std::array<std::string_view, kMeasures> measure_names();
/// Throws std::invalid_argument, which names what there is.
Measure measure_named(std::string_view name);

/// The squares of a window's errors, averaged over its bodies where they are of bodies: the root of
/// their average over windows is what is told.
using WindowErrors = std::array<double, kMeasures>;

inline double& of(WindowErrors& errors, Measure measure)
{
    return errors[static_cast<std::size_t>(measure)];
}
inline double of(const WindowErrors& errors, Measure measure)
{
    return errors[static_cast<std::size_t>(measure)];
}

/// Puts in drift, turn and velocity: infinite where a body was lost on the way.
void compare(const BodyStates& states, const BodyStates& reference, WindowErrors& errors);

/// The root of the average of one measure over windows.
double rms(std::span<const WindowErrors> windows, Measure measure);

/// What rms() stays below in 19 of 20 other choices of as many windows like these: by drawing from
/// them again and again (bootstrap), always in the same way.
///
/// Source: Efron and Tibshirani, An introduction to the bootstrap (1993), chapter 13; with half a
///         standard error more, as drawing from few tells their spread too small.
double rms_at_most(std::span<const WindowErrors> windows, Measure measure);

}  // namespace throng
