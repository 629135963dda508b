// Slice passes: what a batch is gone through for, slice by slice.
//
// A batch of one slice has its passes at once. Of others they wait until they are run together,
// each a slice behind the one before it: what a pass has brought into cache serves those that
// follow.
#pragma once

#include "kernels/solver/solve_kernels.hpp"
#include "pipeline/solvers/constraint_builder.hpp"
#include "pipeline/solvers/split_impulse.hpp"

#include <atomic>

namespace throng {

/// One pass over the contacts or the bodies of a slice.
struct SlicePass {
    enum class Kind : std::uint8_t {
        prepare,
        begin,
        warm_start,
        update_surface_velocity,
        turn_arms,
        solve_biased,
        advance,
        place_rims,
        relax,
        apply_restitution,
        store,
        save,
        solve_split_impulse,
        restore
    } kind;
    bool first = false;     // of the step
    bool backward = false;  // from the last slice and color to the first
};

template <class Real>
class SlicePasses {
public:
    SlicePasses(const StepContext& context,
                const SolverParameters& parameters,
                const Layout& layout,
                const Batch& batch,
                const ConstraintBuilder<Real>& builder,
                ContactConstraints<Real>& constraints);

    void add(const SlicePass& pass);
    /// Those that wait.
    void run();
    /// Whether the constraints of the slices at work fit into the cache: as many as passes wait.
    bool window_fits() const;
    /// Impacts, one contact after another, round after round, forth and back: each takes both
    /// bodies as the ones before have left them.
    void apply_restitution();

    /// Makes room for velocities and impulses that are put aside.
    void start_saving() { saved_motion_ = SavedMotion<Real>(layout_, batch_, constraints_); }
    const SavedMotion<Real>& saved_motion() const { return saved_motion_; }
    const ConstraintBuilder<Real>& builder() const { return builder_; }

    /// Of a solver body, or null.
    const GyroscopicInertia<Real>* inertia_of(const SolverBody<Real>& body) const
    {
        return inertias_at(static_cast<std::size_t>(&body - constraints_.bodies.data()));
    }
    /// The axes that a body's spin is in, by now.
    Quat spin_axes(const SolverBody<Real>& body) const;

private:
    void run_pass(const SlicePass& pass, const Slice& slice, bool shared);
    void solve(const SlicePass& pass, const Slice& slice, bool shared);
    template <class Body>
    void for_bodies(const Slice& slice, bool shared, Body body);
    template <class Body>
    void for_blocks(const Slice& slice, bool shared, Body body);
    template <class Body>
    void for_colors(const Slice& slice, bool shared, bool backward, Body body);
    void store(const Slice& slice, bool shared);
    void begin_substep(const Slice& slice, bool shared, bool first);
    const GyroscopicInertia<Real>* inertias_at(std::size_t at) const
    {
        return view_.inertias == nullptr ? nullptr : view_.inertias + at;
    }
    const std::uint8_t* precesses_at(std::size_t at) const
    {
        return view_.precesses == nullptr ? nullptr : view_.precesses + at;
    }
    void apply_acceleration(std::size_t at, std::size_t count);
    void advance(const Slice& slice, bool shared);
    void apply_restitution_of(const Slice& slice, bool shared, bool backward);

    const StepContext& context_;
    const Layout& layout_;
    const Batch& batch_;
    const ConstraintBuilder<Real>& builder_;
    ContactConstraints<Real>& constraints_;
    ContactConstraintsView<Real> view_;
    const SolveKernels<Real>& kernels_;
    // With friction of the kind that is asked for.
    decltype(SolveKernels<Real>::solve) warm_start_kernel_, solve_kernel_;
    decltype(SolveKernels<Real>::apply_restitution) restitution_kernel_;
    std::atomic<bool> struck_ = false;  // in the last round of impacts
    Real time_;                         // s, of a substep
    SolverIteration<Real> iteration_;
    SavedMotion<Real> saved_motion_;  // while bodies of the batch part
    std::vector<SlicePass> passes_;   // that wait to be run
};

}  // namespace throng
