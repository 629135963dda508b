// Sweep: one visit of the solver to blocks of contacts.
//
// The blocks of a call may be visited in any order and by any thread, provided they share no body
// (coloring sees to that). Width is chosen once, when the program starts; the answer never depends
// on it.
#pragma once

#include "kernels/data/rows.hpp"

#include <cstddef>

namespace throng {

/// What is asked of a visit.
template <class Real>
struct Visit {
    Real inverse_substep = 0;  // 1/s
    Real push_limit = 0;       // m/s, fastest that overlap is pushed apart
    bool push = false;         // push overlap apart; else only take away what pushing left behind
    bool turns = true;         // some body can turn: without, the angular half is not computed
    bool grips = true;         // some contact has friction
    bool rolls = false;        // some contact resists rolling
    int normal_sweeps = 2;     // times the points are gone through; the last one after friction
};

/// The solver's kernels for one width. All work in place on `count` blocks and the solver bodies
/// that the blocks name (places in `bodies`).
///
///   warm_start  gives the bodies the impulses of the last visit again
///   sweep       moves every point towards its wanted normal speed, never pulling; then friction,
///   on
///               a round cone of the contact's normal impulse; then the points again
///   restitute   lets points that came in fast leave with `restitution` times that speed
///
/// Source: Catto, Iterative Dynamics with Temporal Coherence (2005) for impulses that accumulate;
///         Catto, Solver2D (2024) for substeps of soft contacts with a relaxing visit.
template <class Real>
struct SolveKernels {
    const char* name;
    int lanes;
    void (*warm_start)(ContactBlock<Real>* blocks,
                       std::size_t count,
                       SolverBody<Real>* bodies,
                       const Visit<Real>& visit);
    void (*sweep)(ContactBlock<Real>* blocks,
                  std::size_t count,
                  SolverBody<Real>* bodies,
                  const Visit<Real>& visit);
    void (*restitute)(ContactBlock<Real>* blocks,
                      std::size_t count,
                      SolverBody<Real>* bodies,
                      Real threshold,
                      const Visit<Real>& visit);
};

/// The kernels of one width: "scalar", "avx2" or "avx512"; none where the machine has not got it
/// or the name is another.
template <class Real>
const SolveKernels<Real>* solve_kernels_of(const char* width);

/// The widest that this machine has, or what the environment variable THRONG_LANES asks for.
/// Throws std::runtime_error, saying what there is, where that cannot be had.
template <class Real>
const SolveKernels<Real>& solve_kernels();

}  // namespace throng
