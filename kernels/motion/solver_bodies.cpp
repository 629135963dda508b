#include "kernels/motion/solver_bodies.hpp"

#include "kernels/math/rotation.hpp"
#include "kernels/solve/sweep.hpp"

#include <cmath>

namespace throng {

template <class Real>
void turn_fast(std::span<SolverBody<Real>> bodies, Real time)
{
    for (SolverBody<Real>& body : bodies) {
        const Real turn[3] = {body.motion[4] * time, body.motion[5] * time, body.motion[6] * time};
        const Real squared = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
        if (squared < static_cast<Real>(kFastTurn * kFastTurn)) continue;
        const double angle = std::sqrt(double{squared});
        const SinCos half = sin_cos(angle / 2);
        const auto scale = static_cast<Real>(half.sin / angle);
        const QuatT<Real> by(static_cast<Real>(half.cos), turn[0] * scale, turn[1] * scale,
                             turn[2] * scale);
        Real* const q = body.drift + 4;
        QuatT<Real> after = by * QuatT<Real>(q[3], q[0], q[1], q[2]);
        after.coeffs() /= std::sqrt(after.squaredNorm());
        for (int k = 0; k < 4; ++k) q[k] = after.coeffs()[k];
    }
}

template void turn_fast<float>(std::span<SolverBody<float>>, float);
template void turn_fast<double>(std::span<SolverBody<double>>, double);

}  // namespace throng
