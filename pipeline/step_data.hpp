// Step data: everything that travels down the step, each kind once.
#pragma once

#include "broadphase/broadphase.hpp"
#include "broadphase/pair_filter.hpp"
#include "kernels/data/bodies.hpp"
#include "kernels/data/bounds.hpp"
#include "kernels/data/contacts.hpp"
#include "kernels/data/forces.hpp"
#include "kernels/data/islands.hpp"
#include "kernels/data/pairs.hpp"
#include "kernels/data/rows.hpp"
#include "kernels/solve/coloring.hpp"
#include "kernels/solve/islands.hpp"
#include "narrowphase/methods/method_contacts.hpp"
#include "pipeline/conditions.hpp"

#include <tuple>

namespace throng {

/// A substep is cut no finer than this for penalty forces.
inline constexpr int kMostPenaltyCuts = 1000;

/// What a step has to tell of trouble.
struct Trouble {
    std::vector<std::uint32_t>
        quarantined;             // bodies that turned non-finite in this step, ascending
    double direct_residual = 0;  // greatest of the islands that were solved directly in this step
    std::uint64_t direct_left = 0;       // islands in it that were too great for that
    std::vector<double> residual_of;     // scratch: [batches]
    std::uint64_t held_groups = 0;       // in it that could not be carried on without overlap
    int penalty_cuts = 1;                // most that penalty forces cut a substep into
    std::vector<int> cuts_of;            // scratch: [batches]
    BlockLists<std::uint32_t> of_block;  // scratch
};

/// Who awoke and who fell asleep in this step.
struct Rest {
    std::vector<std::uint32_t> awoken, rested;
};

/// Who was swept in this step, and who was held.
///
///   held  bodies, ascending
struct FastBodies {
    std::vector<std::uint32_t> held;
    std::vector<std::uint8_t> flags;  // [bodies] scratch, all 0 between stages
};

// The finder of pairs, as one thing among the data: it remembers from step to step.
struct Finder {
    AnyPairFinder finder;
};

template <class Real>
using StepData = std::tuple<Conditions,
                            Shapes,
                            Surfaces,
                            PairFilter,
                            Drives,
                            Forces,
                            Poses,
                            Velocities,
                            Masses,
                            BodyStates,
                            Beds,
                            Colliders,
                            Bounds,
                            Finder,
                            Pairs,
                            ConvexContacts<Real>,
                            MethodPairs,
                            MeshContacts<Real>,
                            SolidContacts<Real>,
                            Pulls,
                            Flights,
                            ActiveContacts,
                            IslandFinder,
                            Islands,
                            Painter,
                            Layout,
                            Rows<Real>,
                            Trouble,
                            Rest,
                            FastBodies>;

}  // namespace throng
