// Stages: the step as a list of signatures, in the order in which one thread would run them.
//
// This is the wiring. A const parameter is read, the others are written, and a stage can reach
// nothing else. step_table.cpp says which effects call for each.
#pragma once

#include "pipeline/step/stage.hpp"

namespace throng {

/// Everything that is kept of pairs from step to step.
template <class Real>
using PairData = StageData<Pairs,
                           ConvexContacts<Real>,
                           MeshContacts<Real>,
                           SolidContacts<Real>,
                           MethodPairs,
                           SleepingPairs,
                           SleepingContacts<Real>,
                           RestingBodies>;

/// Pairs of which neither can move until somebody wakes leave the lists that the others are in.
template <class Real>
void sleep_pairs(const Colliders&, const BodyStates&, const SleepEvents&, const PairData<Real>&);

/// Sets the velocities that the user drives.
void prescribe_velocities(const PrescribedVelocities&, const BodyStates&, Velocities&);

/// Boxes round the shapes of what moves: a body within its margin costs no more than a look.
void update_bounds(const StepContext&,
                   const ImpactParameters&,
                   const Shapes&,
                   const Colliders&,
                   const Poses&,
                   const Velocities&,
                   const BodyStates&,
                   Bounds&);

/// Boxes into pairs; those that live on keep what they know.
void find_pairs(const Bounds&, const Shapes&, const Colliders&, const PairFilter&, Finder&, Pairs&);

/// Pairs of convex shapes into contacts, impulses carried over.
template <class Real>
void collide_convex(const StepContext&,
                    const NarrowPhaseParameters&,
                    const Pairs&,
                    const Shapes&,
                    const Colliders&,
                    const Bounds&,
                    const Poses&,
                    const BodyStates&,
                    ConvexContacts<Real>&,
                    MethodPairs&);

/// Pairs with a solid: several contacts each, or what they had while they hardly moved.
template <class Real>
void collide_solids(const StepContext&,
                    const Pairs&,
                    const Shapes&,
                    const Colliders&,
                    const Bounds&,
                    const Poses&,
                    const BodyStates&,
                    SolidContacts<Real>&);

/// Convex shapes against triangle meshes.
template <class Real>
void collide_meshes(const StepContext&,
                    const Pairs&,
                    const Shapes&,
                    const Colliders&,
                    const Bounds&,
                    const Poses&,
                    const BodyStates&,
                    MeshContacts<Real>&);

/// Wakes whoever is touched by somebody awake, with all that fell asleep with it and its pairs.
template <class Real>
void wake_islands(const Colliders&,
                  const Velocities&,
                  const PairData<Real>&,
                  SleepingIslands&,
                  BodyStates&,
                  SleepEvents&);

/// Wakes who rests by itself: whom the last step's impulses were told to wake, and whom somebody
/// touches who will change what is borne by much; with their pairs.
template <class Real>
void wake_bodies(const SleepParameters&,
                 const Colliders&,
                 const Velocities&,
                 const Masses&,
                 const PairData<Real>&,
                 SleepingIslands&,
                 BodyStates&,
                 SleepEvents&);

/// Contacts with edges and sides of colliders that lie flush with one that bears the body end here.
template <class Real>
void remove_ghost_contacts(const Pairs&,
                           const Shapes&,
                           const Colliders&,
                           const Bounds&,
                           const Poses&,
                           const Velocities&,
                           const BodyStates&,
                           ConvexContacts<Real>&,
                           MeshContacts<Real>&,
                           SolidContacts<Real>&,
                           GhostMarks&);

/// Points that are borne by a pivot next to them end here.
template <class Real>
void remove_pivot_contacts(const Pairs&,
                           const Colliders&,
                           const Forces&,
                           const Masses&,
                           ConvexContacts<Real>&,
                           MeshContacts<Real>&,
                           SolidContacts<Real>&);

/// Pairs that near each other faster than a program wants to be told of.
template <class Real>
void measure_approaches(const Pairs&,
                        const Colliders&,
                        const Poses&,
                        const Velocities&,
                        const BodyStates&,
                        const ConvexContacts<Real>&,
                        const MeshContacts<Real>&,
                        const SolidContacts<Real>&,
                        TouchingPairs&);

/// All kinds of contact into one order: those that this step has to solve.
template <class Real>
void gather_contacts(const Pairs&,
                     const Colliders&,
                     const Surfaces&,
                     const BodyStates&,
                     const ConvexContacts<Real>&,
                     const MeshContacts<Real>&,
                     const SolidContacts<Real>&,
                     ActiveContacts&);

/// Contacts of two bodies, or of one with what stands still, that lie in one plane and may bounce,
/// into one.
template <class Real>
void join_contacts(const StepContext&,
                   const BodyStates&,
                   const Colliders&,
                   const ConvexContacts<Real>&,
                   const MeshContacts<Real>&,
                   const SolidContacts<Real>&,
                   ActiveContacts&,
                   JoinedContacts<Real>&);

/// Contacts into islands, with those that springs join to who is in one.
void split_islands(const StepContext&,
                   const ActiveContacts&,
                   const BodyStates&,
                   const SleepEvents&,
                   const Forces&,
                   IslandFinder&,
                   Islands&);

/// Who is in need of a gyroscopic torque: by the dial effects=auto it is left out of who turns so
/// slowly, or so evenly, that he is off by no more than effects_error for it.
void neglect_effects(const StepContext&,
                     const NeglectParameters&,
                     const Forces&,
                     const BodyStates&,
                     const Poses&,
                     const Velocities&,
                     Masses&,
                     NeglectedEffects&);

/// What each island calls for of its solve; those that call for the same come side by side.
template <class Real>
void sort_islands(const StepContext&,
                  const NeglectParameters&,
                  const SleepParameters&,
                  const ActiveContacts&,
                  const BodyStates&,
                  const Poses&,
                  const Velocities&,
                  const Masses&,
                  const Forces&,
                  const Shapes&,
                  const Colliders&,
                  const EffectCensus&,
                  const PrescribedVelocities&,
                  const SplitImpulse&,
                  const ConvexContacts<Real>&,
                  const MeshContacts<Real>&,
                  const SolidContacts<Real>&,
                  const JoinedContacts<Real>&,
                  NeglectedEffects&,
                  Islands&);

/// Stubborn islands by how stubborn they are: who gets more substeps, who the direct solver.
void escalate_islands(const StepContext&, const Islands&, OverloadedIslands&);

/// Islands into batches, slices, colors and blocks.
void color_constraints(const StepContext&,
                       const SolverParameters&,
                       const Islands&,
                       const OverloadedIslands&,
                       const ActiveContacts&,
                       const BodyStates&,
                       const Poses&,
                       ConstraintGraph&,
                       Layout&);

/// Forces that stay as they are through the step into what they do to the velocities of bodies that
/// touch something. Those that follow the bodies are asked in each substep; and who is in flight
/// asks for itself, as often as its integrator does.
void apply_forces(const StepContext&,
                  const Layout&,
                  const Forces&,
                  const Poses&,
                  const Velocities&,
                  const Masses&,
                  const BodyStates&,
                  ExternalAcceleration&);

/// Bodies into solver bodies, and room for the constraints of their contacts.
template <class Real>
void prepare_constraints(const StepContext&,
                         const SolverParameters&,
                         const Islands&,
                         const Layout&,
                         const Forces&,
                         const Poses&,
                         const Masses&,
                         const BodyStates&,
                         const Shapes&,
                         const Colliders&,
                         const ExternalAcceleration&,
                         const PrescribedVelocities&,
                         Flights&,
                         Velocities&,
                         ContactConstraints<Real>&);

/// What is solved: contacts into constraints, constraints into impulses and motion.
template <class Real>
using ContactProblem = StageData<const StepContext,
                                 const SolverParameters,
                                 const Layout,
                                 const ActiveContacts,
                                 const Colliders,
                                 const Masses,
                                 const Forces,
                                 const ExternalAcceleration,
                                 const PrescribedVelocities,
                                 ContactConstraints<Real>,
                                 ConvexContacts<Real>,
                                 MeshContacts<Real>,
                                 SolidContacts<Real>,
                                 JoinedContacts<Real>,
                                 Poses,
                                 Velocities,
                                 Flights,
                                 SplitImpulse,
                                 StepDiagnostics>;

/// Soft constraints, an iteration a substep. Islands that are escalated get more substeps or the
/// direct solver.
template <class Real>
void solve_soft_step(const ContactProblem<Real>&);
/// Projected Gauss-Seidel, many iterations a substep, with escalation likewise.
template <class Real>
void solve_pgs(const ContactProblem<Real>&);
/// Exactly, island by island; those beyond direct_limit by the soft step.
template <class Real>
void solve_direct(const ContactProblem<Real>&);
/// Springs and dampers in place of impulses, in as many parts of a substep as these bear.
template <class Real>
void solve_penalty(const ContactProblem<Real>&);
/// Bodies that meet are stopped and put side by side.
template <class Real>
void solve_kinematic(const ContactProblem<Real>&);

/// How much too great the loads are that islands bear now: who is stubborn from the next step on.
template <class Real>
void measure_strain(const StepContext&,
                    const SolverParameters&,
                    const Islands&,
                    const Layout&,
                    const ActiveContacts&,
                    const Masses&,
                    const Poses&,
                    const Velocities&,
                    const ConvexContacts<Real>&,
                    const MeshContacts<Real>&,
                    const SolidContacts<Real>&,
                    const JoinedContacts<Real>&,
                    const ContactConstraints<Real>&,
                    OverloadedIslands&);

/// What solver bodies came to since the step began, onto poses and velocities.
template <class Real>
void store_solution(
    const Layout&, const ContactConstraints<Real>&, Poses&, Velocities&, StepDiagnostics&);

/// What is carried from touch to touch, in place of all stages of contact: dynamic bodies, each
/// with those that it may meet in this step.
using EventDrivenStep = StageData<const StepContext,
                                  const SolverParameters,
                                  const ImpactParameters,
                                  const Shapes,
                                  const Surfaces,
                                  const PairFilter,
                                  const Colliders,
                                  const BodyStates,
                                  const Masses,
                                  const Forces,
                                  const PrescribedVelocities,
                                  Poses,
                                  Velocities,
                                  Flights,
                                  Islands,
                                  EventDrivenContacts,
                                  StepDiagnostics>;

/// To the first moment of each touch, so that none ever overlap.
void back_up(const EventDrivenStep&);
/// By halves: what would end in overlap is done again as two pieces, down to the least.
void subdivide(const EventDrivenStep&);

/// Bodies that touch nothing: velocities into poses.
void integrate_poses(const StepContext&,
                     const Islands&,
                     const Masses&,
                     const BodyStates&,
                     const Forces&,
                     Flights&,
                     Poses&,
                     Velocities&,
                     StepDiagnostics&);

/// Bodies that turned non-finite stand still from now on.
void quarantine_bodies(StepDiagnostics&, BodyStates&, Masses&, Velocities&);

/// Bodies that go so far in a step that they could pass through something: held where they first
/// meet it, for the contacts of the next step.
template <class Real>
void continuous_collision(const StepContext&,
                          const ImpactParameters&,
                          const Shapes&,
                          const Colliders&,
                          const Surfaces&,
                          const PairFilter&,
                          const Forces&,
                          const Masses&,
                          const Bounds&,
                          const Pairs&,
                          const BodyStates&,
                          const Islands&,
                          const SleepEvents&,
                          const ConvexContacts<Real>&,
                          const MeshContacts<Real>&,
                          Poses&,
                          Velocities&,
                          FastBodies&);

/// Islands that have been quiet long enough fall asleep.
void sleep_islands(const StepContext&,
                   const SleepParameters&,
                   const PrescribedVelocities&,
                   const Forces&,
                   const Islands&,
                   const SplitImpulse&,
                   BodyStates&,
                   SleepingIslands&,
                   Velocities&,
                   SleepEvents&);

/// Bodies that have been quiet long enough, and are borne steadily, come to rest each by itself;
/// those that contacts bear otherwise than then are told to wake.
template <class Real>
void rest_bodies(const StepContext&,
                 const SleepParameters&,
                 const PrescribedVelocities&,
                 const Forces&,
                 const Islands&,
                 const SplitImpulse&,
                 const Colliders&,
                 const Pairs&,
                 const ConvexContacts<Real>&,
                 const MeshContacts<Real>&,
                 const SolidContacts<Real>&,
                 BodyStates&,
                 SleepingIslands&,
                 Velocities&,
                 RestingBodies&,
                 SleepEvents&);

/// Who touches whom, for a program that listens: what of it began, ended, or was a hit.
template <class Real>
void find_touching_pairs(const Pairs&,
                         const ConvexContacts<Real>&,
                         const MeshContacts<Real>&,
                         const SolidContacts<Real>&,
                         const JoinedContacts<Real>&,
                         const ActiveContacts&,
                         const Layout&,
                         const ContactConstraints<Real>&,
                         SleepingPairs&,
                         TouchingPairs&);

}  // namespace throng
