// Released loads: what contacts remember of a load that is gone, taken back all the way down that
// it went.
//
// A step begins with what contacts gave in the last one. Where somebody heavy has been lifted off a
// tower since, let go of, removed or made light, each contact below still holds him up, and the few
// sweeps of a step pass the difference on by a body or two each: the tower is thrown. Who bears
// whom tells the order that takes it back at once. Contacts that a body leaves, as it would move by
// all impulses together, give up by one share what drives it away; those on their other sides are
// now driven by who bears them, and are looked at next.
//
// Source: relaxation that goes on where most is left over (Southwell, Relaxation Methods in
// Engineering Science, 1940), of contacts and downwards alone: nothing is given, only given back.
#pragma once

#include "pipeline/solvers/constraint_builder.hpp"
#include "pipeline/step/step_data.hpp"

namespace throng {

/// Who of a batch may be thrown so, by solver index, once contacts have been solved for the first
/// time in a step: whom they make faster than he is without them, by much more than gravity gives
/// in a substep and than most bodies of his island move by among one another. In a heap that is
/// still falling in, nothing that this would show can be seen.
///
///   falls  m/s, that gravity gives in a substep
template <class Real>
std::vector<std::uint32_t> find_thrown(const Layout& layout,
                                       const Batch& batch,
                                       double falls,
                                       const ContactConstraints<Real>& constraints);

/// Takes from the contacts of a batch, as they are kept, what they give too much, beginning with
/// those of who is thrown. Bodies have not moved in this step yet; what they would do without
/// contacts is SolverBody::free. Returns whether anything was taken: then the constraints are to be
/// made anew.
///
///   before  as the step began: who is left by less than twice what acts on him in a substep is
///           not left
///   thrown  by solver index
template <class Real>
bool release_loads(const Layout& layout,
                   const Batch& batch,
                   const ConstraintBuilder<Real>& builder,
                   const Velocities& before,
                   std::span<const std::uint32_t> thrown,
                   const ContactConstraints<Real>& constraints);

}  // namespace throng
