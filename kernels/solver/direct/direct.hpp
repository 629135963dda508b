// Direct: the contacts of an island solved together, exact, by sparse factorisation.
//
// Contacts are rigid, friction is a round cone, and what holds at the end is checked: no point
// closes faster than it may, none pulls, friction opposes sliding and is full where it slides.
#pragma once

#include "throng/math.hpp"

#include <memory>
#include <span>

namespace throng {

/// A body as the direct solver sees it. What cannot be moved nor turned has zeros.
struct DirectBody {
    double inverse_mass = 0;
    Sym3 inverse_inertia;  // world axes
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
};

/// A point at which two bodies meet.
///
///   a, b       places among the bodies; below 0 for what stands still
///   arm_a, _b  m, from the centers of mass
///   least      m/s, the least speed along the normal at which b may leave a: below 0 while there
///              is a gap to close
///   walk       m/s across the normal, at which friction is to have b slide on a: of who walks
///   rolling    m, of a torque that resists turning, as a share of the normal impulse
///   impulse    N s on b; torque N m s on b. In: a guess, or 0
struct DirectPoint {
    std::int32_t a = -1, b = -1;
    Vec3 normal = Vec3::UnitZ();
    Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();
    double friction = 0, rolling = 0;
    double least = 0;
    Vec3 walk = Vec3::Zero();
    Vec3 impulse = Vec3::Zero(), torque = Vec3::Zero();
};

/// How well a problem was solved.
///
///   residual  by how much the law of contact is missed, as a share of the greatest speed that the
///             contacts have to stop: the greatest over the points of the natural map
///             |r - P(r - u)|, r the impulse as a speed, u the speed after it, P onto the cone.
///             Infinite where a number of the problem, or of its answer, is not finite
///   steps     factorisations taken
struct DirectAnswer {
    double residual = 0;
    int steps = 0;
};

/// What the direct solver promises of its residual; greater is to be told.
inline constexpr double kDirectResidual = 1e-8;

/// Steps after which it is left as it is. Most problems take ten; those in which friction wedges
/// many bodies, or many points that contradict one another, may take a hundred.
inline constexpr int kDirectSteps = 400;

/// How much an answer is worth.
///
///   steps   at most
///   enough  residual that will do where a hundredth of it does not come at once
///   pivots  whether to go through tables of all rows by all rows where all else has failed, each
///           of which takes as long as hundreds of steps; half of the steps are then kept for what
///           is missed in the end
struct DirectEffort {
    int steps = kDirectSteps;
    double enough = 1e-9;
    bool pivots = true;
};

/// Finds the impulses after which, for every point, the speed u of b against a obeys
/// u_n >= least, impulse in the cone, and both or neither: (u_n - least + friction |u_t|, u_t) lies
/// in the dual cone and is square to the impulse. Where several impulses do, as on four legs, it
/// takes those in the middle, so that what is symmetric stays so.
///
/// Rolling resistance shares the cone with friction: |(tangential / friction, torque / rolling)| is
/// at most the normal impulse.
///
/// Method:  primal-dual interior point steps on the cone program of the velocities, each of which
///          factorises masses + rows' W rows over the bodies; the correction that makes its answer
///          a contact's follows along from step to step. Then who parts, sticks and slides is taken
///          as known (cone_active_set.hpp). Where that fails sweeps tell it
///          (cone_gauss_seidel.hpp), and where these do not either an augmented Lagrangian leads
///          there (cone_augmented_lagrangian.hpp); last of all the pivots of Lemke's method, with
///          many-sided cones (cone_lemke.hpp).
/// Source:  De Saxce and Feng (1998); Acary, Cadoux, Lemarechal and Malick, A formulation of the
///          linear discrete Coulomb friction problem via convex optimization (2011); Acary, Armand,
///          Nguyen and Shpakovych, Second-order cone programming for frictional contact mechanics
///          using interior point algorithm (2023).
class DirectSolver {
public:
    DirectSolver();
    ~DirectSolver();
    DirectSolver(DirectSolver&&) noexcept;
    DirectSolver& operator=(DirectSolver&&) noexcept;

    /// Gives the points their impulses and the bodies their velocities.
    DirectAnswer
    solve(std::span<DirectBody> bodies, std::span<DirectPoint> points, const DirectEffort& effort);

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

}  // namespace throng
