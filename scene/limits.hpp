// Limits: the sizes that a step can hold.
//
// They leave room for what a step makes of a number: masses and moments stay inside float, with
// their inverses, and distances inside what squares and cubes of them can hold.
#pragma once

namespace throng {

inline constexpr double kGreatestLength = 1e15;  // m, of places and sizes; m/s and rad/s too
inline constexpr double kLeastLength = 1e-12;
inline constexpr double kGreatestMass = 1e30, kLeastMass = 1e-30;      // kg
inline constexpr double kGreatestMoment = 1e37, kLeastMoment = 1e-37;  // kg m2
inline constexpr double kGreatestWhole = 9007199254740992.0;  // 2^53: each below is a double
inline constexpr double kGreatestNumber = 1e30;  // forces, stiffnesses and other factors
inline constexpr double kUnitTolerance = 1e-6;   // a direction may be off by this much

}  // namespace throng
