// Solve kernels: the wide kernels of the solver: contacts into constraints, iterations over them,
// substeps of bodies.
//
// The blocks of a call may be solved in any order and by any thread, provided they share no body
// (coloring sees to that). Width is chosen once, when the program starts; the answer never depends
// on it.
#pragma once

#include "kernels/data/contact_constraints.hpp"

#include <cstddef>

namespace throng {

/// From this turn (rad) on, advance() leaves turning to turn_fast().
inline constexpr double kFastTurn = 0.25;

/// How much deeper a contact may be that three or four points carry before it turns rigid.
inline constexpr int kSharedDeep = 3;

/// What is asked of an iteration.
template <class Real>
struct SolverIteration {
    Real inverse_substep = 0;  // 1/s
    Real push_limit = 0;       // m/s, fastest that overlap is pushed apart
    bool use_bias = false;     // push overlap apart; else only take away what pushing left behind
    bool turns = true;         // some body can turn: without, the angular half is not computed
    bool has_friction = true;  // some contact has friction
    bool has_rolling_friction =
        false;  // some contact resists rolling: constraints.rolling_frictions is there
    int normal_iterations = 2;  // times the points are gone through; the last one after friction
    bool friction_at_points = false;  // friction at each point: asked by solve_point_friction alone
    bool friction_pyramid = false;    // friction within a pyramid: likewise
    Real restitution_threshold =
        0;                      // m/s: what comes in slower than that rests, and does not bounce
    Real gravity_step[3] = {};  // m/s, what gravity adds in a substep: asked by impacts alone
};

/// Where the numbers of a contact are, counted in numbers of its kind (see Contact): the kernels
/// turn whole lines of them.
namespace contact_numbers {
inline constexpr int kNormal = 0, kCenterOffset = 3, kFriction = 6, kRolling = 9, kRoundA = 12,
                     kRoundB = 13, kTorsionalImpulse = 14;
inline constexpr int kPoints = 16, kPoint = 6;                     // the first; of each
inline constexpr int kAnchorA = 0, kSeparation = 3, kImpulse = 4;  // of a point
inline constexpr int kAll = 40;
}  // namespace contact_numbers

/// Sixteen contacts as they are kept, before the solver's own numbers are made of them.
template <class Real>
struct PackedContacts {
    const Real* contact[kBlock];  // kAll numbers of each
    Lane16<Real> count;           // points
    Lane16<Real> friction, restitution, rolling_friction, bias_rate, impulse_scale, deep;
    Lane16<Real> on_rim;  // 1 for those that roll on a rim, else 0
};

/// The constraints and bodies that the kernels work on. Null where an effect does not act.
template <class Real>
struct ContactConstraintsView {
    ContactConstraintWide<Real>* blocks = nullptr;
    ContactPointWide<Real>* points = nullptr;
    RestitutionWide<Real>* restitutions = nullptr;
    RollingFrictionWide<Real>* rolling_frictions = nullptr;
    SolverBody<Real>* bodies = nullptr;
    PointFrictionWide<Real>* point_frictions = nullptr;
    SurfaceVelocityWide<Real>* surface_velocities = nullptr;
    const SolverPrescribedVelocity<Real>* prescribed = nullptr;
    GyroscopicInertia<Real>* inertias = nullptr;
    const std::uint8_t* precesses = nullptr;
    TurningArmsWide<Real>* turning_arms = nullptr;
    const RoundRim* rims = nullptr;

    /// Of a batch whose islands call for that.
    static ContactConstraintsView of(ContactConstraints<Real>& constraints,
                                     const IslandCalls& calls)
    {
        ContactConstraintsView view = of(constraints);
        const auto keep = [](bool called, auto*& list) {
            if (!called) list = nullptr;
        };
        keep(calls.effects.has(Effect::restitution), view.restitutions);
        keep(calls.effects.has(Effect::rolling_friction), view.rolling_frictions);
        keep(calls.effects.has(Effect::friction), view.point_frictions);
        keep(calls.effects.has(Effect::gyroscopic), view.inertias);
        keep(calls.effects.has(Effect::gyroscopic), view.precesses);
        keep(calls.effects.has(Effect::drive), view.prescribed);
        keep(calls.surfaces_go(), view.surface_velocities);
        keep(calls.swings, view.turning_arms);
        keep(calls.rolls, view.rims);
        return view;
    }
    static ContactConstraintsView of(ContactConstraints<Real>& constraints)
    {
        return {constraints.blocks.data(),
                constraints.points.data(),
                constraints.restitutions.empty() ? nullptr : constraints.restitutions.data(),
                constraints.rolling_frictions.empty() ? nullptr
                                                      : constraints.rolling_frictions.data(),
                constraints.bodies.data(),
                constraints.point_frictions.empty() ? nullptr : constraints.point_frictions.data(),
                constraints.surface_velocities.empty() ? nullptr
                                                       : constraints.surface_velocities.data(),
                constraints.prescribed.empty() ? nullptr : constraints.prescribed.data(),
                constraints.inertias.empty() ? nullptr : constraints.inertias.data(),
                constraints.precesses.empty() ? nullptr : constraints.precesses.data(),
                constraints.turning_arms.empty() ? nullptr : constraints.turning_arms.data(),
                constraints.rims.empty() ? nullptr : constraints.rims.data()};
    }
};

/// What a substep does to bodies before contacts push them.
template <class Real>
struct Substep {
    Real gravity[3] = {};  // m/s, what gravity adds
    Real time = 0;         // s
    bool first = false;    // of the step: nothing has been pushed yet
    enum class Gyroscopic : std::uint8_t { off, implicit, direct } gyroscopic = Gyroscopic::off;
};

/// How often the points of a contact that strike together are solved.
inline constexpr int kRestitutionIterations = 8;

/// Who goes less far in a substep than this share of the overlap that a contact turns rigid at has
/// come to rest: another round of impacts is not for him.
inline constexpr double kAtRest = 1e-4;

/// The solver's kernels for one width. All work in place on the blocks from `begin` to before
/// `end`, or on `count` solver bodies.
///
///   prepare                  fills the block at `place` (whose lanes have their bodies, points and
///                            first_point already) from contacts as they are kept
///   warm_start               gives the bodies the impulses that the contacts hold
///   update_surface_velocity  tells SurfaceVelocityWide::speed, half a substep ahead of where the
///                            bodies are. Needs ContactConstraintsView::surface_velocities
///   walk_surface_velocity    tells SurfaceVelocityWide::speed of those at `place` who walk, see
///                            driven_contacts.hpp, by their bodies as the step begins. Needs
///                            ContactConstraintsView::surface_velocities and prescribed
///   solve                    moves every point towards its wanted normal speed, never pulling;
///                            then friction, a round cone of the contact's normal impulse; then the
///                            points again
///   update_masses            effective masses of those at `place` whose arms have changed: bit a
///                            lane
///   apply_restitution        impacts, one contact after another: points that come in faster than
///                            `restitution_threshold` and would touch before the substep ends leave
///                            again, those of a contact together, with friction within the cone of
///                            what the impact loads it with. Tells whether any did that was not all
///                            but at rest
///   begin_substep            stops bodies that ran away; adds gravity and the gyroscopic torque;
///                            then, but in the first substep, what all contacts gave in the last
///                            one: within a step arms and inertia do not change, but for those that
///                            turn_arms() sees to, so it is `motion` less `free`, and no contact
///                            has to be asked. `inertias` null: no gyroscopic torque;
///                            `precesses` null: one may act on any of them
///   advance                  moves and turns bodies by their velocities for a time; returns how
///                            many turn too fast for it and were moved only (see turn_fast)
///
/// Three more for friction of another kind, at each point or within a pyramid, as the iteration
/// asks. They need ContactConstraintsView::point_frictions, and constraints prepared as for bodies
/// that turn.
///
///   warm_start_point_friction         shares the friction that a contact holds among its points by
///                                     their loads, so that they add up to the same force and
///                                     torque; then as warm_start
///   solve_point_friction              as solve, with friction of that kind
///   apply_restitution_point_friction  as apply_restitution, likewise
///
/// Source: Catto, Iterative Dynamics with Temporal Coherence (2005) for impulses that accumulate;
///         Catto, Solver2D (2024) for substeps of soft contacts with a relaxing iteration.
template <class Real>
struct SolveKernels {
    const char* name;
    int lanes;
    void (*prepare)(const PackedContacts<Real>& packed,
                    std::size_t place,
                    const ContactConstraintsView<Real>& constraints,
                    bool turns);
    void (*update_masses)(const ContactConstraintsView<Real>& constraints,
                          std::size_t place,
                          std::uint16_t lanes);
    void (*warm_start)(const ContactConstraintsView<Real>& constraints,
                       std::size_t begin,
                       std::size_t end,
                       const SolverIteration<Real>& iteration);
    void (*update_surface_velocity)(const ContactConstraintsView<Real>& constraints,
                                    std::size_t begin,
                                    std::size_t end,
                                    Real half);
    void (*walk_surface_velocity)(const ContactConstraintsView<Real>& constraints,
                                  std::size_t place,
                                  const Real (&up)[3]);
    void (*solve)(const ContactConstraintsView<Real>& constraints,
                  std::size_t begin,
                  std::size_t end,
                  const SolverIteration<Real>& iteration);
    bool (*apply_restitution)(const ContactConstraintsView<Real>& constraints,
                              std::size_t begin,
                              std::size_t end,
                              const SolverIteration<Real>& iteration);
    void (*begin_substep)(SolverBody<Real>* bodies,
                          const GyroscopicInertia<Real>* inertias,
                          const std::uint8_t* precesses,
                          std::size_t count,
                          const Substep<Real>& substep);
    std::size_t (*advance)(SolverBody<Real>* bodies,
                           const GyroscopicInertia<Real>* inertias,
                           const std::uint8_t* precesses,
                           std::size_t count,
                           Real time,
                           bool turns);
    void (*warm_start_point_friction)(const ContactConstraintsView<Real>& constraints,
                                      std::size_t begin,
                                      std::size_t end,
                                      const SolverIteration<Real>& iteration);
    void (*solve_point_friction)(const ContactConstraintsView<Real>& constraints,
                                 std::size_t begin,
                                 std::size_t end,
                                 const SolverIteration<Real>& iteration);
    bool (*apply_restitution_point_friction)(const ContactConstraintsView<Real>& constraints,
                                             std::size_t begin,
                                             std::size_t end,
                                             const SolverIteration<Real>& iteration);
};

/// The kernels of one width: "scalar", "avx2" or "avx512"; none where the machine has not got it
/// or the name is another.
template <class Real>
const SolveKernels<Real>* solve_kernels_of(const char* width);

/// The widest that this machine has, or what the environment variable THRONG_LANES asks for.
/// Throws std::runtime_error, saying what there is, where that cannot be had.
template <class Real>
const SolveKernels<Real>& solve_kernels();

}  // namespace throng
