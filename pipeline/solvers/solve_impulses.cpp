// Solve impulses: contacts into constraints, constraints into impulses, velocities and poses, batch
// by batch.
#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "pipeline/forces/state_dependent_forces.hpp"
#include "pipeline/solvers/escalation.hpp"
#include "pipeline/solvers/relax_iterations.hpp"
#include "pipeline/solvers/solve_batch.hpp"
#include "pipeline/solvers/solve_direct.hpp"
#include "pipeline/solvers/split_impulse.hpp"
#include "pipeline/step/inner_rows.hpp"
#include "pipeline/step/stages.hpp"

#include <array>
#include <cmath>

namespace throng {

namespace {

constexpr std::size_t kBodies = 512;  // a block

// What calls for forces that change as bodies go: see state_dependent_forces.hpp.
constexpr Set<Effect> kStateDependent = {Effect::springs, Effect::attractors, Effect::pivot};

constexpr std::array<InnerRow, 12> soft_step_rows(std::string_view friction)
{
    return {{
        {"prepare_constraints", {Effect::contact}, "before the first substep"},
        {"apply_restitution", {Effect::restitution}, "as each substep begins"},
        {"add_gravity", {Effect::gravity}, "each substep"},
        {"turn_gyroscopic", {Effect::gyroscopic}, "each substep"},
        {"begin_state_forces", kStateDependent, "each substep"},
        {"warm_start", {Effect::contact}, "in the first substep"},
        {"solve_biased", {Effect::contact}, "each iteration"},
        {friction, {Effect::friction}, "each iteration", true},
        {"solve_rolling_friction", {Effect::rolling_friction}, "each iteration", true},
        {"move_bodies", {Effect::motion}, "each substep"},
        {"turn_bodies", {Effect::rotation}, "each substep"},
        {"relax", {Effect::contact}, "each substep"},
    }};
}

// By where friction acts, then by its cone.
constexpr std::array<InnerRow, 12> kSolveTables[2][2] = {
    {soft_step_rows("solve_friction"), soft_step_rows("solve_friction_pyramid")},
    {soft_step_rows("solve_point_friction"), soft_step_rows("solve_point_friction_pyramid")}};

constexpr InnerRow kDirectTable[] = {
    {"take_islands", {Effect::contact}, "before the first substep"},
    {"place_points", {Effect::contact}, "each substep"},
    {"add_gravity", {Effect::gravity}, "each substep"},
    {"turn_gyroscopic", {Effect::gyroscopic}, "each substep"},
    {"begin_state_forces", kStateDependent, "each substep"},
    {"solve_exactly", {Effect::contact}, "each substep"},
    {"solve_friction", {Effect::friction}, "each substep", true},
    {"solve_rolling_friction", {Effect::rolling_friction}, "each substep", true},
    {"part_overlaps", {Effect::contact}, "each substep"},
    {"apply_restitution", {Effect::restitution}, "each substep"},
    {"move_bodies", {Effect::motion}, "each substep"},
    {"turn_bodies", {Effect::rotation}, "each substep"},
};

constexpr InnerRow kPenaltyTable[] = {
    {"take_islands", {Effect::contact}, "before the first substep"},
    {"cut_substep", {Effect::contact}, "each substep"},
    {"place_points", {Effect::contact}, "each part of a substep"},
    {"add_gravity", {Effect::gravity}, "each part of a substep"},
    {"turn_gyroscopic", {Effect::gyroscopic}, "each part of a substep"},
    {"begin_state_forces", kStateDependent, "each part of a substep"},
    {"apply_penalty_forces", {Effect::contact}, "each part of a substep"},
    {"damp_sliding", {Effect::friction}, "each part of a substep", true},
    {"solve_rolling_friction", {Effect::rolling_friction}, "each part of a substep", true},
    {"move_bodies", {Effect::motion}, "each part of a substep"},
    {"turn_bodies", {Effect::rotation}, "each part of a substep"},
};

constexpr InnerRow kKinematicTable[] = {
    {"take_islands", {Effect::contact}, "before the first substep"},
    {"add_gravity", {Effect::gravity}, "each substep"},
    {"turn_gyroscopic", {Effect::gyroscopic}, "each substep"},
    {"begin_state_forces", kStateDependent, "each substep"},
    {"stop_approach", {Effect::contact}, "each iteration of a substep"},
    {"slow_sliding", {Effect::friction}, "each iteration of a substep", true},
    {"move_bodies", {Effect::motion}, "each substep"},
    {"turn_bodies", {Effect::rotation}, "each substep"},
    {"push_out", {Effect::contact}, "each iteration of a substep"},
};

// Gives one body its new state. False, and the body as it was, when that is not sound.
template <class Real>
bool take_back(const SolverBody<Real>& solver_body,
               const GyroscopicInertia<Real>* inertia,
               std::uint32_t body,
               Poses& poses,
               Velocities& velocities)
{
    const Vec3 moved(double{solver_body.delta_pose[0]}, double{solver_body.delta_pose[1]},
                     double{solver_body.delta_pose[2]});
    const Vec3 v(double{solver_body.motion[0]}, double{solver_body.motion[1]},
                 double{solver_body.motion[2]});
    const Vec3 spin(double{solver_body.motion[4]}, double{solver_body.motion[5]},
                    double{solver_body.motion[6]});
    const bool goes_along = inertia != nullptr && inertia->share[6] > 0;
    const Vec3 w = goes_along ? spin_frame(solver_body, inertia) * spin : spin;
    const Vec3 position = poses.position[body] + moved;
    Quat orientation = turn_of(solver_body) * poses.orientation[body];
    const double length = std::sqrt(orientation.squaredNorm());
    orientation.coeffs() /= length;
    return !ran_away(solver_body)
        && give_motion({position, orientation, v, w}, body, poses, velocities);
}

bool any_compound(const Colliders& colliders)
{
    return std::any_of(colliders.count.begin(), colliders.count.end(),
                       [](std::uint32_t count) { return count > 1; });
}

}  // namespace

std::span<const InnerRow> solve_table(const Settings& settings)
{
    if (settings.response == Response::penalty) return kPenaltyTable;
    if (settings.response == Response::kinematic) return kKinematicTable;
    if (settings.solver == Solver::direct) return kDirectTable;
    return kSolveTables[static_cast<std::size_t>(settings.friction_at)]
                       [static_cast<std::size_t>(settings.friction_cone)];
}

// Whether stiff springs pull at bodies of an island. Exact solves take turns with them, which over
// long substeps does not come together.
bool is_stiff(const StepContext& context,
              const RigidFacts& facts,
              const Layout& layout,
              const Batch& batch)
{
    if (facts.forces.springs.empty()) return false;
    const Slice& slice = layout.slices[batch.first_slice];
    return StateDependentForces(
               context, facts,
               std::span(layout.body_of_solver_index).subspan(slice.first_body, slice.dynamic))
        .stiff();
}

template <class Real>
void solve_impulses(const StepContext& context,
                    const Islands& islands,
                    const Layout& layout,
                    const ActiveContacts& active,
                    const Colliders& colliders,
                    const Masses& masses,
                    const Forces& forces,
                    const ExternalAcceleration& accelerations,
                    const PrescribedVelocities& prescribed,
                    ContactConstraints<Real>& constraints,
                    ConvexContacts<Real>& convex,
                    MeshContacts<Real>& meshes,
                    SolidContacts<Real>& solids,
                    Poses& poses,
                    Velocities& velocities,
                    SplitImpulse& split_impulse,
                    OverloadedIslands& overloaded,
                    StepDiagnostics& diagnostics)
{
    diagnostics.quarantined.clear();
    const ConstraintBuilder<Real> builder(context, layout, active, convex, meshes, solids,
                                          constraints);
    const RigidFacts facts{forces, masses, poses, velocities};
    const bool escalates =
        context.settings.solver != Solver::direct && context.settings.response == Response::impulse;
    const DirectEffort effort = escalates ? kExactEffort : asked_effort(context.settings);
    const DirectScene<Real> direct{context,       effort,     layout,  active, facts,
                                   accelerations, prescribed, builder, poses,  velocities};
    start_direct(layout, constraints, diagnostics);
    start_split_impulse(layout, split_impulse);
    if (!solids.entries.empty() || any_compound(colliders))
        split_wedged(active, colliders, builder, split_impulse);
    const auto solve_finer = [&](const Batch& batch) {
        StepContext finer = context;
        finer.settings.substeps *= batch.times;
        // Its overlap is that of the usual ones, which these would push apart as much faster.
        finer.settings.push_limit /= batch.times;
        finer.settings.relax_iterations = finer_relax_iterations(finer.settings, batch);
        const ConstraintBuilder<Real> with(finer, layout, active, convex, meshes, solids,
                                           constraints);
        const Slice& slice = layout.slices[batch.first_slice];
        // Impulses are kept as of the substep that the settings say.
        with.scale_impulses(slice, Real(1) / Real(batch.times));
        solve_batch(finer, facts, layout, batch, with, constraints, split_impulse);
        with.scale_impulses(slice, Real(batch.times));
    };
    // No island is escalated while bodies of it part: what makes contacts stiffer would throw
    // those apart that are deep in one another.
    const auto solve = [&](const Batch& batch) {
        const bool usual =
            escalates && split_impulse.some && uses_split_impulse(layout, batch, split_impulse);
        if (batch.direct && !usual && !(escalates && is_stiff(context, facts, layout, batch)))
            solve_direct(direct, batch, constraints, diagnostics);
        else if (batch.times > 1 && !usual)
            solve_finer(batch);
        else
            solve_batch(context, facts, layout, batch, builder, constraints, split_impulse);
    };
    // Big islands use all threads themselves, so they go one after another.
    for (const Batch& batch : layout.batches)
        if (batch.wide) solve(batch);
    for_each_block(layout.batches.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i)
            if (!layout.batches[i].wide) solve(layout.batches[i]);
    });

    finish_direct(context, layout, diagnostics);
    note_strain(context, islands, layout, active, masses, velocities, builder, overloaded);
    update_split_impulse(split_impulse);

    // In order of bodies, of which many arrays are written.
    const std::size_t bodies = layout.solver_index.size();
    diagnostics.of_block.start(block_count(bodies, kBodies));
    for_each_block(bodies, kBodies, [&](std::size_t begin, std::size_t end, std::size_t block) {
        for (auto body = static_cast<std::uint32_t>(begin); body < end; ++body) {
            const std::uint32_t solver_index = layout.solver_index[body];
            if (solver_index == Layout::kNoSolverIndex) continue;
            using Settled = typename ContactConstraints<Real>::Settled;
            const Settled settled =
                constraints.settled.empty() ? Settled::no : constraints.settled[solver_index];
            if (settled == Settled::yes) continue;
            const GyroscopicInertia<Real>* const inertia =
                constraints.inertias.empty() ? nullptr : &constraints.inertias[solver_index];
            if (settled == Settled::lost
                || !take_back(constraints.bodies[solver_index], inertia, body, poses, velocities))
                diagnostics.of_block[block].push_back(body);
        }
    });
    diagnostics.of_block.append_to(diagnostics.quarantined);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void solve_impulses<Real>(                                                            \
        const StepContext&, const Islands&, const Layout&, const ActiveContacts&,                  \
        const Colliders&, const Masses&, const Forces&, const ExternalAcceleration&,               \
        const PrescribedVelocities&, ContactConstraints<Real>&, ConvexContacts<Real>&,             \
        MeshContacts<Real>&, SolidContacts<Real>&, Poses&, Velocities&, SplitImpulse&,             \
        OverloadedIslands&, StepDiagnostics&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
