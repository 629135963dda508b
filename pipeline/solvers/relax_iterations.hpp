// Relax iterations: how often contacts are solved once more after bodies have moved, to take out of
// their velocities what overlap pushed into them.
#pragma once

#include "pipeline/step/step_data.hpp"

namespace throng {

/// Whether most contacts of a batch have three points or more, as in towers and walls.
bool lies_on_faces(const Batch& batch);

/// Relaxing iterations of those.
inline constexpr int kInStructures = 2;

/// Relaxing iterations that a batch gets in a substep: one quietens a heap, and where most bodies
/// lie on one another by their faces, as in towers and walls, a second one leaves a hundredth of
/// the energy. Where there are many substeps it keeps pushes from braking what rubs.
int relax_iterations(const SolverParameters& parameters, int substeps, const Batch& batch);
/// Those of an island with finer substeps, whose settings these are: what it gains by a push has a
/// long way to go where many stand on one another.
int finer_relax_iterations(const SolverParameters& parameters, int substeps, const Batch& batch);
/// The mean of that over all contacts; 0 where there are none.
double
mean_relax_iterations(const SolverParameters& parameters, int substeps, const Layout& layout);

}  // namespace throng
