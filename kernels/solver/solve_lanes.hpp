// Solve lanes: the kernels of the solver, as the sources that are compiled once a width see them.
#pragma once

#include "kernels/solver/contact_lanes.hpp"
#include "kernels/solver/sweep.hpp"

namespace throng::THRONG_LANES {

template <class Real>
void prepare(const LooseBlock<Real>& loose,
             std::size_t place,
             const RowsView<Real>& rows,
             bool turns);

template <class Real>
void begin_substep(SolverBody<Real>* bodies,
                   const SpinInertia<Real>* inertias,
                   std::size_t count,
                   const Substep<Real>& substep);

template <class Real>
std::size_t advance(SolverBody<Real>* bodies,
                    const SpinInertia<Real>* inertias,
                    std::size_t count,
                    Real time,
                    bool turns);

template <class Real>
void carry(const RowsView<Real>& rows, std::size_t begin, std::size_t end, Real half);

template <class Real>
void walk(const RowsView<Real>& rows, std::size_t place, const Real (&up)[3]);

template <class Real>
void warm_start_grips(const RowsView<Real>& rows,
                      std::size_t begin,
                      std::size_t end,
                      const Visit<Real>& visit);

template <class Real>
void sweep_grips(const RowsView<Real>& rows,
                 std::size_t begin,
                 std::size_t end,
                 const Visit<Real>& visit);

template <class Real>
bool bounce_grips(const RowsView<Real>& rows,
                  std::size_t begin,
                  std::size_t end,
                  const Visit<Real>& visit);

}  // namespace throng::THRONG_LANES
