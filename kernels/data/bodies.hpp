// Bodies: arrays, one per quantity, with one index for all of them.
//
// The index of a body is its id: where it stands among the bodies as they were stated. A removed
// body leaves a gap that the next one fills, with another generation.
#pragma once

#include "kernels/data/shapes.hpp"
#include "kernels/math/principal_inertia.hpp"
#include "throng/math.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace throng {

inline constexpr std::uint32_t kNoBody = 0xffffffffu;

/// True for what a step can hold, of any quantity of a body: finite, with squares that fit float.
/// Far beyond what a scene may state (see scene_rules.hpp); a body that gets here is lost.
inline bool holdable(const Vec3& v)
{
    constexpr double kMost = 1e16;
    return std::abs(v.x()) < kMost && std::abs(v.y()) < kMost && std::abs(v.z()) < kMost;
}

/// All that a step gives a body: where its center of mass is and how its axes are turned; its
/// velocity, m/s; its spin in world axes, rad/s.
struct BodyMotion {
    Vec3 position;
    Quat orientation;
    Vec3 linear, angular;
};

inline bool holdable(const BodyMotion& of)
{
    return holdable(of.position) && of.orientation.coeffs().allFinite() && holdable(of.linear)
        && holdable(of.angular);
}

/// Where each body's center of mass is and how its axes are turned.
struct Poses {
    std::vector<Vec3> position;
    std::vector<Quat> orientation;

    Pose at(std::size_t body) const { return {position[body], orientation[body]}; }
};

/// Of the center of mass, m/s; about it in world axes, rad/s.
struct Velocities {
    std::vector<Vec3> linear;
    std::vector<Vec3> angular;
};

/// Gives a body its new motion. False, and the body as it was, where a step cannot hold that.
inline bool
give_motion(const BodyMotion& motion, std::size_t body, Poses& poses, Velocities& velocities)
{
    if (!holdable(motion)) return false;
    poses.position[body] = motion.position;
    poses.orientation[body] = motion.orientation;
    velocities.linear[body] = motion.linear;
    velocities.angular[body] = motion.angular;
    return true;
}

/// What resists motion. Zero inverses do not move, or do not turn.
struct Masses {
    std::vector<double> mass;           // kg; 0 for a body that is not dynamic
    std::vector<double> inverse_mass;   // 1/kg
    std::vector<Sym3> inertia;          // kg m2 about the center, body axes
    std::vector<Sym3> inverse_inertia;  // 1/(kg m2), body axes
    // 1 where principal moments differ, so that a gyroscopic torque acts; 2 where, besides, the
    // body's axes are not the principal ones.
    std::vector<std::uint8_t> inertia_kind;
    // The same of those in whom this step does not neglect that torque, else 0.
    std::vector<std::uint8_t> gyroscopic_kind;
    // Of the square of the spin: no greater angular acceleration comes of that torque.
    std::vector<float> gyroscopic_rate;
    // Of those, body axes: the one about which the inertia is all but symmetric, as of rods, discs
    // and needles of any kind; zero where there is none.
    std::vector<Vec3> symmetry_axis;
    // Of bodies whose axes are not the principal ones, up to the last such: to find these takes
    // longer than to fly by them.
    std::vector<PrincipalInertia> principal;

    PrincipalInertia principal_of(std::size_t body) const
    {
        const Sym3& own = inertia[body];
        return own.has_products() && body < principal.size() ? principal[body]
                                                             : principal_inertia(own);
    }
};

/// m/s along each axis; not a number where it is free.
using PrescribedVelocity = std::array<double, 3>;

/// Velocities that the user sets before every step.
struct PrescribedVelocities {
    std::vector<std::uint32_t> body;  // ascending
    std::vector<PrescribedVelocity> velocity;
    std::vector<std::uint8_t> is_driven;  // [bodies] 1 of those; may be shorter

    bool drives(std::uint32_t who) const { return who < is_driven.size() && is_driven[who] != 0; }
    /// Null for who is not driven.
    const PrescribedVelocity* of(std::uint32_t who) const
    {
        return drives(who) ? &velocity[place_of(who)] : nullptr;
    }
    void put(std::uint32_t who, const PrescribedVelocity& wanted)
    {
        const auto at = static_cast<std::ptrdiff_t>(place_of(who));
        velocity.insert(velocity.begin() + at, wanted);
        body.insert(body.begin() + at, who);
        if (is_driven.size() <= who) is_driven.resize(who + std::size_t{1}, 0);
        is_driven[who] = 1;
    }
    void erase(std::uint32_t who)
    {
        if (!drives(who)) return;
        const auto at = static_cast<std::ptrdiff_t>(place_of(who));
        velocity.erase(velocity.begin() + at);
        body.erase(body.begin() + at);
        is_driven[who] = 0;
    }

private:
    std::size_t place_of(std::uint32_t who) const
    {
        return static_cast<std::size_t>(std::lower_bound(body.begin(), body.end(), who)
                                        - body.begin());
    }
};

enum class BodyKind : std::uint8_t { removed, static_, kinematic, dynamic };

/// Who moves, so that a step need not look at all who sleep. Ascending.
struct ActiveBodies {
    std::vector<std::uint32_t> dynamic, kinematic;

    bool none() const { return dynamic.empty() && kinematic.empty(); }
};

/// How each body takes part.
struct BodyStates {
    std::vector<BodyKind> kind;
    std::vector<std::uint8_t> awake;        // dynamic or kinematic, and not asleep
    std::vector<std::uint8_t> quarantined;  // turned non-finite once; stands still since
    std::vector<double> sleep_time;         // s, how long it has been slower than the limit
    std::vector<std::uint32_t>
        sleeping_island;         // the group it fell asleep with; kNoBody while awake
    std::vector<double> radius;  // m, furthest point of its shapes from its center

    std::vector<std::uint8_t> is_conveyor;  // still, and its surface is driven; may be shorter
    bool conveyors = false;                 // some body is one, or was

    std::vector<std::uint8_t> fast;  // marked so by the user; may be shorter

    ActiveBodies active_bodies;  // as of the start of the step: who wakes in it is there from the
                                 // next one on

    bool moves(std::size_t body) const { return awake[body] != 0; }
    /// A conveyor: it stays where it is and carries what lies on it.
    bool carries(std::size_t body) const
    {
        return body < is_conveyor.size() && is_conveyor[body] != 0
            && kind[body] == BodyKind::static_;
    }
    bool dynamic(std::size_t body) const { return kind[body] == BodyKind::dynamic; }
    bool marked_fast(std::size_t body) const { return body < fast.size() && fast[body] != 0; }
    /// Asleep; of who touches somebody awake, by itself: see RestingBodies.
    bool rests(std::size_t body) const { return dynamic(body) && !moves(body); }
    /// Whether a contact can push it.
    bool movable(std::size_t body) const { return dynamic(body) && moves(body); }
};

/// Lists all active bodies afresh.
void list_active_bodies(BodyStates& states);
/// The same after a step: some of them may have stopped, and these awoke (ascending, dynamic).
void update_active_bodies(const std::vector<std::uint32_t>& woke, BodyStates& states);

/// Bodies that fell asleep together and wake together.
struct SleepingIslands {
    std::vector<std::vector<std::uint32_t>> bodies;  // ascending; empty: a free place
    std::vector<std::uint32_t> free;
};

/// Shapes placed on bodies. A compound body has several, one after another. The place of a
/// collider is its id; a removed one leaves a gap (body kNoBody) that is filled again.
struct Colliders {
    std::vector<std::uint32_t> body;
    std::vector<ShapeRef> shape;
    std::vector<Pose> local;  // in the frame of the center of mass, body axes
    std::vector<std::uint32_t> material;
    std::vector<double> inner_extent;         // m, smallest half extent
    std::vector<double> outer_radius;         // m, furthest point from the body's center of mass
    std::vector<std::uint32_t> begin, count;  // [bodies] the colliders of each
    // [bodies] what their shapes are: not convex, or about another point than the body's, so that
    // it may hang; flat somewhere; with rims to roll on (see turning_arms.hpp); round along a line;
    // anything but a ball about the body's center.
    std::vector<std::uint8_t> shape_bits;
    static constexpr std::uint8_t kMayHang = 1, kFlat = 2, kRim = 4, kRound = 8, kOffCenter = 16;
    bool compounds = false;  // some body has several, or had

    std::size_t size() const { return body.size(); }
};

/// What surfaces do when they meet.
struct Surfaces {
    struct MaterialPair {
        double friction = 0, restitution = 0, rolling_friction = 0;
    };
    std::vector<double> friction, restitution, rolling_friction;  // [materials]

    struct Override {
        std::uint32_t a = 0, b = 0;  // a <= b; sorted
        MaterialPair materials;
    };
    std::vector<Override> overrides;

    /// Geometric mean of the frictions, greater restitution, unless overridden.
    MaterialPair between(std::uint32_t a, std::uint32_t b) const;
};

}  // namespace throng
