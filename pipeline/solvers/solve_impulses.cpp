// Solve impulses: contacts into rows, rows into impulses, velocities and poses, batch by batch.
#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "pipeline/forces/following_forces.hpp"
#include "pipeline/solvers/escalation.hpp"
#include "pipeline/solvers/parting.hpp"
#include "pipeline/solvers/solve_batch.hpp"
#include "pipeline/solvers/solve_direct.hpp"
#include "pipeline/step/inner_rows.hpp"
#include "pipeline/step/stages.hpp"

#include <array>
#include <cmath>

namespace throng {

namespace {

constexpr std::size_t kBodies = 512;  // a block

// What calls for forces that change as bodies go: see following_forces.hpp.
constexpr Set<Effect> kFollowing = {Effect::springs, Effect::attractors, Effect::pivot};

constexpr std::array<InnerRow, 12> solve_rows(std::string_view friction)
{
    return {{
        {"make_rows", {Effect::contact}, "before the first substep"},
        {"bounce", {Effect::restitution}, "as each substep begins"},
        {"add_gravity", {Effect::gravity}, "each substep"},
        {"turn_gyroscopic", {Effect::gyroscopic}, "each substep"},
        {"begin_following", kFollowing, "each substep"},
        {"warm_start", {Effect::contact}, "in the first substep"},
        {"push_contacts", {Effect::contact}, "each visit"},
        {friction, {Effect::friction}, "each visit", true},
        {"resist_rolling", {Effect::rolling_friction}, "each visit", true},
        {"move_bodies", {Effect::motion}, "each substep"},
        {"turn_bodies", {Effect::rotation}, "each substep"},
        {"relax_contacts", {Effect::contact}, "each substep"},
    }};
}

// By where friction acts, then by its cone.
constexpr std::array<InnerRow, 12> kSolveTables[2][2] = {
    {solve_rows("hold_friction"), solve_rows("hold_in_pyramid")},
    {solve_rows("hold_at_points"), solve_rows("hold_at_points_in_pyramid")}};

constexpr InnerRow kDirectTable[] = {
    {"take_islands", {Effect::contact}, "before the first substep"},
    {"place_points", {Effect::contact}, "each substep"},
    {"add_gravity", {Effect::gravity}, "each substep"},
    {"turn_gyroscopic", {Effect::gyroscopic}, "each substep"},
    {"begin_following", kFollowing, "each substep"},
    {"solve_exactly", {Effect::contact}, "each substep"},
    {"hold_friction", {Effect::friction}, "each substep", true},
    {"resist_rolling", {Effect::rolling_friction}, "each substep", true},
    {"part_overlaps", {Effect::contact}, "each substep"},
    {"bounce", {Effect::restitution}, "each substep"},
    {"move_bodies", {Effect::motion}, "each substep"},
    {"turn_bodies", {Effect::rotation}, "each substep"},
};

constexpr InnerRow kPenaltyTable[] = {
    {"take_islands", {Effect::contact}, "before the first substep"},
    {"cut_substep", {Effect::contact}, "each substep"},
    {"place_points", {Effect::contact}, "each part of a substep"},
    {"add_gravity", {Effect::gravity}, "each part of a substep"},
    {"turn_gyroscopic", {Effect::gyroscopic}, "each part of a substep"},
    {"begin_following", kFollowing, "each part of a substep"},
    {"push_by_forces", {Effect::contact}, "each part of a substep"},
    {"damp_sliding", {Effect::friction}, "each part of a substep", true},
    {"resist_rolling", {Effect::rolling_friction}, "each part of a substep", true},
    {"move_bodies", {Effect::motion}, "each part of a substep"},
    {"turn_bodies", {Effect::rotation}, "each part of a substep"},
};

constexpr InnerRow kKinematicTable[] = {
    {"take_islands", {Effect::contact}, "before the first substep"},
    {"add_gravity", {Effect::gravity}, "each substep"},
    {"turn_gyroscopic", {Effect::gyroscopic}, "each substep"},
    {"begin_following", kFollowing, "each substep"},
    {"stop_approach", {Effect::contact}, "each sweep of a substep"},
    {"slow_sliding", {Effect::friction}, "each sweep of a substep", true},
    {"move_bodies", {Effect::motion}, "each substep"},
    {"turn_bodies", {Effect::rotation}, "each substep"},
    {"push_apart", {Effect::contact}, "each sweep of a substep"},
};

// Gives one body its new state. False, and the body as it was, when that is not sound.
template <class Real>
bool take_back(const SolverBody<Real>& seat,
               const SpinInertia<Real>* inertia,
               std::uint32_t body,
               Poses& poses,
               Velocities& velocities)
{
    const Vec3 moved(double{seat.drift[0]}, double{seat.drift[1]}, double{seat.drift[2]});
    const Vec3 v(double{seat.motion[0]}, double{seat.motion[1]}, double{seat.motion[2]});
    const Vec3 spin(double{seat.motion[4]}, double{seat.motion[5]}, double{seat.motion[6]});
    const bool goes_along = inertia != nullptr && inertia->share[6] > 0;
    const Vec3 w = goes_along ? spin_frame(seat, inertia) * spin : spin;
    const Vec3 position = poses.position[body] + moved;
    Quat orientation = turn_of(seat) * poses.orientation[body];
    const double length = std::sqrt(orientation.squaredNorm());
    orientation.coeffs() /= length;
    if (ran_away(seat) || !holdable(position, orientation, v, w)) return false;
    poses.position[body] = position;
    poses.orientation[body] = orientation;
    velocities.linear[body] = v;
    velocities.angular[body] = w;
    return true;
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
bool is_stiff(const Conditions& conditions,
              const RigidFacts& facts,
              const Layout& layout,
              const Batch& batch)
{
    if (facts.forces.springs.empty()) return false;
    const Slice& slice = layout.slices[batch.first_slice];
    return FollowingForces(conditions, facts,
                           std::span(layout.body_of_slot).subspan(slice.first_body, slice.dynamic))
        .stiff();
}

template <class Real>
void solve_impulses(const Conditions& conditions,
                    const Islands& islands,
                    const Layout& layout,
                    const ActiveContacts& active,
                    const Colliders& colliders,
                    const Masses& masses,
                    const Forces& forces,
                    const Pulls& pulls,
                    const Drives& drives,
                    Rows<Real>& rows,
                    ConvexContacts<Real>& convex,
                    MeshContacts<Real>& meshes,
                    SolidContacts<Real>& solids,
                    Poses& poses,
                    Velocities& velocities,
                    Parting& parting,
                    Stubborn& stubborn,
                    Trouble& trouble)
{
    trouble.quarantined.clear();
    const RowMaker<Real> maker(conditions, layout, active, convex, meshes, solids, rows);
    const RigidFacts facts{forces, masses, poses, velocities};
    const bool escalates = conditions.settings.solver != Solver::direct
        && conditions.settings.response == Response::impulse;
    const DirectEffort effort = escalates ? kExactEffort : asked_effort(conditions.settings);
    const DirectScene<Real> direct{conditions, effort, layout, active, facts,
                                   pulls,      drives, maker,  poses,  velocities};
    start_direct(layout, rows, trouble);
    start_parting(layout, parting);
    if (!solids.entries.empty() || any_compound(colliders))
        part_wedged(active, colliders, maker, parting);
    const auto solve_finer = [&](const Batch& batch) {
        Conditions finer = conditions;
        finer.settings.substeps *= batch.times;
        // Its overlap is that of the usual ones, which these would push apart as much faster.
        finer.settings.push_limit /= batch.times;
        finer.settings.relax_iterations = finer_relax_visits(finer.settings, batch);
        const RowMaker<Real> with(finer, layout, active, convex, meshes, solids, rows);
        const Slice& slice = layout.slices[batch.first_slice];
        // Impulses are kept as of the substep that the settings say.
        with.scale_impulses(slice, Real(1) / Real(batch.times));
        solve_batch(finer, facts, layout, batch, with, rows, parting);
        with.scale_impulses(slice, Real(batch.times));
    };
    // No island is escalated while bodies of it part: what makes contacts stiffer would throw
    // those apart that are deep in one another.
    const auto solve = [&](const Batch& batch) {
        const bool usual = escalates && parting.some && anybody_parts(layout, batch, parting);
        if (batch.direct && !usual && !(escalates && is_stiff(conditions, facts, layout, batch)))
            solve_direct(direct, batch, rows, trouble);
        else if (batch.times > 1 && !usual)
            solve_finer(batch);
        else
            solve_batch(conditions, facts, layout, batch, maker, rows, parting);
    };
    // Big islands use all threads themselves, so they go one after another.
    for (const Batch& batch : layout.batches)
        if (batch.wide) solve(batch);
    for_each_block(layout.batches.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i)
            if (!layout.batches[i].wide) solve(layout.batches[i]);
    });

    finish_direct(conditions, layout, trouble);
    note_strain(conditions, islands, layout, active, masses, velocities, maker, stubborn);
    follow_parting(parting);

    // In order of bodies, of which many arrays are written.
    const std::size_t bodies = layout.slot.size();
    trouble.of_block.start(block_count(bodies, kBodies));
    for_each_block(bodies, kBodies, [&](std::size_t begin, std::size_t end, std::size_t block) {
        for (auto body = static_cast<std::uint32_t>(begin); body < end; ++body) {
            const std::uint32_t slot = layout.slot[body];
            if (slot == Layout::kNoSlot) continue;
            using Settled = typename Rows<Real>::Settled;
            const Settled settled = rows.settled.empty() ? Settled::no : rows.settled[slot];
            if (settled == Settled::yes) continue;
            const SpinInertia<Real>* const inertia =
                rows.inertias.empty() ? nullptr : &rows.inertias[slot];
            if (settled == Settled::lost
                || !take_back(rows.bodies[slot], inertia, body, poses, velocities))
                trouble.of_block[block].push_back(body);
        }
    });
    trouble.of_block.append_to(trouble.quarantined);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void solve_impulses<Real>(                                                            \
        const Conditions&, const Islands&, const Layout&, const ActiveContacts&, const Colliders&, \
        const Masses&, const Forces&, const Pulls&, const Drives&, Rows<Real>&,                    \
        ConvexContacts<Real>&, MeshContacts<Real>&, SolidContacts<Real>&, Poses&, Velocities&,     \
        Parting&, Stubborn&, Trouble&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
