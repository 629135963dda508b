#include "kernels/motion/solver_bodies.hpp"

#include "kernels/math/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace throng {

namespace {

// The quaternion x, y, z, w of a turn. The series is exact to double below a quarter radian, which
// is nearly always; a faster turn takes the long way.
template <class Real>
void small_turn(const Real (&turn)[3], Real (&q)[4])
{
    const Real squared = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    Real scale = 0;
    if (squared < Real(0.0625)) {
        const Real z = squared / 4;  // of the half angle
        scale = (1 - z / 6 * (1 - z / 20 * (1 - z / 42 * (1 - z / 72)))) / 2;
        q[3] = 1 - z / 2 * (1 - z / 12 * (1 - z / 30 * (1 - z / 56 * (1 - z / 90))));
    } else {
        const double angle = std::sqrt(double{squared});
        const SinCos half = sin_cos(angle / 2);
        scale = static_cast<Real>(half.sin / angle);
        q[3] = static_cast<Real>(half.cos);
    }
    for (int k = 0; k < 3; ++k) q[k] = turn[k] * scale;
}

}  // namespace

template <class Real>
void add_velocity(std::span<SolverBody<Real>> bodies, const Vec3& change)
{
    const Vec3T<Real> by = change.cast<Real>();
    for (SolverBody<Real>& body : bodies)
        if (body.inertia[0] > 0)
            for (int k = 0; k < 3; ++k) body.motion[k] += by[k];
}

template <class Real>
void stop_runaways(std::span<SolverBody<Real>> bodies)
{
    constexpr Real kGreatest = Real(1e16);
    for (SolverBody<Real>& body : bodies) {
        bool sound = true;
        for (const Real number : body.motion) sound = sound && std::abs(number) < kGreatest;
        if (sound) continue;
        std::fill(std::begin(body.motion), std::end(body.motion), Real(0));
        std::fill(std::begin(body.inertia), std::end(body.inertia), Real(0));
        body.drift[3] = 1;
    }
}

template <class Real>
void move_bodies(std::span<SolverBody<Real>> bodies, Real time)
{
    for (SolverBody<Real>& body : bodies)
        for (int k = 0; k < 3; ++k) body.drift[k] += body.motion[k] * time;
}

template <class Real>
void turn_bodies(std::span<SolverBody<Real>> bodies, Real time)
{
    for (SolverBody<Real>& body : bodies) {
        const Real turn[3] = {body.motion[4] * time, body.motion[5] * time, body.motion[6] * time};
        if (turn[0] == 0 && turn[1] == 0 && turn[2] == 0) continue;
        Real p[4];
        small_turn(turn, p);
        Real* q = body.drift + 4;
        const Real x = p[3] * q[0] + p[0] * q[3] + p[1] * q[2] - p[2] * q[1];
        const Real y = p[3] * q[1] - p[0] * q[2] + p[1] * q[3] + p[2] * q[0];
        const Real z = p[3] * q[2] + p[0] * q[1] - p[1] * q[0] + p[2] * q[3];
        const Real w = p[3] * q[3] - p[0] * q[0] - p[1] * q[1] - p[2] * q[2];
        const Real length = std::sqrt(x * x + y * y + z * z + w * w);
        q[0] = x / length;
        q[1] = y / length;
        q[2] = z / length;
        q[3] = w / length;
    }
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void add_velocity<Real>(std::span<SolverBody<Real>>, const Vec3&);                    \
    template void stop_runaways<Real>(std::span<SolverBody<Real>>);                                \
    template void move_bodies<Real>(std::span<SolverBody<Real>>, Real);                            \
    template void turn_bodies<Real>(std::span<SolverBody<Real>>, Real);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
