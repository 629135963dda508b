// Parting: batches of bodies that were made deep inside one another, and how they are solved.
//
// What pushes overlap apart gives bodies speed, which the visits that relax take away again. Where
// many contacts hang together they do not get it all, and a heap made in one place flies apart. So
// while bodies part, velocities are solved first, without any push; impulses and velocities are put
// aside; the push is solved on top of them, moves the bodies, and is forgotten.
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

#include "pipeline/solvers/row_maker.hpp"
#include "pipeline/step/step_data.hpp"

#include <array>

namespace throng {

/// Before the batches of a step: room for their bodies.
void start_parting(const Layout& layout, Parting& parting);

/// Bodies that are solids, or have several shapes, and lie deep in another part, however they came
/// there: they meet it in many places, whose ways out may be to all sides.
template <class Real>
void part_wedged(const ActiveContacts& active,
                 const Colliders& colliders,
                 const RowMaker<Real>& maker,
                 Parting& parting);

/// Whether bodies of a batch were parting before this step, or are wedged in it.
bool anybody_parts(const Layout& layout, const Batch& batch, const Parting& parting);

/// Whether bodies of a batch part, whose rows are prepared. Notes who, for the next step.
template <class Real>
bool note_parting(const Layout& layout,
                  const Batch& batch,
                  const Rows<Real>& rows,
                  Parting& parting);

/// Contacts of a batch whose bodies part give way no more: under a load they never came flat.
template <class Real>
void stiffen(const Layout& layout, const Batch& batch, Rows<Real>& rows);

/// After all batches of a step: who parts from now on.
void follow_parting(Parting& parting);

/// Velocities and impulses of a batch, put aside while it is pushed apart without friction.
template <class Real>
class PutAside {
public:
    PutAside() = default;
    PutAside(const Layout& layout, const Batch& batch, const Rows<Real>& rows);

    /// Of the batch, those that can be moved.
    std::size_t bodies() const { return motions_.size(); }

    /// Those of a slice, whose blocks are the ones from `begin` to before `end`.
    void keep(const Slice& slice, std::size_t begin, std::size_t end, const Rows<Real>& rows);
    void put_back(const Slice& slice, std::size_t begin, std::size_t end, Rows<Real>& rows) const;

private:
    std::size_t first_body_ = 0, first_point_ = 0;
    std::vector<std::array<Real, 8>> motions_;
    std::vector<Lane16<Real>> impulses_;
};

}  // namespace throng
