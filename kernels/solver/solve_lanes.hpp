// Solve lanes: the kernels of the solver, as the sources that are compiled once a width see them.
#pragma once

#include "kernels/solver/contact_lanes.hpp"
#include "kernels/solver/solve_kernels.hpp"

namespace throng::THRONG_LANES {

template <class Real>
void prepare(const PackedContacts<Real>& packed,
             std::size_t place,
             const ContactConstraintsView<Real>& constraints,
             bool turns);

template <class Real>
void update_masses(const ContactConstraintsView<Real>& constraints,
                   std::size_t place,
                   std::uint16_t lanes);

template <class Real>
void begin_substep(SolverBody<Real>* bodies,
                   const GyroscopicInertia<Real>* inertias,
                   const std::uint8_t* precesses,
                   std::size_t count,
                   const Substep<Real>& substep);

template <class Real>
std::size_t advance(SolverBody<Real>* bodies,
                    const GyroscopicInertia<Real>* inertias,
                    const std::uint8_t* precesses,
                    std::size_t count,
                    Real time,
                    bool turns);

template <class Real>
void update_surface_velocity(const ContactConstraintsView<Real>& constraints,
                             std::size_t begin,
                             std::size_t end,
                             Real half);

template <class Real>
void walk_surface_velocity(const ContactConstraintsView<Real>& constraints,
                           std::size_t place,
                           const Real (&up)[3]);

template <class Real>
void warm_start_point_friction(const ContactConstraintsView<Real>& constraints,
                               std::size_t begin,
                               std::size_t end,
                               const SolverIteration<Real>& iteration);

template <class Real>
void solve_point_friction(const ContactConstraintsView<Real>& constraints,
                          std::size_t begin,
                          std::size_t end,
                          const SolverIteration<Real>& iteration);

template <class Real>
bool apply_restitution_point_friction(const ContactConstraintsView<Real>& constraints,
                                      std::size_t begin,
                                      std::size_t end,
                                      const SolverIteration<Real>& iteration);

}  // namespace throng::THRONG_LANES
