// Swept pairs: who went far in a step, by which way, and whom he may have met on it.
//
// The ways are those from the poses before the step to the poses after it.
#pragma once

#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/ccd/time_of_impact.hpp"
#include "pipeline/step/fast_bodies.hpp"
#include "pipeline/step/stages.hpp"

#include <span>
#include <vector>

namespace throng {

inline constexpr double kNever = 2;  // later than the step

/// Two whose ways cross, a fast one among them.
struct SweptPair {
    PairKey key = 0;
    double time = kNever;        // of their next impact
    Vec3 normal = Vec3::Zero();  // from a to b then
    bool pressed = false;        // they touched before, and contact has not held them
    bool followed = false;       // contacts were looked for ahead of them
};

/// The way of a body from some time on: that of another it has come to ride on, or its own.
struct SweptWay {
    std::uint32_t body = kNoBody;
    RigidTrajectory trajectory;
    Pose attached;                  // the body in the frame that is swept
    std::uint32_t rides = kNoBody;  // on this body
    double since = 0;               // 0 to 1, when it was held
    bool fast = false, held = false;
    bool ahead = false;   // of contacts: those that it may come to were not looked for
    bool slides = false;  // it touches what does not yield to it
};

/// Of one step, after its solver: reads where bodies began and where they have come.
class SweptPairs {
public:
    /// `followed`, `on_meshes`: pairs whose contacts saw ahead, ascending. `flags` is scratch:
    /// [bodies], all 0 before and after.
    SweptPairs(const StepContext& context,
               const ImpactParameters& parameters,
               const Shapes& shapes,
               const Colliders& colliders,
               const PairFilter& filter,
               const Masses& masses,
               const Bounds& bounds,
               const Pairs& pairs,
               const BodyStates& states,
               const Islands& islands,
               std::span<const std::uint32_t> followed,
               std::span<const std::uint32_t> on_meshes,
               const Poses& poses,
               const Velocities& velocities,
               std::vector<std::uint8_t>& flags)
        : context_(context), parameters_(parameters), shapes_(shapes), colliders_(colliders),
          filter_(filter), masses_(masses), bounds_(bounds), pairs_(pairs), states_(states),
          islands_(islands), followed_(followed), on_meshes_(on_meshes), poses_(poses),
          velocities_(velocities), flags_(flags)
    { }

    /// Finds both; `woke`: bodies that woke in this step.
    void find(const std::vector<std::uint32_t>& woke);

    std::vector<SweptPair> pairs;  // by key
    std::vector<SweptWay> ways;    // of all bodies in them, by body

    /// Round all of a collider's way.
    Box3 box_of_way(std::uint32_t at) const;

private:
    Pose began(std::uint32_t body) const;
    bool went_far(std::uint32_t body) const;
    void find_fast(const std::vector<std::uint32_t>& woke);
    bool is_fast(std::uint32_t body) const { return flags_[body] != 0; }
    bool worth_asking(PairKey key) const;
    bool on_mesh(PairKey key) const;
    bool ways_cross(PairKey key) const;
    void find_pairs();
    void look_beyond_box(std::uint32_t at);
    void find_ways();
    SweptWay way_from_start(std::uint32_t body) const;

    const StepContext& context_;
    const ImpactParameters& parameters_;
    const Shapes& shapes_;
    const Colliders& colliders_;
    const PairFilter& filter_;
    const Masses& masses_;
    const Bounds& bounds_;
    const Pairs& pairs_;
    const BodyStates& states_;
    const Islands& islands_;
    std::span<const std::uint32_t> followed_, on_meshes_;
    const Poses& poses_;
    const Velocities& velocities_;
    std::vector<std::uint8_t>& flags_;  // of those that are fast 1
    std::vector<std::uint32_t> found_;  // fast bodies, ascending
};

}  // namespace throng
