// Step data: everything that travels down the step, each kind once.
#pragma once

#include "broadphase/broadphase.hpp"
#include "broadphase/pair_filter.hpp"
#include "kernels/data/bodies.hpp"
#include "kernels/data/bounds.hpp"
#include "kernels/data/contact_constraints.hpp"
#include "kernels/data/contacts.hpp"
#include "kernels/data/forces.hpp"
#include "kernels/data/islands.hpp"
#include "kernels/data/pairs.hpp"
#include "kernels/solver/coloring.hpp"
#include "kernels/solver/islands.hpp"
#include "narrowphase/alternatives/method_contacts.hpp"
#include "pipeline/step/effect_census.hpp"
#include "pipeline/step/parameters.hpp"
#include "pipeline/step/resting_bodies.hpp"
#include "pipeline/step/sleeping_pairs.hpp"
#include "pipeline/step/step_context.hpp"
#include "pipeline/step/touching_pairs.hpp"

#include <tuple>

namespace throng {

/// A substep is cut no finer than this for penalty forces.
inline constexpr int kMostPenaltyCuts = 1000;

/// What a step has to tell of trouble.
struct StepDiagnostics {
    std::vector<std::uint32_t>
        quarantined;             // bodies that turned non-finite in this step, ascending
    double direct_residual = 0;  // greatest of the islands that were solved directly in this step
    std::uint64_t direct_left = 0;  // islands in it that were too great for that
    std::uint64_t held_groups = 0;  // in it that could not be carried on without overlap
    std::uint64_t deep_pieces = 0;  // of it that ended too deep, with no halving left
    double deepest = 0;             // m, overlap at the end of any piece of it
    int penalty_cuts = 1;           // most that penalty forces cut a substep into

    struct Scratch {
        std::vector<double> residual_of;  // [batches]
        std::vector<int> cuts_of;         // [batches]
        BlockLists<std::uint32_t> of_block;
    } scratch;
};

/// Who is moved apart from what it was made deep in (see solvers/split_impulse.hpp), from step to
/// step.
struct SplitImpulse {
    static constexpr std::uint16_t kPlaced = 0x4000;

    std::vector<std::uint16_t> steps;   // [bodies] for which it may go on, and kPlaced: see place()
    std::vector<std::uint32_t> bodies;  // of which steps are not 0, as the step begins
    bool some = false;                  // somebody is, or was placed
    struct Scratch {
        std::vector<std::uint8_t> batches;  // [batches] 1: somebody in it is moved apart
    } scratch;

    /// Notes that a body was put where it is by the program, since the last step.
    void place(std::size_t body)
    {
        if (steps.size() <= body) steps.resize(body + 1, 0);
        if (steps[body] == 0) bodies.push_back(static_cast<std::uint32_t>(body));
        steps[body] |= kPlaced;
        some = true;
    }
    /// Whether a body was put where it is, or parts already.
    bool knows(std::size_t body) const { return body < steps.size() && steps[body] != 0; }
    bool parts(std::size_t body) const
    {
        return body < steps.size() && (steps[body] & ~kPlaced) != 0;
    }
};

/// Whether a body of that strain belongs to a stubborn island, and not to one on the way there.
inline bool is_overloaded(double strain) { return strain < 0 || strain > 1; }

/// Islands whose loads are too much for the solver (see solvers/escalation.hpp), from step to step.
///
///   strain    [bodies] that of a stubborn island in the last step, else 0; may be shorter
///   strained  bodies whose strain may be above 0
///   limited   [bodies] steps for which contacts are still held to making no energy; may be shorter
///   gainers   bodies of which limited may be above 0
///   efforts   [islands] of this step; empty while nobody is stubborn
///   escalated, missed  islands of this step that were, and that the budget did not reach
///   work      contacts times substeps beyond the usual of this step; see StepReport
struct OverloadedIslands {
    std::vector<float> strain;
    std::vector<std::uint32_t> strained;
    std::vector<std::uint8_t> limited;
    std::vector<std::uint32_t> gainers;
    std::vector<Effort> efforts;
    std::size_t escalated = 0, missed = 0, work = 0;
    // What an island is to have, and whether it is too great for what it needs.
    struct Wish {
        std::uint32_t island;
        Effort effort;
        bool too_great;
    };
    struct Scratch {
        std::vector<Wish> wishes;
        std::vector<float> of_island;       // [islands] strain
        std::vector<std::uint8_t> limited;  // [islands]
        std::vector<std::uint16_t> height;  // [solver bodies] above what stands still
        // How far loads press in a body's contacts: the greatest two of them, and all with what
        // stands still.
        struct Gives {
            float first = 0, second = 0, ground = 0;
            std::uint32_t count = 0;
            void add(float give)
            {
                ++count;
                second = std::max(second, std::min(first, give));
                first = std::max(first, give);
            }
        };
        std::vector<Gives> gives;          // [solver bodies]
        std::vector<float> contact_gives;  // [contacts] in the order of Islands::contacts
    } scratch;

    float of(std::uint32_t body) const { return body < strain.size() ? strain[body] : 0; }
    std::uint8_t limited_for(std::uint32_t body) const
    {
        return body < limited.size() ? limited[body] : 0;
    }
    void forget(std::uint32_t body)
    {
        if (body < strain.size()) strain[body] = 0;
        if (body < limited.size()) limited[body] = 0;
    }
    void forget_all()
    {
        for (const std::uint32_t body : strained) forget(body);
        for (const std::uint32_t body : gainers) forget(body);
        strained.clear();
        gainers.clear();
    }
};

/// What this step leaves out: see neglect_effects().
struct NeglectedEffects {
    /// callers   that call for it and go without: bodies; contacts that roll
    /// bound     of the radius, and rad: the greatest that any of them is off by for it in 0.1 s
    struct Share {
        std::size_t callers = 0;
        double bound = 0;

        void add(const Share& other)
        {
            callers += other.callers;
            bound = std::max(bound, other.bound);
        }
    };
    Share gyroscopic, rolling_friction;
    struct Scratch {
        std::vector<Share> of_block;
    } scratch;
};

/// Who awoke and who fell asleep in this step.
struct SleepEvents {
    std::vector<std::uint32_t> woke, fell_asleep;
};

/// Who was swept in this step, and who was held.
///
///   held  bodies, ascending
struct FastBodies {
    std::vector<std::uint32_t> held;
    struct Scratch {
        std::vector<std::uint8_t> flags;  // [bodies] all 0 between stages
    } scratch;
};

/// What touches a collider, as remove_ghost_contacts looks for those that may meet a ghost.
///
///   touches  [colliders] all 0 between stages
struct GhostMarks {
    std::vector<std::uint8_t> touches;
};

/// What contacts of bodies that are carried from touch to touch came to in this step.
///
///   force     [bodies] N on each, friction included, the mean over the step
///   pairs     that may have met in the last span or piece of it
///   touching  of those, that touched
///   points    of those
///   groups    of bodies of which some touched
struct EventDrivenContacts {
    std::vector<Vec3> force;
    std::size_t pairs = 0, touching = 0, points = 0, groups = 0;
};

// The finder of pairs, as one thing among the data: it remembers from step to step.
struct Finder {
    AnyPairFinder finder;
};

template <class Real>
using StepData = std::tuple<StepContext,
                            NarrowPhaseParameters,
                            ImpactParameters,
                            SolverParameters,
                            SleepParameters,
                            NeglectParameters,
                            Shapes,
                            Surfaces,
                            PairFilter,
                            PrescribedVelocities,
                            Forces,
                            EffectCensus,
                            Poses,
                            Velocities,
                            Masses,
                            BodyStates,
                            SleepingIslands,
                            Colliders,
                            Bounds,
                            Finder,
                            Pairs,
                            ConvexContacts<Real>,
                            MethodPairs,
                            MeshContacts<Real>,
                            SolidContacts<Real>,
                            SleepingPairs,
                            SleepingContacts<Real>,
                            RestingBodies,
                            GhostMarks,
                            ExternalAcceleration,
                            Flights,
                            ActiveContacts,
                            JoinedContacts<Real>,
                            IslandFinder,
                            Islands,
                            OverloadedIslands,
                            ConstraintGraph,
                            Layout,
                            ContactConstraints<Real>,
                            SplitImpulse,
                            NeglectedEffects,
                            EventDrivenContacts,
                            StepDiagnostics,
                            TouchingPairs,
                            SleepEvents,
                            FastBodies>;

}  // namespace throng
