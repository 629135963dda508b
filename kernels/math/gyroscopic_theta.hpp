// Gyroscopic theta: where in a time the gyroscopic torque is taken, for numbers and for lanes of
// them.
#pragma once

namespace throng {

/// As a share of the time (the theta of the theta method): its middle, which is exact to second
/// order, and towards its end of what turns by a radian and more, which damps what no step of that
/// length can follow.
///
///   squared  of the angle that the body turns by, rad
///
/// Source: Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I (1993), II.7.
template <class Real>
Real gyroscopic_theta(const Real& squared)
{
    const Real one = 1.0F, half = 0.5F;
    return one - half / (one + squared);
}

}  // namespace throng
