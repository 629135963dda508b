#include "pipeline/solvers/slice_passes.hpp"

#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/coloring.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "kernels/solver/turning_arms.hpp"
#include "pipeline/solvers/impact_rounds.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::size_t kBlocks = 16;   // of 16 contacts a task: some 3 microseconds
constexpr std::size_t kBodies = 512;  // a task

// Sweeps over the points of a contact in one iteration. With two, contacts of four points bear half
// as much again before they stop coming to rest; to relax, one does as well.
constexpr int kBiasedNormalIterations = 2, kRelaxNormalIterations = 1;

// Contacts that the rounds of impacts look at, in all, in a substep: 1,024 rounds of a batch of
// small islands, fewer of a large one.
constexpr std::size_t kImpactContacts = 1024 * kBatchContacts;

}  // namespace

template <class Real>
SlicePasses<Real>::SlicePasses(const StepContext& context,
                               const SolverParameters& parameters,
                               const Layout& layout,
                               const Batch& batch,
                               const ConstraintBuilder<Real>& builder,
                               ContactConstraints<Real>& constraints)
    : context_(context), layout_(layout), batch_(batch), builder_(builder),
      constraints_(constraints), view_(ContactConstraintsView<Real>::of(constraints, batch.calls)),
      kernels_(solve_kernels<Real>()), time_(static_cast<Real>(context.substep()))
{
    const bool otherwise = parameters.friction_at_points_or_pyramid(context.effects);
    warm_start_kernel_ = otherwise ? kernels_.warm_start_point_friction : kernels_.warm_start;
    solve_kernel_ = otherwise ? kernels_.solve_point_friction : kernels_.solve;
    restitution_kernel_ =
        otherwise ? kernels_.apply_restitution_point_friction : kernels_.apply_restitution;
    iteration_.inverse_substep = static_cast<Real>(1 / context.substep());
    iteration_.push_limit = static_cast<Real>(parameters.push_limit);
    iteration_.turns = context.has(Effect::rotation) || otherwise;
    iteration_.has_rolling_friction = context.has(Effect::rolling_friction);
    iteration_.has_friction = context.has(Effect::friction) || iteration_.has_rolling_friction;
    iteration_.friction_at_points = parameters.friction_at == FrictionAt::points;
    iteration_.friction_pyramid = parameters.friction_cone == FrictionCone::pyramid;
    iteration_.restitution_threshold = static_cast<Real>(context.resting_speed());
    for (int k = 0; k < 3; ++k)
        iteration_.gravity_step[k] = static_cast<Real>(context.gravity[k] * context.substep());
}

// A single slice needs no waiting, so it has its passes at once.
template <class Real>
void SlicePasses<Real>::add(const SlicePass& pass)
{
    if (batch_.slices > 1)
        passes_.push_back(pass);
    else
        run_pass(pass, layout_.slices[batch_.first_slice], batch_.wide);
}

template <class Real>
void SlicePasses<Real>::run()
{
    if (passes_.empty()) return;
    constraints_.scratch.wave.run(
        passes_.size(), batch_.slices, [&](std::size_t pass, std::size_t place) {
            const std::size_t at = passes_[pass].backward ? batch_.slices - 1 - place : place;
            run_pass(passes_[pass], layout_.slices[batch_.first_slice + at], false);
        });
    passes_.clear();
}

// As many slices as there are passes are at work: their constraints should fit into the cache.
template <class Real>
bool SlicePasses<Real>::window_fits() const
{
    constexpr std::size_t kWindow = 8 << 20, kContact = 75 * sizeof(Real);  // bytes
    return passes_.size() * (batch_.contacts / batch_.slices) * kContact < kWindow;
}

template <class Real>
void SlicePasses<Real>::run_pass(const SlicePass& pass, const Slice& slice, bool shared)
{
    switch (pass.kind) {
    case SlicePass::Kind::prepare:
        return for_blocks(slice, shared,
                          [&](std::size_t from, std::size_t end) { builder_.make(from, end); });
    case SlicePass::Kind::save:
        return for_blocks(slice, false, [&](std::size_t from, std::size_t end) {
            saved_motion_.save(slice, from, end, constraints_);
        });
    case SlicePass::Kind::restore:
        return for_blocks(slice, false, [&](std::size_t from, std::size_t end) {
            saved_motion_.restore(slice, from, end, constraints_);
        });
    case SlicePass::Kind::store:
        return store(slice, shared);
    case SlicePass::Kind::begin:
        return begin_substep(slice, shared, pass.first);
    case SlicePass::Kind::advance:
        return advance(slice, shared);
    case SlicePass::Kind::warm_start:
        return for_colors(slice, shared, pass.backward, [&](std::size_t from, std::size_t end) {
            warm_start_kernel_(view_, from, end, iteration_);
        });
    case SlicePass::Kind::update_surface_velocity:
        return for_blocks(slice, shared, [&](std::size_t from, std::size_t end) {
            kernels_.update_surface_velocity(view_, from, end, time_ * Real(0.5));
        });
    case SlicePass::Kind::turn_arms:
        return for_colors(slice, shared, pass.backward, [&](std::size_t from, std::size_t end) {
            throng::turn_arms(view_, from, end, double{time_}, pass.first);
        });
    case SlicePass::Kind::place_rims:
        return for_blocks(slice, shared, [&](std::size_t from, std::size_t end) {
            throng::place_rims(view_, from, end);
        });
    case SlicePass::Kind::apply_restitution:
        return apply_restitution_of(slice, shared, pass.backward);
    default:
        return solve(pass, slice, shared);
    }
}

template <class Real>
void SlicePasses<Real>::solve(const SlicePass& pass, const Slice& slice, bool shared)
{
    SolverIteration<Real> iteration = iteration_;
    const bool parts = pass.kind == SlicePass::Kind::solve_split_impulse;
    iteration.use_bias = parts || pass.kind == SlicePass::Kind::solve_biased;
    iteration.normal_iterations =
        iteration.use_bias ? kBiasedNormalIterations : kRelaxNormalIterations;
    // Nothing slides while bodies part: their velocities are solved already.
    if (parts) iteration.has_friction = iteration.has_rolling_friction = false;
    const auto kernel = parts ? kernels_.solve : solve_kernel_;
    for_colors(slice, shared, pass.backward,
               [&](std::size_t from, std::size_t end) { kernel(view_, from, end, iteration); });
}

// Calls body(first, count) for what moves: dynamic and kinematic bodies.
template <class Real>
template <class Body>
void SlicePasses<Real>::for_bodies(const Slice& slice, bool shared, Body body)
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
template <class Real>
template <class Body>
void SlicePasses<Real>::for_blocks(const Slice& slice, bool shared, Body body)
{
    const auto [first, last] = layout_.blocks_of(slice);
    if (!shared) return body(first, last);
    for_each_block(last - first, kBlocks,
                   [&, first = first](std::size_t begin, std::size_t end, std::size_t) {
                       body(first + begin, first + end);
                   });
}

// Calls body(begin, end) for the blocks of one color after another.
template <class Real>
template <class Body>
void SlicePasses<Real>::for_colors(const Slice& slice, bool shared, bool backward, Body body)
{
    for (std::uint32_t i = 0; i < slice.colors; ++i) {
        const std::uint32_t place = backward ? slice.colors - 1 - i : i;
        const Color& color = layout_.colors[slice.first_color + place];
        if (!shared || color.serial || color.count <= 2 * kBlocks) {
            body(color.first, color.first + color.count);
            continue;
        }
        for_each_block(color.count, kBlocks, [&](std::size_t begin, std::size_t end, std::size_t) {
            body(color.first + begin, color.first + end);
        });
    }
}

template <class Real>
void SlicePasses<Real>::store(const Slice& slice, bool shared)
{
    const std::size_t first = slice.first_contact;
    if (!shared) return builder_.store(first, first + slice.contacts);
    for_each_block(slice.contacts, kBlocks * kBlock,
                   [&](std::size_t begin, std::size_t end, std::size_t) {
                       builder_.store(first + begin, first + end);
                   });
}

template <class Real>
void SlicePasses<Real>::begin_substep(const Slice& slice, bool shared, bool first)
{
    Substep<Real> substep;
    substep.time = time_;
    substep.first = first;
    if (context_.has(Effect::gravity)) {
        const Vec3 change = context_.gravity * context_.substep();
        for (int k = 0; k < 3; ++k) substep.gravity[k] = static_cast<Real>(change[k]);
    }
    if (context_.has(Effect::gyroscopic))
        substep.gyroscopic = context_.gyroscopic == Gyroscopic::implicit
            ? Substep<Real>::Gyroscopic::implicit
            : Substep<Real>::Gyroscopic::direct;
    for_bodies(slice, shared, [&](std::size_t at, std::size_t count) {
        kernels_.begin_substep(constraints_.bodies.data() + at, inertias_at(at), precesses_at(at),
                               count, substep);
        if (context_.effects.meets(kForces)) apply_acceleration(at, count);
    });
}

// The axes that a body's spin is in, by now.
template <class Real>
Quat SlicePasses<Real>::spin_axes(const SolverBody<Real>& body) const
{
    return spin_frame(body, inertia_of(body));
}

// Forces move a body with contacts and without, so that what contacts gave stays what it was.
template <class Real>
void SlicePasses<Real>::apply_acceleration(std::size_t at, std::size_t count)
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

template <class Real>
void SlicePasses<Real>::advance(const Slice& slice, bool shared)
{
    for_bodies(slice, shared, [&](std::size_t at, std::size_t count) {
        const auto bodies = std::span(constraints_.bodies).subspan(at, count);
        const GyroscopicInertia<Real>* const inertias = inertias_at(at);
        if (kernels_.advance(bodies.data(), inertias, precesses_at(at), count, time_,
                             iteration_.turns)
            > 0)
            turn_fast(bodies, inertias, time_);
    });
}

template <class Real>
void SlicePasses<Real>::apply_restitution()
{
    const std::size_t rounds = impact_rounds(kImpactContacts, batch_.contacts);
    for (std::size_t round = 0; round < rounds; ++round) {
        struck_ = false;
        add({SlicePass::Kind::apply_restitution, false, round % 2 == 1});
        run();
        if (!struck_) return;
    }
}

template <class Real>
void SlicePasses<Real>::apply_restitution_of(const Slice& slice, bool shared, bool backward)
{
    for_colors(slice, shared, backward, [&](std::size_t begin, std::size_t end) {
        if (restitution_kernel_(view_, begin, end, iteration_)) struck_ = true;
    });
}

template class SlicePasses<float>;
template class SlicePasses<double>;

}  // namespace throng
