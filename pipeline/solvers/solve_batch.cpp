#include "pipeline/solvers/solve_batch.hpp"

#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/coloring.hpp"
#include "kernels/solver/solve_kernels.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "pipeline/forces/energy_limiter.hpp"
#include "pipeline/forces/state_dependent_forces.hpp"
#include "pipeline/solvers/borne_bodies.hpp"
#include "pipeline/solvers/pass.hpp"
#include "pipeline/solvers/relax_iterations.hpp"
#include "pipeline/solvers/split_impulse.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>

namespace throng {

namespace {

constexpr std::size_t kBlocks = 16;   // of 16 contacts a task: some 3 microseconds
constexpr std::size_t kBodies = 512;  // a task

// Sweeps over the points of a contact in one iteration. With two, contacts of four points bear half
// as much again before they stop coming to rest; to relax, one does as well.
constexpr int kBiasedNormalIterations = 2, kRelaxNormalIterations = 1;

// Where half of what springs and pivots do acts after bodies moved, it is for these iterations
// alone to hold it up, through whatever a body lies on.
constexpr int kInLateForces = 6;

// Pushing iterations a substep while bodies part. Each substep starts from nothing, and what is
// wedged in the middle of a crowd waits for those around it: by one iteration a thousand boxes made
// at one point overlap by a seventh after 10 s. While each still lies in hundreds of others one
// iteration is many pushes: so many a body will do.
constexpr std::size_t kSplitImpulseIterations = 12, kSplitImpulseContacts = 128;

// Rounds of impacts a substep at most. Each takes a blow on by one body at least, and mostly there
// are one or two; what still comes in after so many is stopped.
constexpr int kImpactRounds = 16;

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
         const RigidFacts& facts,
         const Layout& layout,
         const Batch& batch,
         const ConstraintBuilder<Real>& builder,
         ContactConstraints<Real>& constraints,
         SplitImpulse& split_impulse)
        : context_(context), facts_(facts), layout_(layout), batch_(batch), builder_(builder),
          constraints_(constraints), split_impulse_(split_impulse),
          view_(ContactConstraintsView<Real>::of(constraints)), kernels_(solve_kernels<Real>()),
          warm_start_(context.friction_at_points_or_pyramid() ? kernels_.warm_start_point_friction
                                                              : kernels_.warm_start),
          solve_(context.friction_at_points_or_pyramid() ? kernels_.solve_point_friction
                                                         : kernels_.solve),
          apply_restitution_(context.friction_at_points_or_pyramid()
                                 ? kernels_.apply_restitution_point_friction
                                 : kernels_.apply_restitution),
          time_(static_cast<Real>(context.substep()))
    {
        iteration_.inverse_substep = static_cast<Real>(1 / context.substep());
        iteration_.push_limit = static_cast<Real>(context.settings.push_limit);
        iteration_.turns = context.has(Effect::rotation) || context.friction_at_points_or_pyramid();
        iteration_.has_rolling_friction = context.has(Effect::rolling_friction);
        iteration_.has_friction = context.has(Effect::friction) || iteration_.has_rolling_friction;
        iteration_.friction_at_points = context.settings.friction_at == FrictionAt::points;
        iteration_.friction_pyramid = context.settings.friction_cone == FrictionCone::pyramid;
        // Slower than what gravity gives in two steps is resting, not bouncing.
        const Settings& settings = context.settings;
        iteration_.restitution_threshold =
            static_cast<Real>(2 * context.gravity.norm() * settings.dt);
        for (int k = 0; k < 3; ++k)
            iteration_.gravity_step[k] = static_cast<Real>(context.gravity[k] * context.substep());
        on_faces_ = lies_on_faces(batch);
        find_state_forces();
        find_limiter();
    }

    void run()
    {
        using enum Pass::Kind;
        const bool pgs = context_.settings.solver == Solver::pgs;
        // What is too great for the direct solver comes here, but the iterations are not meant for
        // it.
        const bool left = context_.settings.solver == Solver::direct;
        const int wanted = left ? 0 : context_.settings.iterations;
        const int biased_count = wanted > 0 ? wanted : pgs ? 20 : 1;
        add_pass({prepare});
        if (state_forces_) find_borne();
        const bool parts = split_impulse_.some && find_split_impulse();
        for (int step = 0; step < context_.settings.substeps; ++step) {
            // In towers and structures there in one substep and back in the next: who comes first
            // takes a little more of a load than its share, which would lean a whole wall to one
            // side. Heaps and crowds, which have no side, come to rest sooner in one order.
            const bool backward = on_faces_ && step % 2 == 1;
            const auto add = [&](Pass::Kind kind) { add_pass({kind, step == 0, backward}); };
            if (context_.has(Effect::restitution)) apply_restitution_to_all();
            if (limiter_) {
                run_passes();
                limiter_->open(constraints_);
            }
            add(begin);
            begin_state_forces(step);
            if (step == 0) add(warm_start);
            limit_warm_start();
            if (constraints_.surfaces_turn) add(update_surface_velocity);
            const int relax_count = relax_iterations(context_.settings, batch_);
            if (parts) {
                for (int i = 0; i < (pgs ? biased_count : kInStructures); ++i) add(relax);
                add(save);
                for (std::size_t i = 0; i < split_impulse_iterations(); ++i)
                    add(solve_split_impulse);
                note_spins();
                add(advance);
                add(restore);
                end_state_forces();
            } else {
                const bool turns = state_forces_ && state_forces_->stiff();
                for (int i = 0; i < (turns ? std::max(biased_count, kSpringTurns) : biased_count);
                     ++i) {
                    add(solve_biased);
                    // The last word is theirs: what contacts say of a stiff one without its say
                    // would draw it out by more than anybody gave.
                    if (turns) turn_to_springs();
                }
                note_spins();
                add(advance);
                const bool late = end_state_forces();
                const int iterations = late ? std::max(relax_count, kInLateForces)
                    : pgs                   ? 0
                                            : relax_count;
                for (int i = 0; i < iterations; ++i) add(relax);
                if (limiter_) {
                    run_passes();
                    limiter_->close(constraints_);
                }
            }
            if (on_faces_ || !window_fits()) run_passes();
        }
        add_pass({store});
        run_passes();
    }

private:
    // Forces that change as the bodies of the batch go.
    void find_state_forces()
    {
        const Forces& forces = facts_.forces;
        if (forces.springs.empty() && forces.has_pivot.empty() && forces.attractors.empty()
            && !forces.field)
            return;
        std::vector<std::uint32_t> bodies;
        for (std::uint32_t i = 0; i < batch_.slices; ++i) {
            const Slice& slice = layout_.slices[batch_.first_slice + i];
            for (std::uint32_t k = 0; k < slice.dynamic; ++k)
                bodies.push_back(layout_.body_of_solver_index[slice.first_body + k]);
        }
        state_forces_.emplace(context_, facts_, bodies);
        if (state_forces_->forced_bodies().empty()) state_forces_.reset();
    }

    // Once constraints are there. Slower than what all that acts gives in two steps is resting, not
    // bouncing, where that is not gravity alone.
    void find_borne()
    {
        update_forced_bodies(false);
        state_forces_->find_changes();
        throng::find_borne(layout_, batch_, constraints_, facts_.masses, context_.substep(),
                           std::span(state_forces_->forced_bodies()));
        state_forces_->bear();
        for (const ForcedBody& forced : state_forces_->forced_bodies())
            if (forced.falls_late)
                constraints_.bodies[layout_.solver_index[forced.body]].inertia[7] = 1;
        iteration_.restitution_threshold =
            std::max(iteration_.restitution_threshold,
                     static_cast<Real>(2 * state_forces_->least_change_of_step()));
    }

    // By pgs it is for a few iterations to take back what is too much of a warm start.
    void find_limiter()
    {
        using Whose = typename EnergyLimiter<Real>::Whose;
        const bool stiff = state_forces_ && state_forces_->stiff(),
                   all = context_.settings.solver == Solver::pgs;
        if (stiff || all)
            limiter_.emplace(layout_, batch_, facts_, stiff ? &*state_forces_ : nullptr,
                             all ? Whose::all : Whose::on_springs,
                             context_.gravity * context_.substep());
    }

    // Of soft_step what a warm start adds after a blow alone: a tower stands by what its contacts
    // remember. Of who is carried along nobody here knows what drives him, nor without gravity of
    // whom forces press together what he bears; where nothing does, all is a blow.
    void limit_warm_start()
    {
        if (limiter_) {
            run_passes();
            return limiter_->take_share(constraints_);
        }
        const Slice& slice = layout_.slices[batch_.first_slice];
        const double speed = kBlow * context_.gravity.norm() * context_.substep();
        if (batch_.slices > 1 || slice.kinematic > 0 || !constraints_.prescribed.empty()) return;
        if (!(speed > 0) && (context_.effects.meets(kForces) || facts_.forces.field)) return;
        const auto bodies = std::span(constraints_.bodies).subspan(slice.first_body, slice.dynamic);
        if (!may_gain<Real>(bodies, batch_.contacts > kBatchContacts, speed)) return;
        if (!blow_limiter_)
            blow_limiter_.emplace(layout_, batch_, facts_, nullptr,
                                  EnergyLimiter<Real>::Whose::stacked, Vec3::Zero());
        blow_limiter_->take_share_of_blow(speed, constraints_);
    }

    // Followers as they are now, less what contacts gave in this substep if that is asked.
    void update_forced_bodies(bool without_contacts)
    {
        run_passes();
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
            forced.spin = spin_axes(solver_body) * at(motion + 4);
            find_turn(solver_body, forced);
        }
    }

    // The axis of what is symmetric goes straight on, however fast it spins about that.
    void find_turn(const SolverBody<Real>& solver_body, ForcedBody& forced) const
    {
        const auto at = static_cast<std::size_t>(&solver_body - constraints_.bodies.data());
        const GyroscopicInertia<Real>* const inertia = inertias_at(at);
        if (inertia == nullptr || !(inertia->share[6] > 0) || !(inertia->axis[3] > 0)) return;
        const Real* const axis = inertia->axis;
        forced.axis =
            spin_axes(solver_body) * Vec3(double{axis[0]}, double{axis[1]}, double{axis[2]});
        forced.carries = 0;
    }

    // Forces move a body with contacts and without, so that what contacts gave stays what it was.
    void move_forced_bodies()
    {
        for (const ForcedBody& forced : state_forces_->forced_bodies()) {
            SolverBody<Real>& solver_body = constraints_.bodies[layout_.solver_index[forced.body]];
            const Vec3 spin = spin_axes(solver_body).conjugate() * forced.gained_spin;
            for (int k = 0; k < 3; ++k)
                for (Real* const motion : {solver_body.motion, solver_body.free}) {
                    motion[k] += static_cast<Real>(forced.gained[k]);
                    motion[4 + k] += static_cast<Real>(spin[k]);
                }
        }
    }

    void begin_state_forces(int step)
    {
        if (!state_forces_) return;
        update_forced_bodies(true);
        state_forces_->begin(step * context_.substep(), context_.substep());
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
        if (!state_forces_ || !state_forces_->stiff()) return;
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
            const Vec3 spin = spin_axes(solver_body).conjugate() * forced.carried_spin;
            for (int k = 0; k < 3; ++k) {
                const Real change = static_cast<Real>(spin[k]) - solver_body.motion[4 + k];
                solver_body.motion[4 + k] += change;
                solver_body.free[4 + k] += change;
            }
        }
    }

    // Whether anything acts after bodies moved.
    bool end_state_forces()
    {
        if (!state_forces_ || !state_forces_->late()) return false;
        run_passes();
        if (state_forces_->stiff()) carry_spins();
        update_forced_bodies(false);
        state_forces_->end();
        move_forced_bodies();
        return true;
    }

    // Slices are prepared as late as can be, to be solved while they are in cache: but here all
    // are looked at before anything else is done.
    bool find_split_impulse()
    {
        run_passes();
        if (!note_split_impulse(layout_, batch_, constraints_, split_impulse_)) return false;
        saved_motion_ = SavedMotion<Real>(layout_, batch_, constraints_);
        stiffen(layout_, batch_, constraints_);
        return true;
    }

    std::size_t split_impulse_iterations() const
    {
        const std::size_t iterations =
            kSplitImpulseContacts * saved_motion_.bodies() / batch_.contacts;
        return std::clamp<std::size_t>(iterations, 1, kSplitImpulseIterations);
    }

    // A single slice needs no waiting, so it has its passes at once.
    void add_pass(const Pass& pass)
    {
        if (batch_.slices > 1)
            passes_.push_back(pass);
        else
            run_pass(pass, layout_.slices[batch_.first_slice], batch_.wide);
    }

    void run_passes()
    {
        if (passes_.empty()) return;
        constraints_.wave.run(
            passes_.size(), batch_.slices, [&](std::size_t pass, std::size_t place) {
                const std::size_t at = passes_[pass].backward ? batch_.slices - 1 - place : place;
                run_pass(passes_[pass], layout_.slices[batch_.first_slice + at], false);
            });
        passes_.clear();
    }

    // As many slices as there are passes are at work: their constraints should fit into the cache.
    bool window_fits() const
    {
        constexpr std::size_t kWindow = 8 << 20, kContact = 75 * sizeof(Real);  // bytes
        return passes_.size() * (batch_.contacts / batch_.slices) * kContact < kWindow;
    }

    void run_pass(const Pass& pass, const Slice& slice, bool shared)
    {
        switch (pass.kind) {
        case Pass::Kind::prepare:
            return for_blocks(slice, shared,
                              [&](std::size_t from, std::size_t end) { builder_.make(from, end); });
        case Pass::Kind::save:
            return for_blocks(slice, false, [&](std::size_t from, std::size_t end) {
                saved_motion_.save(slice, from, end, constraints_);
            });
        case Pass::Kind::restore:
            return for_blocks(slice, false, [&](std::size_t from, std::size_t end) {
                saved_motion_.restore(slice, from, end, constraints_);
            });
        case Pass::Kind::store:
            return store(slice, shared);
        case Pass::Kind::begin:
            return begin_substep(slice, shared, pass.first);
        case Pass::Kind::advance:
            return advance(slice, shared);
        case Pass::Kind::warm_start:
            return for_colors(slice, shared, pass.backward, [&](std::size_t from, std::size_t end) {
                warm_start_(view_, from, end, iteration_);
            });
        case Pass::Kind::update_surface_velocity:
            return for_blocks(slice, shared, [&](std::size_t from, std::size_t end) {
                kernels_.update_surface_velocity(view_, from, end, time_ * Real(0.5));
            });
        case Pass::Kind::apply_restitution:
            return apply_restitution(slice, shared, pass.backward);
        default:
            return solve(pass, slice, shared);
        }
    }

    void solve(const Pass& pass, const Slice& slice, bool shared)
    {
        SolverIteration<Real> iteration = iteration_;
        const bool parts = pass.kind == Pass::Kind::solve_split_impulse;
        iteration.use_bias = parts || pass.kind == Pass::Kind::solve_biased;
        iteration.normal_iterations =
            iteration.use_bias ? kBiasedNormalIterations : kRelaxNormalIterations;
        // Nothing slides while bodies part: their velocities are solved already.
        if (parts) iteration.has_friction = iteration.has_rolling_friction = false;
        const auto kernel = parts ? kernels_.solve : solve_;
        for_colors(slice, shared, pass.backward,
                   [&](std::size_t from, std::size_t end) { kernel(view_, from, end, iteration); });
    }

    // Calls body(first, count) for what moves: dynamic and kinematic bodies.
    template <class Body>
    void for_bodies(const Slice& slice, bool shared, Body body)
    {
        if (shared)
            for_each_block(slice.dynamic, kBodies,
                           [&](std::size_t begin, std::size_t end, std::size_t) {
                               body(slice.first_body + begin, end - begin);
                           });
        else
            body(slice.first_body, slice.dynamic);
        if (slice.kinematic > 0) body(slice.first_kinematic_copy, slice.kinematic);
    }

    // Calls body(begin, end) for all blocks.
    template <class Body>
    void for_blocks(const Slice& slice, bool shared, Body body)
    {
        const auto [first, last] = layout_.blocks_of(slice);
        if (!shared) return body(first, last);
        for_each_block(last - first, kBlocks,
                       [&, first = first](std::size_t begin, std::size_t end, std::size_t) {
                           body(first + begin, first + end);
                       });
    }

    // Calls body(begin, end) for the blocks of one color after another.
    template <class Body>
    void for_colors(const Slice& slice, bool shared, bool backward, Body body)
    {
        for (std::uint32_t i = 0; i < slice.colors; ++i) {
            const std::uint32_t place = backward ? slice.colors - 1 - i : i;
            const Color& color = layout_.colors[slice.first_color + place];
            if (!shared || color.serial || color.count <= 2 * kBlocks) {
                body(color.first, color.first + color.count);
                continue;
            }
            for_each_block(color.count, kBlocks,
                           [&](std::size_t begin, std::size_t end, std::size_t) {
                               body(color.first + begin, color.first + end);
                           });
        }
    }

    void store(const Slice& slice, bool shared)
    {
        const std::size_t first = slice.first_contact;
        if (!shared) return builder_.store(first, first + slice.contacts);
        for_each_block(slice.contacts, kBlocks * kBlock,
                       [&](std::size_t begin, std::size_t end, std::size_t) {
                           builder_.store(first + begin, first + end);
                       });
    }

    void begin_substep(const Slice& slice, bool shared, bool first)
    {
        Substep<Real> substep;
        substep.time = time_;
        substep.first = first;
        if (context_.has(Effect::gravity)) {
            const Vec3 change = context_.gravity * context_.substep();
            for (int k = 0; k < 3; ++k) substep.gravity[k] = static_cast<Real>(change[k]);
        }
        if (context_.has(Effect::gyroscopic))
            substep.gyroscopic = context_.settings.gyroscopic == Gyroscopic::implicit
                ? Substep<Real>::Gyroscopic::implicit
                : Substep<Real>::Gyroscopic::direct;
        for_bodies(slice, shared, [&](std::size_t at, std::size_t count) {
            kernels_.begin_substep(constraints_.bodies.data() + at, inertias_at(at), count,
                                   substep);
            if (!constraints_.accelerations.empty()) apply_acceleration(at, count);
        });
    }

    const GyroscopicInertia<Real>* inertias_at(std::size_t at) const
    {
        return constraints_.inertias.empty() ? nullptr : constraints_.inertias.data() + at;
    }

    // The axes that a body's spin is in, by now.
    Quat spin_axes(const SolverBody<Real>& body) const
    {
        return spin_frame(
            body, inertias_at(static_cast<std::size_t>(&body - constraints_.bodies.data())));
    }

    // Forces move a body with contacts and without, so that what contacts gave stays what it was.
    void apply_acceleration(std::size_t at, std::size_t count)
    {
        for (std::size_t i = at; i < at + count; ++i) {
            SolverBody<Real>& body = constraints_.bodies[i];
            const Real* const rate = constraints_.accelerations[i].rate;
            Vec3 spin(double{rate[4]}, double{rate[5]}, double{rate[6]});
            if (!spin.isZero(0)) spin = spin_axes(body).conjugate() * spin;
            for (int k = 0; k < 3; ++k)
                for (Real* const motion : {body.motion, body.free}) {
                    motion[k] += rate[k] * time_;
                    motion[4 + k] += static_cast<Real>(spin[k]) * time_;
                }
        }
    }

    void advance(const Slice& slice, bool shared)
    {
        for_bodies(slice, shared, [&](std::size_t at, std::size_t count) {
            const auto bodies = std::span(constraints_.bodies).subspan(at, count);
            const GyroscopicInertia<Real>* const inertias = inertias_at(at);
            if (kernels_.advance(bodies.data(), inertias, count, time_, iteration_.turns) > 0)
                turn_fast(bodies, inertias, time_);
        });
    }

    // Impacts, one contact after another, round after round, forth and back: each takes both bodies
    // as the ones before have left them.
    void apply_restitution_to_all()
    {
        for (int round = 0; round < kImpactRounds; ++round) {
            struck_ = false;
            add_pass({Pass::Kind::apply_restitution, false, round % 2 == 1});
            run_passes();
            if (!struck_) return;
        }
    }

    void apply_restitution(const Slice& slice, bool shared, bool backward)
    {
        for_colors(slice, shared, backward, [&](std::size_t begin, std::size_t end) {
            if (apply_restitution_(view_, begin, end, iteration_)) struck_ = true;
        });
    }

    const StepContext& context_;
    const RigidFacts& facts_;
    const Layout& layout_;
    const Batch& batch_;
    const ConstraintBuilder<Real>& builder_;
    ContactConstraints<Real>& constraints_;
    SplitImpulse& split_impulse_;
    ContactConstraintsView<Real> view_;
    const SolveKernels<Real>& kernels_;
    // With friction of the kind that is asked for.
    decltype(SolveKernels<Real>::solve) warm_start_, solve_;
    decltype(SolveKernels<Real>::apply_restitution) apply_restitution_;
    std::atomic<bool> struck_ = false;  // in the last round of impacts
    Real time_;                         // s, of a substep
    SolverIteration<Real> iteration_;
    bool on_faces_ = false;
    SavedMotion<Real> saved_motion_;  // while bodies of the batch part
    std::optional<StateDependentForces> state_forces_;
    std::optional<EnergyLimiter<Real>> limiter_, blow_limiter_;
    std::vector<Pass> passes_;  // that wait to be run
};

}  // namespace

template <class Real>
void solve_batch(const StepContext& context,
                 const RigidFacts& facts,
                 const Layout& layout,
                 const Batch& batch,
                 const ConstraintBuilder<Real>& builder,
                 ContactConstraints<Real>& constraints,
                 SplitImpulse& split_impulse)
{
    Task<Real>(context, facts, layout, batch, builder, constraints, split_impulse).run();
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void solve_batch<Real>(const StepContext&, const RigidFacts&, const Layout&,          \
                                    const Batch&, const ConstraintBuilder<Real>&,                  \
                                    ContactConstraints<Real>&, SplitImpulse&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
