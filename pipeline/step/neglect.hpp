// Neglect: how far off a body comes for what is left out of it.
#pragma once

namespace throng {

/// s: the time in which nothing that is left out may be seen.
inline constexpr double kNeglectWindow = 0.1;

/// Of the error that may be seen, what leaving out may come to by itself: contacts pass it on, and
/// may make twice as much of it, as the scenes of the catalogue do at worst.
inline constexpr double kOfError = 0.5;

/// How far an angular acceleration, rad/s2, turns a body in that time, rad.
inline double turned_in_window(double acceleration)
{
    return 0.5 * kNeglectWindow * kNeglectWindow * acceleration;
}

}  // namespace throng
