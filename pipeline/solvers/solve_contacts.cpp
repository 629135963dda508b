// Solve contacts: the five solvers, each batch by batch.
#include "kernels/parallel/blocks.hpp"
#include "pipeline/forces/state_dependent_forces.hpp"
#include "pipeline/forces/velocity_lag.hpp"
#include "pipeline/solvers/batch_bodies.hpp"
#include "pipeline/solvers/escalation.hpp"
#include "pipeline/solvers/relax_iterations.hpp"
#include "pipeline/solvers/solve_batch.hpp"
#include "pipeline/solvers/solve_island.hpp"
#include "pipeline/solvers/split_impulse.hpp"
#include "pipeline/solvers/unlike_masses.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>

namespace throng {

namespace {

// Whether stiff springs pull at bodies of an island. Exact solves take turns with them, which over
// long substeps does not come together.
bool is_stiff(const StepContext& context,
              const RigidFacts& facts,
              const Layout& layout,
              const Batch& batch)
{
    if (facts.forces.springs.empty()) return false;
    return StateDependentForces(context, facts, layout.bodies_of(layout.slices[batch.first_slice]))
        .stiff();
}

bool any_finer(const Layout& layout)
{
    return std::any_of(layout.batches.begin(), layout.batches.end(),
                       [](const Batch& batch) { return batch.times > 1; });
}

// A contact problem, and how its batches are solved.
template <class Real>
class ContactSolve {
public:
    // Batches that are marked direct go to the island solver, with that effort.
    ContactSolve(const ContactProblem<Real>& problem, const DirectEffort& effort)
        : context_(problem.template get<const StepContext>()),
          parameters_(problem.template get<const SolverParameters>()),
          layout_(problem.template get<const Layout>()),
          active_(problem.template get<const ActiveContacts>()),
          convex_(problem.template get<ConvexContacts<Real>>()),
          meshes_(problem.template get<MeshContacts<Real>>()),
          solids_(problem.template get<SolidContacts<Real>>()),
          joined_(problem.template get<JoinedContacts<Real>>()),
          constraints_(problem.template get<ContactConstraints<Real>>()),
          split_impulse_(problem.template get<SplitImpulse>()),
          flights_(problem.template get<Flights>()),
          diagnostics_(problem.template get<StepDiagnostics>()),
          facts_{problem.template get<const Forces>(), problem.template get<const Masses>(),
                 problem.template get<Poses>(), problem.template get<Velocities>()},
          builder_(context_,
                   parameters_,
                   layout_,
                   active_,
                   convex_,
                   meshes_,
                   solids_,
                   joined_,
                   nothing_,
                   constraints_),
          effort_(effort), accelerations_(problem.template get<const ExternalAcceleration>()),
          prescribed_(problem.template get<const PrescribedVelocities>()),
          poses_(problem.template get<Poses>()), velocities_(problem.template get<Velocities>())
    {
        start_islands(layout_, constraints_, diagnostics_);
        if (any_finer(layout_)) {
            flights_.lags.resize(facts_.masses.mass.size());
            flights_.finer = true;
        }
        start_split_impulse(layout_, split_impulse_);
        const auto& colliders = problem.template get<const Colliders>();
        if (!solids_.entries.empty() || colliders.compounds)
            split_wedged(context_, active_, colliders, facts_.masses, builder_, split_impulse_);
    }

    // Each batch by iterations, or by what it is escalated to. No island is escalated while bodies
    // of it part: what makes contacts stiffer would throw those apart that are deep in one another.
    // Nor is one solved exactly where somebody can only turn: pressed by a lever arm of next to
    // none he is spun by the impulses that an exact answer has, which iterations limit. Nor where a
    // rim turns: held exactly where it touches now, it is thrown to where it touches next.
    void by_iterations()
    {
        for_batches([&](const Batch& batch) {
            const bool parts =
                split_impulse_.some && uses_split_impulse(layout_, batch, split_impulse_);
            if (!parts && batch.direct && !batch.calls.rolls
                && !any_only_turns(layout_, batch, facts_.masses)
                && !is_stiff(context_, facts_, layout_, batch))
                solve_exactly(batch);
            else if (!parts && batch.times > 1)
                return iterate_finer(batch);
            else
                iterate(batch);
            for (const Slice& slice : layout_.slices_of(batch)) lag_by_usual(slice, 1);
        });
    }

    // Each island by the island solver, as far as it goes there.
    void by_islands()
    {
        for_batches([&](const Batch& batch) {
            if (batch.direct)
                solve_exactly(batch);
            else
                iterate(batch);
        });
    }

private:
    // Big islands use all threads themselves, so they go one after another.
    template <class Solve>
    void for_batches(Solve solve)
    {
        for (const Batch& batch : layout_.batches)
            if (batch.wide) solve(batch);
        for_each_block(layout_.batches.size(), 1,
                       [&](std::size_t begin, std::size_t end, std::size_t) {
                           for (std::size_t i = begin; i < end; ++i)
                               if (!layout_.batches[i].wide) solve(layout_.batches[i]);
                       });
        finish_islands(context_, parameters_, layout_, diagnostics_);
        update_split_impulse(layout_, split_impulse_);
    }

    // Whether two in touch are so unlike. The impulses that relaxing takes from who bears so much
    // are slow to come back, and he sinks in; where he is held by a face they come soon enough.
    bool any_unlike(const Batch& batch) const
    {
        return throng::any_unlike(
            facts_.masses, active_,
            std::span(layout_.contacts)
                .subspan(layout_.slices[batch.first_slice].first_contact, batch.contacts));
    }

    // What makes the constraints of a batch, of no more than that calls for.
    ConstraintBuilder<Real>
    builder_of(const Batch& batch, const StepContext& context, const SolverParameters& parameters)
    {
        return {context, parameters, layout_, active_,     convex_,
                meshes_, solids_,    joined_, batch.calls, constraints_};
    }

    void solve_exactly(const Batch& batch)
    {
        const StepContext context = context_.of(batch.calls);
        const ConstraintBuilder<Real> builder = builder_of(batch, context, parameters_);
        solve_island<Real>({context, parameters_, effort_, layout_, active_, facts_, accelerations_,
                            prescribed_, builder, poses_, velocities_},
                           batch, constraints_, diagnostics_);
    }

    void iterate(const Batch& batch)
    {
        const StepContext context = context_.of(batch.calls);
        solve_batch(context, parameters_, facts_, layout_, batch,
                    builder_of(batch, context, parameters_), constraints_, split_impulse_);
    }

    void iterate_finer(const Batch& batch)
    {
        StepContext finer = context_.of(batch.calls);
        SolverParameters parameters = parameters_;
        finer.substeps *= batch.times;
        finer.times_finer = batch.times;
        // Its overlap is that of the usual ones, which these would push apart as much faster.
        parameters.push_limit /= batch.times;
        parameters.relax_iterations = !lies_on_faces(batch) && any_unlike(batch)
            ? relax_iterations(parameters, finer.substeps, batch)
            : finer_relax_iterations(parameters, finer.substeps, batch);
        const ConstraintBuilder<Real> with = builder_of(batch, finer, parameters);
        for (const Slice& slice : layout_.slices_of(batch)) {
            // Impulses are kept as of the substep that the settings say.
            with.scale_impulses(slice, Real(1) / Real(batch.times));
            lag_by_finer(context_, facts_.forces,
                         {batch.times, layout_.bodies_of(slice), with.pressed(slice)}, flights_,
                         solver_bodies_of(slice));
        }
        solve_batch(finer, parameters, facts_, layout_, batch, with, constraints_, split_impulse_);
        for (const Slice& slice : layout_.slices_of(batch)) {
            with.scale_impulses(slice, Real(batch.times));
            lag_by_usual(slice, batch.times);
        }
    }

    // Of a slice that was solved by so many times the substeps, or comes from such a solve.
    void lag_by_usual(const Slice& slice, int times)
    {
        if (!flights_.finer) return;
        const auto bodies = layout_.bodies_of(slice);
        const auto finer = [&](std::uint32_t body) { return flights_.lags_of(body) > 1; };
        if (times == 1 && std::none_of(bodies.begin(), bodies.end(), finer)) return;
        throng::lag_by_usual(context_, facts_.forces, {times, bodies, builder_.pressed(slice)},
                             flights_, solver_bodies_of(slice));
    }

    std::span<SolverBody<Real>> solver_bodies_of(const Slice& slice)
    {
        return std::span(constraints_.bodies).subspan(slice.first_body, slice.dynamic);
    }

    const StepContext& context_;
    const SolverParameters& parameters_;
    const Layout& layout_;
    const ActiveContacts& active_;
    ConvexContacts<Real>& convex_;
    MeshContacts<Real>& meshes_;
    SolidContacts<Real>& solids_;
    JoinedContacts<Real>& joined_;
    ContactConstraints<Real>& constraints_;
    SplitImpulse& split_impulse_;
    Flights& flights_;
    StepDiagnostics& diagnostics_;
    const RigidFacts facts_;
    const IslandCalls nothing_;
    const ConstraintBuilder<Real> builder_;  // of contacts, not of constraints
    const DirectEffort effort_;
    const ExternalAcceleration& accelerations_;
    const PrescribedVelocities& prescribed_;
    Poses& poses_;
    Velocities& velocities_;
};

template <class Real>
void solve_islands(const ContactProblem<Real>& problem)
{
    const auto& parameters = problem.template get<const SolverParameters>();
    ContactSolve<Real>(problem, asked_effort(parameters)).by_islands();
}

}  // namespace

template <class Real>
void solve_soft_step(const ContactProblem<Real>& problem)
{
    ContactSolve<Real>(problem, kExactEffort).by_iterations();
}

template <class Real>
void solve_pgs(const ContactProblem<Real>& problem)
{
    ContactSolve<Real>(problem, kExactEffort).by_iterations();
}

template <class Real>
void solve_direct(const ContactProblem<Real>& problem)
{
    solve_islands(problem);
}

template <class Real>
void solve_penalty(const ContactProblem<Real>& problem)
{
    solve_islands(problem);
}

template <class Real>
void solve_kinematic(const ContactProblem<Real>& problem)
{
    solve_islands(problem);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void solve_soft_step<Real>(const ContactProblem<Real>&);                              \
    template void solve_pgs<Real>(const ContactProblem<Real>&);                                    \
    template void solve_direct<Real>(const ContactProblem<Real>&);                                 \
    template void solve_penalty<Real>(const ContactProblem<Real>&);                                \
    template void solve_kinematic<Real>(const ContactProblem<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
