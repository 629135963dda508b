// Split impulse: batches of bodies that were made deep inside one another, and how they are solved.
//
// What pushes overlap apart gives bodies speed, which the iterations that relax take away again.
// Where many contacts hang together they do not get it all, and a heap made in one place flies
// apart. So while bodies part, velocities are solved first, without any push; impulses and
// velocities are put aside; the push is solved on top of them, moves the bodies, and is forgotten.
//
// A body that the program puts somewhere parts from when it lies deep in another until all its
// contacts are flat, and so do those that it leans on and that lean on it: pushed the usual way
// they would get the speed. What has no room, or a load keeps from coming flat, stops after a
// number of steps. What a fall or a load drives deep into another does not part, where the two are
// convex: bodies in motion have the usual push. Where they meet in many places, as plates that a
// fall has driven through one another do, its pushes to all sides would spin them.
//
// Source: split impulses, as Bullet has them (btContactSolverInfo::m_splitImpulse).
#pragma once

#include "pipeline/solvers/constraint_builder.hpp"
#include "pipeline/step/step_data.hpp"

#include <array>

namespace throng {

/// Before the batches of a step: room for their bodies.
void start_split_impulse(const Layout& layout, SplitImpulse& split_impulse);

/// Bodies that are solids, or have several shapes, and lie deep in another part, however they came
/// there: they meet it in many places, whose ways out may be to all sides.
template <class Real>
void split_wedged(const StepContext& context,
                  const ActiveContacts& active,
                  const Colliders& colliders,
                  const Masses& masses,
                  const ConstraintBuilder<Real>& builder,
                  SplitImpulse& split_impulse);

/// Whether bodies of a batch were parting before this step, or are wedged in it.
bool uses_split_impulse(const Layout& layout,
                        const Batch& batch,
                        const SplitImpulse& split_impulse);

/// Whether bodies of a batch part, whose constraints are prepared. Notes who, for the next step.
template <class Real>
bool note_split_impulse(const Layout& layout,
                        const Batch& batch,
                        const ContactConstraints<Real>& constraints,
                        SplitImpulse& split_impulse);

/// Contacts of a batch whose bodies part give way no more: under a load they never came flat.
template <class Real>
void stiffen(const Layout& layout, const Batch& batch, ContactConstraints<Real>& constraints);

/// After all batches of a step: who parts from now on.
void update_split_impulse(const Layout& layout, SplitImpulse& split_impulse);

/// Velocities and impulses of a batch, put aside while it is pushed apart without friction.
template <class Real>
class SavedMotion {
public:
    SavedMotion() = default;
    SavedMotion(const Layout& layout,
                const Batch& batch,
                const ContactConstraints<Real>& constraints);

    /// Of the batch, those that can be moved.
    std::size_t bodies() const { return motions_.size(); }

    /// Those of a slice, whose blocks are the ones from `begin` to before `end`.
    void save(const Slice& slice,
              std::size_t begin,
              std::size_t end,
              const ContactConstraints<Real>& constraints);
    void restore(const Slice& slice,
                 std::size_t begin,
                 std::size_t end,
                 ContactConstraints<Real>& constraints) const;

private:
    std::size_t first_body_ = 0, first_point_ = 0;
    std::vector<std::array<Real, 8>> motions_;
    std::vector<Lane16<Real>> impulses_;
};

}  // namespace throng
