// Errors: how far a setting drifts from the reference in a window, each with a name and a unit.
#pragma once

#include "cost/windows/body_states.hpp"

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace throng {

/// What is measured of a window:
///
///   drift     m, of the centers of mass from where the reference has them at the window's end
///   turn      rad, between the orientations there and the reference's
///   velocity  m/s, of the centers' velocities from the reference's
///   overlap   m, the greatest at the window's end, of any two shapes
///   energy    J, that the window's steps made from nothing, by the energy ledger
///   momentum  N s, likewise, by the momentum ledger
///   complementarity  m/s, of contacts in the window's last step: see ContactResiduals
///   friction_cone    m/s, likewise, of friction
///   missed_contacts  share of the pairs that touch at the window's end that the last step had no
///                    contact for
///   force_error      share of its weight that is left of the forces on what rests
enum class Measure : std::uint8_t {
    drift,
    turn,
    velocity,
    overlap,
    energy,
    momentum,
    complementarity,
    friction_cone,
    missed_contacts,
    force_error
};
inline constexpr std::size_t kMeasures = 10;
/// Its place among the errors of a window.
constexpr std::size_t place_of(Measure measure) { return static_cast<std::size_t>(measure); }

struct MeasureInfo {
    std::string_view name, unit, about;
};
const MeasureInfo& info(Measure measure);
/// The names, in order.
std::array<std::string_view, kMeasures> measure_names();
/// Throws std::invalid_argument, which names what there is.
Measure measure_named(std::string_view name);

/// The squares of errors, by place of what is measured; averaged over bodies where they are of
/// bodies. The root of their average over trials is what is told. What was never put in is 0.
using Errors = std::vector<double>;

inline double& of(Errors& errors, std::size_t place)
{
    if (errors.size() <= place) errors.resize(place + 1);
    return errors[place];
}
inline double of(const Errors& errors, std::size_t place)
{
    return place < errors.size() ? errors[place] : 0;
}
inline double& of(Errors& errors, Measure measure) { return of(errors, place_of(measure)); }
inline double of(const Errors& errors, Measure measure) { return of(errors, place_of(measure)); }

/// Puts in drift, turn and velocity: infinite where a body was lost on the way.
void compare(const BodyStates& states, const BodyStates& reference, Errors& errors);

/// The root of the average over trials of what has that place.
double rms(std::span<const Errors> trials, std::size_t place);

/// What rms() stays below in 19 of 20 other choices of as many trials like these: the 99th
/// percentile of drawing from them again and again (bootstrap), always in the same way, and a
/// standard error more, as drawing from few tells their spread too small. Of one trial it is rms()
/// itself.
///
/// Source: Efron and Tibshirani, An introduction to the bootstrap (1993), chapter 13.
double rms_at_most(std::span<const Errors> trials, std::size_t place);

}  // namespace throng
