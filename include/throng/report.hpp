// Report: what a world has to tell of its steps and of its state.
#pragma once

#include "throng/math.hpp"

#include <string>
#include <vector>

namespace throng {

/// Of StepReport::direct_residual: more than this is a miss.
inline constexpr double kMissedResidual = 1e-8;

/// Of the last step.
struct StepReport {
    std::uint64_t step = 0;    // steps done so far
    std::size_t pairs = 0;     // that the broad phase holds
    std::size_t contacts = 0;  // points
    std::size_t manifolds = 0;
    std::size_t islands = 0;
    std::size_t colors = 0;       // of the most colorful island
    double relax_iterations = 0;  // a contact, of soft_step in a substep; see relax_iterations()
    std::size_t bodies_awake = 0;
    std::size_t bodies_quarantined = 0;  // since the beginning
    std::uint64_t contacts_dropped = 0;  // since the beginning
    std::uint64_t fallbacks = 0;         // answers that one method took from another, likewise
    // Islands that were given more substeps or solved exactly, over all steps so far; and those of
    // them that needed more than they were given.
    std::uint64_t islands_escalated = 0, escalation_missed = 0;
    // What that took: contacts times substeps beyond the usual, an exact solve as 256 of them.
    std::uint64_t escalation_work = 0;
    // Of solver direct: by how much contacts missed their law at worst, as a share of the greatest
    // speed they had to stop (see DirectAnswer), likewise.
    double direct_residual = 0;
    // Of overlap subdivide: m, by how much any two overlapped at the end of any piece of a step,
    // likewise. Pieces that ended deeper than the tolerance, with no halving left, are fallbacks.
    double deepest = 0;
    double time_ms = 0;
};

/// Time spent in one stage, in the last step.
struct StageReport {
    std::string_view name;
    double time_ms = 0;
};

/// What the state is worth, measured from poses and velocities alone.
struct Measures {
    double greatest_overlap = 0;  // m, least-translation depth
    double mean_overlap = 0;      // m, over pairs that overlap
    std::size_t overlapping_pairs = 0;
    double kinetic_energy = 0;     // J
    double potential_energy = 0;   // J, of gravity, 0 at the origin; of springs and attractors
    Vec3 momentum = Vec3::Zero();  // N s
    Vec3 angular_momentum = Vec3::Zero();  // N m s, about the origin of the world
};

}  // namespace throng
