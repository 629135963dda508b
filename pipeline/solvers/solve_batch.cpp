#include "pipeline/solvers/solve_batch.hpp"

#include "kernels/solver/coloring.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "pipeline/forces/energy_limiter.hpp"
#include "pipeline/forces/state_dependent_forces.hpp"
#include "pipeline/solvers/batch_bodies.hpp"
#include "pipeline/solvers/borne_bodies.hpp"
#include "pipeline/solvers/kept_islands.hpp"
#include "pipeline/solvers/relax_iterations.hpp"
#include "pipeline/solvers/released_loads.hpp"
#include "pipeline/solvers/slice_passes.hpp"
#include "pipeline/step/passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace throng {

namespace {

// See answer_late_forces(); and what pgs takes where the dial says auto.
constexpr int kInLateForces = 6, kPgsIterations = 20;
// Of a world's first step, in which no contact remembers what it bears: by one iteration what
// stands on others would sink by a third of a free fall, and slip where it leans. Fewer after its
// first substep cost chains and heavy loads some of their accuracy.
constexpr int kFirstIterations = 16;

// Pushing iterations a substep while bodies part. Each substep starts from nothing, and what is
// wedged in the middle of a crowd waits for those around it: by one iteration a thousand boxes made
// at one point overlap by a seventh after 10 s. While each still lies in hundreds of others one
// iteration is many pushes: so many a body will do.
constexpr std::size_t kSplitImpulseIterations = 12, kSplitImpulseContacts = 128;

// What contacts gave in a substep is a blow from so many times what gravity gives on. Half of that
// disturbs towers that bear ten thousand times what their lowest box weighs.
constexpr double kBlow = 16;

// How often contacts and stiff springs take turns in a substep, at least: each sees what the other
// gave the time before.
constexpr int kSpringTurns = 4;

template <class Real>
class Task {
public:
    Task(const StepContext& context,
         const SolverParameters& parameters,
         const RigidFacts& facts,
         const Layout& layout,
         const Batch& batch,
         const ConstraintBuilder<Real>& builder,
         ContactConstraints<Real>& constraints,
         SplitImpulse& split_impulse)
        : context_(context), parameters_(parameters), facts_(facts), layout_(layout), batch_(batch),
          constraints_(constraints), split_impulse_(split_impulse),
          slices_(context, parameters, layout, batch, builder, constraints),
          on_faces_(lies_on_faces(batch))
    {
        find_state_forces();
        find_limiter();
    }

    // What a batch goes through, in order.
    static std::span<const Pass<Task>> soft_step()
    {
        static constexpr auto kPasses =
            passes_with({Effect::springs, Effect::pivot},
                        pass<&Task::relax>({Effect::contact}, When::each_iteration));
        return kPasses;
    }

    // The same, but that every warm start is limited and so no load released, and nothing relaxes
    // but what comes late.
    static std::span<const Pass<Task>> pgs()
    {
        static constexpr auto kPasses =
            passes_with({Effect::contact},
                        pass<&Task::answer_late_forces>(kFollowBodies, When::each_iteration));
        return kPasses;
    }

    void run()
    {
        const auto passes = by_pgs() ? pgs() : soft_step();
        run_at(passes, When::before_substeps);
        for (substep_ = 0; substep_ < context_.substeps; ++substep_) {
            for (const Pass<Task>& pass : passes) {
                const bool now = pass.when == When::each_substep
                    || pass.when == When::each_iteration
                    || (pass.when == When::first_substep && substep_ == 0);
                if (now && pass.called_for_by.meets(context_.effects)) (this->*pass.run)();
            }
            if (on_faces_ || !slices_.window_fits()) slices_.run();
        }
        run_at(passes, When::after_substeps);
        slices_.run();
    }

private:
    static constexpr std::array<Pass<Task>, 21> passes_with(Set<Effect> limited,
                                                            const Pass<Task>& after_moving)
    {
        using enum Effect;
        using enum When;
        // Where every warm start is limited, nobody is thrown by what it remembers.
        const Set<Effect> released = limited.has(contact) ? Set<Effect>{} : Set<Effect>{contact};
        return {{
            pass<&Task::make_constraints>({contact}, before_substeps),
            pass<&Task::find_borne>(kFollowBodies, before_substeps),
            pass<&Task::find_split_impulse>({contact}, before_substeps),
            pass<&Task::apply_restitution>({restitution}, each_substep),
            pass<&Task::open_energy_limiter>(limited, each_substep),
            pass<&Task::integrate_velocities>({contact}, each_substep),
            pass<&Task::begin_state_forces>(kFollowBodies, each_substep),
            pass<&Task::warm_start>({contact}, first_substep),
            pass<&Task::turn_arms>({rotation}, each_substep),
            pass<&Task::limit_warm_start>({contact}, each_substep),
            pass<&Task::update_surface_velocity>({contact}, each_substep),
            pass<&Task::solve_velocities>({contact}, each_iteration),
            pass<&Task::release_loads>(released, first_substep),
            pass<&Task::solve_split_impulse>({contact}, each_iteration),
            pass<&Task::advance_bodies>({contact}, each_substep),
            pass<&Task::place_rims>({rotation}, each_substep),
            pass<&Task::end_state_forces>(kFollowBodies, each_substep),
            after_moving,
            pass<&Task::limit_contacts>({contact}, each_substep),
            pass<&Task::close_energy_limiter>(limited, each_substep),
            pass<&Task::store_impulses>({contact}, after_substeps),
        }};
    }

    void run_at(std::span<const Pass<Task>> passes, When when)
    {
        for (const Pass<Task>& pass : passes)
            if (pass.when == when && pass.called_for_by.meets(context_.effects))
                (this->*pass.run)();
    }

    bool by_pgs() const { return parameters_.solver == Solver::pgs; }

    // What is too great for the direct solver comes here, but its iterations are not meant for it.
    int iterations() const
    {
        if (parameters_.solver != Solver::direct && parameters_.iterations > 0)
            return parameters_.iterations;
        if (by_pgs()) return kPgsIterations;
        return context_.last_substep > 0 ? 1 : kFirstIterations;
    }

    bool on_stiff_springs() const { return state_forces_ && state_forces_->stiff(); }

    // In towers and structures there in one substep and back in the next: who comes first takes a
    // little more of a load than its share, which would lean a whole wall to one side. Heaps and
    // crowds, which have no side, come to rest sooner in one order.
    void add(SlicePass::Kind kind, int times = 1)
    {
        for (int i = 0; i < times; ++i)
            slices_.add({kind, substep_ == 0, on_faces_ && substep_ % 2 == 1});
    }

    void make_constraints() { slices_.add({SlicePass::Kind::prepare}); }

    // Slices are prepared as late as can be, to be solved while they are in cache: but here all
    // are looked at before anything else is done.
    void find_split_impulse()
    {
        if (!split_impulse_.some) return;
        slices_.run();
        parts_ = note_split_impulse(layout_, batch_, constraints_, split_impulse_);
        if (!parts_) return;
        slices_.start_saving();
        stiffen(layout_, batch_, constraints_);
    }

    void open_energy_limiter()
    {
        if (!limiter_) return;
        slices_.run();
        limiter_->open(constraints_);
    }

    void apply_restitution() { slices_.apply_restitution(); }

    void integrate_velocities() { add(SlicePass::Kind::begin); }

    void warm_start() { add(SlicePass::Kind::warm_start); }

    // Before the first substep nobody has turned; but rims are told ahead.
    void turn_arms()
    {
        if (batch_.calls.swings && (substep_ > 0 || batch_.calls.rolls))
            add(SlicePass::Kind::turn_arms);
    }

    void update_surface_velocity()
    {
        if (batch_.calls.carries || batch_.calls.axes_turn)
            add(SlicePass::Kind::update_surface_velocity);
    }

    // With the push that overlap asks for; without it while bodies part, which are pushed by
    // iterations of their own.
    void solve_velocities()
    {
        if (parts_) return add(SlicePass::Kind::relax, by_pgs() ? iterations() : kInStructures);
        if (!on_stiff_springs()) return add(SlicePass::Kind::solve_biased, iterations());
        for (int i = 0; i < std::max(iterations(), kSpringTurns); ++i) {
            add(SlicePass::Kind::solve_biased);
            // The last word is theirs: what contacts say of a stiff one without its say would draw
            // it out by more than anybody gave.
            turn_to_springs();
        }
    }

    // In the first substep, with bodies as the step began. What impacts did before is kept.
    void make_constraints_anew()
    {
        const auto bodies = layout_.bodies_of(batch_);
        const auto slices = layout_.slices_of(batch_);
        const std::size_t first = layout_.blocks_of(slices.front()).begin;
        std::span<RestitutionWide<Real>> of_batch(constraints_.restitutions);
        if (!of_batch.empty())
            of_batch = of_batch.subspan(first, layout_.blocks_of(slices.back()).end - first);
        const std::vector<RestitutionWide<Real>> restitutions(of_batch.begin(), of_batch.end());
        for (const std::uint32_t body : bodies) {
            Real* const motion = constraints_.bodies[layout_.solver_index[body]].motion;
            for (int k = 0; k < 3; ++k) {
                motion[k] = static_cast<Real>(facts_.velocities.linear[body][k]);
                motion[4 + k] = static_cast<Real>(facts_.velocities.angular[body][k]);
            }
        }
        make_constraints();
        slices_.run();
        std::copy(restitutions.begin(), restitutions.end(), of_batch.begin());
        for (const std::uint32_t body : bodies) {
            SolverBody<Real>& solver_body = constraints_.bodies[layout_.solver_index[body]];
            std::copy(solver_body.free, solver_body.free + 8, solver_body.motion);
        }
    }

    // Where loads are gone that contacts remember, all that was done in this substep is done anew
    // without them.
    void release_loads()
    {
        if (parts_) return;
        slices_.run();
        const std::vector<std::uint32_t> thrown = find_thrown(
            layout_, batch_, context_.gravity.norm() * context_.substep(), constraints_);
        if (thrown.empty()
            || !throng::release_loads(layout_, batch_, slices_.builder(), facts_.velocities, thrown,
                                      constraints_))
            return;
        make_constraints_anew();
        warm_start();
        if (context_.has(Effect::rotation)) turn_arms();
        limit_warm_start();
        update_surface_velocity();
        solve_velocities();
    }

    void solve_split_impulse()
    {
        if (!parts_) return;
        add(SlicePass::Kind::save);
        add(SlicePass::Kind::solve_split_impulse, split_impulse_iterations());
    }

    void advance_bodies()
    {
        note_spins();
        add(SlicePass::Kind::advance);
        if (parts_) add(SlicePass::Kind::restore);
    }

    void place_rims()
    {
        if (batch_.calls.rolls) add(SlicePass::Kind::place_rims);
    }

    void relax()
    {
        if (parts_) return;
        const int iterations = relax_iterations(parameters_, context_.substeps, batch_);
        add(SlicePass::Kind::relax, iterations);
        if (late_) relax_late_islands(kInLateForces - iterations);
    }

    // Where half of what springs and pivots do acts after bodies moved, these iterations alone are
    // to hold it up, through whatever a body lies on.
    void answer_late_forces()
    {
        if (late_ && !parts_)
            relax_late_islands(
                std::max(relax_iterations(parameters_, context_.substeps, batch_), kInLateForces));
    }

    // Islands that wait for nothing of the kind are left as they are.
    void relax_late_islands(int iterations)
    {
        if (iterations <= 0) return;
        const bool all =
            std::find(late_islands_.begin(), late_islands_.end(), 0) == late_islands_.end();
        if (all) return add(SlicePass::Kind::relax, iterations);
        slices_.run();
        const KeptIslands<Real> kept(layout_, batch_, late_islands_, constraints_);
        add(SlicePass::Kind::relax, iterations);
        slices_.run();
        kept.restore(constraints_);
    }

    void close_energy_limiter()
    {
        if (!limiter_ || parts_) return;
        slices_.run();
        limiter_->close(constraints_);
    }

    void store_impulses() { slices_.add({SlicePass::Kind::store}); }

    // Forces that change as the bodies of the batch go.
    void find_state_forces()
    {
        if (!context_.effects.meets(kFollowBodies)) return;
        state_forces_.emplace(context_, facts_, layout_.bodies_of(batch_));
        if (state_forces_->forced_bodies().empty()) state_forces_.reset();
    }

    // Once constraints are there. Slower than what all that acts gives in two steps is resting, not
    // bouncing, where that is not gravity alone.
    void find_borne()
    {
        if (!state_forces_) return;
        update_forced_bodies(false);
        state_forces_->find_changes();
        throng::find_borne(layout_, batch_, constraints_, facts_.masses, context_.substep(),
                           std::span(state_forces_->forced_bodies()));
        state_forces_->bear();
        for (const ForcedBody& forced : state_forces_->forced_bodies())
            if (forced.falls_late)
                constraints_.bodies[layout_.solver_index[forced.body]].inertia[7] = 1;
        std::vector<double> slow(batch_.islands, std::numeric_limits<double>::infinity());
        late_islands_.assign(batch_.islands, 0);
        for (const ForcedBody& forced : state_forces_->forced_bodies()) {
            const std::size_t island = island_of(forced);
            slow[island] = std::min(slow[island], 2 * context_.substeps * forced.change.norm());
            if (forced.late) late_islands_[island] = 1;
        }
        for (double& speed : slow)
            if (!std::isfinite(speed)) speed = 0;
        find_least_speeds(layout_, batch_, std::span(state_forces_->forced_bodies()), slow,
                          context_.gravity * context_.substep(), context_.substeps, constraints_);
    }

    std::size_t island_of(const ForcedBody& forced) const
    {
        return layout_.island_of(batch_,
                                 static_cast<std::int32_t>(layout_.solver_index[forced.body]));
    }

    // By pgs it is for a few iterations to take back what is too much of a warm start.
    void find_limiter()
    {
        using Whose = typename EnergyLimiter<Real>::Whose;
        const bool stiff = on_stiff_springs(), all = by_pgs();
        if (stiff || all)
            limiter_.emplace(layout_, batch_, facts_, stiff ? &*state_forces_ : nullptr,
                             all ? Whose::all : Whose::on_springs,
                             context_.gravity * context_.substep());
        if (!stiff && !is_driven() && somebody_only_turns())
            spin_limiter_.emplace(layout_, batch_, facts_, nullptr, Whose::turning,
                                  context_.gravity * context_.substep());
    }

    bool is_driven() const { return context_.has(Effect::drive); }

    bool somebody_only_turns() const
    {
        return context_.has(Effect::rotation) && any_only_turns(layout_, batch_, facts_.masses);
    }

    // m/s, beyond which what contacts gave is a blow.
    double blow_speed() const { return kBlow * context_.gravity.norm() * context_.substep(); }

    // Of soft_step what a warm start adds after a blow alone: a tower stands by what its contacts
    // remember. Of who is carried along nobody here knows what drives him, nor without gravity of
    // whom forces press together what he bears; where nothing does, all is a blow.
    void limit_warm_start()
    {
        if (spin_limiter_ && !parts_) {
            slices_.run();
            spin_limiter_->open_free(constraints_);
        }
        if (limiter_) {
            slices_.run();
            return limiter_->take_share(constraints_);
        }
        if (parts_) return limit_while_parting();
        const double speed = blow_speed();
        if (batch_.slices > 1 || batch_.calls.driven || is_driven()) return;
        if (!(speed > 0) && context_.effects.meets(kForces)) return;
        if (!blow_limiter_ && batch_.limited) limit_blows(true);
        const std::size_t end = std::size_t{batch_.first_island} + batch_.islands;
        for (std::size_t island = batch_.first_island; island < end; ++island) {
            const std::size_t begin = layout_.island_begin[island];
            const auto bodies = std::span(constraints_.bodies)
                                    .subspan(begin, layout_.island_begin[island + 1] - begin);
            if (!may_gain<Real>(bodies, batch_.contacts > kBatchContacts, speed)) continue;
            if (!blow_limiter_) limit_blows(batch_.limited);
            blow_limiter_->take_share_of_blow(speed, {begin, begin + bodies.size()}, constraints_);
        }
    }

    void limit_blows(bool all)
    {
        using Whose = typename EnergyLimiter<Real>::Whose;
        blow_limiter_.emplace(layout_, batch_, facts_, nullptr, all ? Whose::all : Whose::stacked,
                              Vec3::Zero());
    }

    // While bodies part contacts are stiff and push nobody, so they give no energy; but of what
    // lies between heavy bodies a warm start that they do not take back does: that is taken from
    // the motion at the end of the substep. Where forces act after that it is not known there, and
    // the warm start is limited; a blow so limited presses some through a floor.
    void limit_while_parting()
    {
        if (is_driven()) return;
        slices_.run();
        if (!blow_limiter_) limit_blows(true);
        if (state_forces_)
            blow_limiter_->take_share_of_blow(blow_speed(), {0, constraints_.bodies.size()},
                                              constraints_);
    }

    // What acts once bodies have moved is no work of contacts.
    void limit_contacts()
    {
        if (blow_limiter_)
            blow_limiter_->limit_contacts(
                context_.gravity.norm() * context_.dt,
                [&](std::uint32_t solver_index) { return !acts_late(solver_index); }, constraints_);
        if (!spin_limiter_ || parts_) return;
        slices_.run();
        spin_limiter_->close_free(constraints_);
    }

    // Whether forces acted on a body's island after bodies moved, in this substep.
    bool acts_late(std::uint32_t solver_index) const
    {
        return late_
            && late_islands_[layout_.island_of(batch_, static_cast<std::int32_t>(solver_index))]
            != 0;
    }

    // Followers as they are now, less what contacts gave in this substep if that is asked.
    void update_forced_bodies(bool without_contacts)
    {
        slices_.run();
        for (ForcedBody& forced : state_forces_->forced_bodies()) {
            const SolverBody<Real>& solver_body =
                constraints_.bodies[layout_.solver_index[forced.body]];
            const Real* const motion = without_contacts ? solver_body.free : solver_body.motion;
            const auto at = [](const Real* v) {
                return Vec3(double{v[0]}, double{v[1]}, double{v[2]});
            };
            forced.pose = {facts_.poses.position[forced.body] + at(solver_body.delta_pose),
                           turn_of(solver_body) * facts_.poses.orientation[forced.body]};
            forced.velocity = at(motion);
            forced.spin = slices_.spin_axes(solver_body) * at(motion + 4);
            find_turn(solver_body, forced);
        }
    }

    // The axis of what is symmetric goes straight on, however fast it spins about that.
    void find_turn(const SolverBody<Real>& solver_body, ForcedBody& forced) const
    {
        const GyroscopicInertia<Real>* const inertia = slices_.inertia_of(solver_body);
        if (inertia == nullptr || !(inertia->share[6] > 0) || !(inertia->axis[3] > 0)) return;
        const Real* const axis = inertia->axis;
        forced.axis = slices_.spin_axes(solver_body)
            * Vec3(double{axis[0]}, double{axis[1]}, double{axis[2]});
        forced.carries = 0;
    }

    // Forces move a body with contacts and without, so that what contacts gave stays what it was.
    void move_forced_bodies()
    {
        for (const ForcedBody& forced : state_forces_->forced_bodies()) {
            SolverBody<Real>& solver_body = constraints_.bodies[layout_.solver_index[forced.body]];
            const Vec3 spin = slices_.spin_axes(solver_body).conjugate() * forced.gained_spin;
            for (int k = 0; k < 3; ++k)
                for (Real* const motion : {solver_body.motion, solver_body.free}) {
                    motion[k] += static_cast<Real>(forced.gained[k]);
                    motion[4 + k] += static_cast<Real>(spin[k]);
                }
        }
    }

    void begin_state_forces()
    {
        if (!state_forces_) return;
        update_forced_bodies(true);
        state_forces_->begin(substep_ * context_.substep(), context_.substep());
        move_forced_bodies();
    }

    void turn_to_springs()
    {
        update_forced_bodies(false);
        state_forces_->again();
        move_forced_bodies();
    }

    // The axes that spins are in are told by where the axis of a body has come to since the step
    // began. Carried by its own turn in a substep, a spin comes out a little beside that, which
    // springs that gave half of what they give before it would not know of.
    void note_spins()
    {
        if (!on_stiff_springs()) return;
        update_forced_bodies(false);
        for (ForcedBody& forced : state_forces_->forced_bodies())
            forced.carried_spin =
                BodyTurn(forced.spin, forced.axis, forced.carries, context_.substep()).carried()
                * forced.spin;
    }

    void carry_spins()
    {
        for (const ForcedBody& forced : state_forces_->forced_bodies()) {
            if (!forced.stiff || forced.carries == 1) continue;
            SolverBody<Real>& solver_body = constraints_.bodies[layout_.solver_index[forced.body]];
            const Vec3 spin = slices_.spin_axes(solver_body).conjugate() * forced.carried_spin;
            for (int k = 0; k < 3; ++k) {
                const Real change = static_cast<Real>(spin[k]) - solver_body.motion[4 + k];
                solver_body.motion[4 + k] += change;
                solver_body.free[4 + k] += change;
            }
        }
    }

    void end_state_forces()
    {
        late_ = state_forces_ && state_forces_->late();
        if (!late_) return;
        slices_.run();
        if (state_forces_->stiff()) carry_spins();
        if (spin_limiter_) spin_limiter_->add_to_free(constraints_, -1);
        update_forced_bodies(false);
        state_forces_->end();
        move_forced_bodies();
        if (spin_limiter_) spin_limiter_->add_to_free(constraints_, 1);
    }

    int split_impulse_iterations() const
    {
        const std::size_t iterations =
            kSplitImpulseContacts * slices_.saved_motion().bodies() / batch_.contacts;
        return static_cast<int>(std::clamp<std::size_t>(iterations, 1, kSplitImpulseIterations));
    }

    const StepContext& context_;
    const SolverParameters& parameters_;
    const RigidFacts& facts_;
    const Layout& layout_;
    const Batch& batch_;
    ContactConstraints<Real>& constraints_;
    SplitImpulse& split_impulse_;
    SlicePasses<Real> slices_;
    bool on_faces_;
    int substep_ = 0;
    bool parts_ = false;                      // bodies of the batch part
    bool late_ = false;                       // forces acted after bodies moved, in this substep
    std::vector<std::uint8_t> late_islands_;  // [islands of the batch] they do so there
    std::optional<StateDependentForces> state_forces_;
    std::optional<EnergyLimiter<Real>> limiter_, blow_limiter_, spin_limiter_;
};

}  // namespace

std::vector<PassRow> soft_step_passes() { return rows_of(Task<float>::soft_step()); }
std::vector<PassRow> pgs_passes() { return rows_of(Task<float>::pgs()); }

template <class Real>
void solve_batch(const StepContext& context,
                 const SolverParameters& parameters,
                 const RigidFacts& facts,
                 const Layout& layout,
                 const Batch& batch,
                 const ConstraintBuilder<Real>& builder,
                 ContactConstraints<Real>& constraints,
                 SplitImpulse& split_impulse)
{
    Task<Real>(context, parameters, facts, layout, batch, builder, constraints, split_impulse)
        .run();
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void solve_batch<Real>(                                                               \
        const StepContext&, const SolverParameters&, const RigidFacts&, const Layout&,             \
        const Batch&, const ConstraintBuilder<Real>&, ContactConstraints<Real>&, SplitImpulse&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
