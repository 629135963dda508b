// Contact constraints: contacts as the solver sees them, 16 side by side, in the order in which
// they are solved.
//
// A block is an array of structs of arrays: each quantity holds 16 numbers, one a lane, so that the
// same layout serves registers of any width. The lanes of a block share no movable body. A lane
// that is not in use has the still body on both sides and zero masses.
#pragma once

#include "kernels/data/islands.hpp"
#include "kernels/parallel/wavefront.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace throng {

inline constexpr int kBlock = 16;

/// Who is driven walks on what faces up by this at least, as a cosine: what is steeper than 45
/// degrees is a wall, and friction that went along with the drive would climb it.
inline constexpr double kSteepestWalk = 0.7;
/// Least square of the share of a normal that is free of the drive, for a walk up a slope.
inline constexpr double kLeastFreeWalk = 0.25;

/// Least lever arm of a contact, as a share of its arm, by which who cannot be moved, only turned,
/// gives way to a push along the normal. Next to below its center there is none to speak of: pushed
/// there, a body would spin without end and part by nothing. Where neither can be moved, half of
/// what a point gives way or more has to come by lever arms.
inline constexpr double kLeastLeverArm = 1e-2;

/// Of a rolling body's axis that turns farther in a step nothing is told, rad: contacts of the
/// step's beginning say nothing of where it rolls by then.
inline constexpr double kFarthestAxisTurn = 0.2;

/// What the solver knows of one body, in four lines of eight numbers.
///
///   motion      velocity, 0, angular velocity, 0; the latter of what has a GyroscopicInertia in
///               axes that go with it (see spin_frame), so that its inertia stays what it was
///   delta_pose  how far it moved since the step began (3), 1 once it ran away (see begin_substep)
///               and else 0, and its turn as a quaternion x, y, z, w
///   inertia     inverse mass, inverse inertia in world axes as of the step's beginning xx, yy, zz,
///               xy, xz, yz, and 1 where gravity acts in halves, before a body moves and after (see
///               StateDependentForces), else 0
///   free        `motion` as it would be in this substep without any contact
template <class Real>
struct SolverBody {
    alignas(64) Real motion[8];
    Real delta_pose[8];
    Real inertia[8];
    Real free[8];
};

/// What turning a body takes, for the gyroscopic torque, in world axes as of the step's beginning,
/// or as take_axes_anew() last found them.
///
///   share  inertia as a share of its trace, xx, yy, zz, xy, xz, yz; 1 where the torque acts; 0
///   axis   the axis that the inertia is symmetric about (3), the moment about it as a share of
///          that across; zeros where there is none such; and the turn since the step began, x, y,
///          z, w, from which on the body's spin is in axes that go with it
template <class Real>
struct GyroscopicInertia {
    alignas(64) Real share[8] = {};
    Real axis[8] = {0, 0, 0, 0, 0, 0, 0, 1};
};

/// The rims of a cylinder, on which it may roll.
///
///   axis      as the step began
///   radius    m; 0: the body has none, or none that is followed
///   contacts  of the body
struct RoundRim {
    double axis[3] = {0, 0, 1};
    double radius = 0;
    std::uint32_t contacts = 0;
};

/// What forces add to a body's motion, as SolverBody::motion has it, a second.
template <class Real>
struct SolverAcceleration {
    alignas(32) Real rate[8];
};

/// How a body is driven, if it is and contacts push it; see driven_contacts.hpp.
///
///   number  the speed wanted along x, y, z, 0 where that is free; 1 if the body can turn; 1 along
///           x, y, z that are not free, 0 that are, and 0
template <class Real>
struct SolverPrescribedVelocity {
    alignas(32) Real number[8];
};

/// One number a lane.
template <class Real>
struct alignas(64) Lane16 {
    Real at[kBlock];
};

/// A point of 16 contacts. lever_arm[0] is its distance from the center of its contact along
/// the second tangent, lever_arm[1] against the first: its normal velocity is
/// vn + lever_arm[0] w1 + lever_arm[1] w2, and an impulse on it has these torques about the
/// tangents.
template <class Real>
struct ContactPointWide {
    Lane16<Real> lever_arm[2];     // m
    Lane16<Real> center_distance;  // m, its distance from the center, for the twist
    Lane16<Real> separation;       // m, separation as of the step's beginning
    Lane16<Real> mass;             // kg, effective along the normal; 0: no such point
    Lane16<Real> impulse;          // N s, total
};

/// 16 contacts of up to four points each, as the solver sees them: in the axes of the contact, the
/// normal and two tangents, all that the two bodies do to one another is six numbers, the relative
/// velocity at the center of the points, of round sides of what they bear (vn, v1, v2) and the
/// relative spin (w1, w2, wn). Friction acts once a contact, at that center.
///
///   axis_turns_a, _b  bit a lane: that side rolls below its axis, which turns enough to be seen
///                     and its spin with it (see spin_frame)
///   inverse_mass  what an impulse or angular impulse at the center does to the six, symmetric: nn,
///                 n1, n2, 11, 12, 22 among the velocities; then the three spins w1, w2, wn against
///                 n, 1, 2 each; then 11, 22, nn, 12, 1n, 2n among the spins
template <class Real>
struct ContactConstraintWide {
    std::int32_t a[kBlock], b[kBlock];  // places among the solver bodies
    std::uint16_t writes_a, writes_b;   // bit a lane: that body may be changed
    std::uint16_t axis_turns_a, axis_turns_b;
    std::int32_t points;        // greatest number of points of a lane
    std::uint32_t first_point;  // place of the first among ContactConstraints::points
    Lane16<Real> normal[3];
    Lane16<Real> tangent[3];  // the other tangent is normal x tangent
    Lane16<Real> center_a[3], center_b[3];
    Lane16<Real> round_a, round_b;      // m, of sides that look the same however they are turned
    Lane16<Real> friction;              // coefficient
    Lane16<Real> friction_mass[3];      // inverse of the 2x2 matrix at the center: 11, 22, 12
    Lane16<Real> sliding_mass;          // 1 / its greatest eigenvalue: keeps the cone round
    Lane16<Real> sliding_inverse_mass;  // that eigenvalue, 1/kg: the speed that an impulse gives
    Lane16<Real> friction_impulse[2];
    Lane16<Real> bias_rate, impulse_scale;  // softness, see contact_packing.hpp
    Lane16<Real> inverse_deep;              // 1/m, of the overlap from which a contact turns rigid
    Lane16<Real> inverse_mass[21];
    Lane16<Real> torsional_mass, torsional_impulse;
};

/// What restitution needs of 16 contacts.
template <class Real>
struct RestitutionWide {
    Lane16<Real> restitution;  // coefficient
    Lane16<Real> least_speed;  // m/s: who comes in slower rests here, whatever is slow elsewhere
    Lane16<Real>
        impulse[3];  // N s on b in all impacts of the step: along the normal, tangent, other
};

/// What resisting to roll needs of 16 contacts.
template <class Real>
struct RollingFrictionWide {
    Lane16<Real> rolling;     // coefficient, m
    Lane16<Real> mass;        // kg m2
    Lane16<Real> impulse[3];  // N m s on b, along tangent, other tangent, normal
};

/// Friction at a point of 16 contacts, in the plane of their centers.
template <class Real>
struct PointFrictionWide {
    Lane16<Real> impulse[2];  // N s on b, along tangent, other tangent
};

/// 16 contacts as the step began, of which some go with their bodies within it: see
/// turning_arms.hpp. The first three are as ContactConstraintWide has them.
///
///   lanes           bit a lane: it is one of them; the others have nothing here
///   flat_a, flat_b  bit a lane: a flat side of that body rolls on a round one, or a rim on it
///   rims            bit a lane: what rolls there is a rim
template <class Real>
struct TurningArmsWide {
    std::uint16_t lanes = 0, flat_a = 0, flat_b = 0, rims = 0;
    Lane16<Real> normal[3], tangent[3];
    Lane16<Real> center_a[3], center_b[3];
    Lane16<Real> center_offset[3];  // m, from b's center of mass to a's
    Lane16<Real> beyond[4];         // m, what the points are further apart than their middle
    // m, the centers as they are now. In all digits: a load whose arm on a needle moved by the last
    // one of float would spin it.
    Lane16<double> now_a[3], now_b[3];
};

/// What surfaces that go do to the sliding of 16 contacts within the step. Constraints see arms as
/// the step began, by which a body that a plate carries leaves it along the tangent; spins in axes
/// that go with a body (see spin_frame), by which a wheel that rolls round a curve slides; and they
/// do not know of who walks (see driven_contacts.hpp).
///
///   by_a, by_b  whose material the place of the contact goes with, as shares; zeros where nothing
///               that turns carries anything
///   range_a, _b m2, see range_of(); past there nothing is carried any more: from twice its arm on
///               friction makes more of a slip than it takes
///   speed       m/s, along tangent, other tangent: of b against a where the contact is in the
///               middle of the substep, less what arms and spins as they stand have it; of
///               who walks the opposite of its walk
template <class Real>
struct SurfaceVelocityWide {
    Lane16<Real> by_a, by_b;
    Lane16<Real> range_a, range_b;
    Lane16<Real> speed[2];
    bool carries = false;  // some lane of it
};

/// Where a lane came from, to give its impulses back.
struct LaneSource {
    std::uint32_t entry = 0xffffffffu;  // place in ActiveContacts; none for an idle lane
};

/// A run of blocks that share no body, solved in any order or at once.
struct Color {
    std::uint32_t first = 0, count = 0;  // blocks
    bool serial = false;                 // its blocks do share bodies: one after another
};

/// A part of a batch. Its contacts touch its own bodies and those of the next slice of the batch,
/// and nobody else's.
struct Slice {
    std::uint32_t first_body = 0, dynamic = 0;  // solver bodies that can be moved
    std::uint32_t first_kinematic_copy = 0,
                  kinematic = 0;  // copies of those that move by themselves
    std::uint32_t first_color = 0, colors = 0;
    std::uint32_t first_contact = 0, contacts = 0;  // in Layout::contacts
};

/// What an island is solved with: so many times the substeps that the settings say, or exactly; and
/// whether contacts are held to making no energy (see energy_limiter.hpp).
struct Effort {
    std::uint8_t times = 1;
    bool direct = false;
    bool limited = false;

    bool operator==(const Effort&) const = default;
};

/// What is solved together: some small islands, or one big one.
struct Batch {
    std::uint32_t first_slice = 0, slices = 0;
    std::uint32_t first_island = 0, islands = 0;
    std::uint32_t contacts = 0, on_faces = 0;  // how many, and how many of three points or four
    bool wide = false;                         // big: all threads share it
    bool direct = false;                       // one island, for the direct solver
    std::uint8_t times = 1;                    // as many substeps as the settings say
    bool limited = false;                      // contacts are held to making no energy
    IslandCalls calls;                         // of each of its islands
};

/// Which contact goes into which lane, and which body is which solver body: first the still one,
/// which stands for all that never moves; then those that can be moved; then copies of others.
struct Layout {
    static constexpr std::uint32_t kNoSolverIndex = 0xffffffffu;

    std::vector<Batch> batches;
    std::vector<Slice> slices;
    std::vector<Color> colors;
    std::vector<std::uint32_t> island_begin;  // [islands + 1] among the solver bodies
    std::vector<LaneSource> lanes;            // [blocks * 16]
    std::vector<std::uint8_t> points;         // [blocks] greatest number of points of a lane
    std::vector<std::int32_t> solver_index_a,
        solver_index_b;  // [blocks * 16] places among the solver bodies
    std::vector<std::uint32_t>
        body_of_solver_index;  // [solver bodies] body, or none for the still one
    std::vector<std::uint32_t>
        solver_index;           // by body, of those that can be moved; else kNoSolverIndex
    std::uint32_t dynamic = 0;  // solver bodies that can be moved
    std::vector<std::uint32_t> contacts;  // places in ActiveContacts, slice by slice
    std::vector<std::uint32_t> lane;      // [contacts] where among the lanes each is

    /// From the first block of a slice to behind its last.
    struct Blocks {
        std::size_t begin = 0, end = 0;
    };
    Blocks blocks_of(const Slice& slice) const
    {
        const Color& last = colors[slice.first_color + slice.colors - 1];
        return {colors[slice.first_color].first, std::size_t{last.first} + last.count};
    }
    std::span<const Slice> slices_of(const Batch& batch) const
    {
        return std::span(slices).subspan(batch.first_slice, batch.slices);
    }
    /// Those of a slice that can be moved.
    std::span<const std::uint32_t> bodies_of(const Slice& slice) const
    {
        return std::span(body_of_solver_index).subspan(slice.first_body, slice.dynamic);
    }
    /// Those of a batch that can be moved.
    std::span<const std::uint32_t> bodies_of(const Batch& batch) const
    {
        const std::uint32_t first = island_begin[batch.first_island];
        return std::span(body_of_solver_index)
            .subspan(first, island_begin[batch.first_island + batch.islands] - first);
    }
    /// Which island of a batch a solver body is of that can be moved: its place among them.
    std::size_t island_of(const Batch& batch, std::int32_t solver_index) const
    {
        const auto first = island_begin.begin() + batch.first_island;
        const auto behind = std::upper_bound(first + 1, first + batch.islands,
                                             static_cast<std::uint32_t>(solver_index));
        return static_cast<std::size_t>(behind - first) - 1;
    }
    /// Of a place among the solver bodies.
    bool movable(std::int32_t place) const
    {
        return place > 0 && static_cast<std::uint32_t>(place) <= dynamic;
    }
};

/// The constraints of a step. What is called for is there only where some batch calls for it, and
/// told only of the batches that do.
///
///   first_point         [blocks] place of the first among the points
///   restitutions        [blocks] while restitution acts
///   rolling_frictions   [blocks] while rolling friction acts
///   surface_velocities  [blocks] while something turns that carries what lies on it, a spin goes
///                       along with an axis that turns, or somebody walks
///   turning_arms        [blocks] while somebody moves that may swing
///   prescribed          [bodies] while bodies that contacts push are driven
///   point_frictions     [points] while friction acts at points or within a pyramid
///   inertias            [bodies] while the gyroscopic torque acts
///   precesses           [bodies] likewise: 1 of those on whom it does
///   rims                [bodies] while a cylinder turns
///   accelerations       [bodies] while forces act
///   settled             [bodies] while the direct solver acts: who has its new state already, and
///                       who turned non-finite
template <class Real>
struct ContactConstraints {
    std::vector<std::uint32_t> first_point;
    std::vector<ContactConstraintWide<Real>> blocks;
    std::vector<ContactPointWide<Real>> points;
    std::vector<RestitutionWide<Real>> restitutions;
    std::vector<RollingFrictionWide<Real>> rolling_frictions;
    std::vector<SurfaceVelocityWide<Real>> surface_velocities;
    std::vector<TurningArmsWide<Real>> turning_arms;
    std::vector<SolverPrescribedVelocity<Real>> prescribed;
    std::vector<PointFrictionWide<Real>> point_frictions;
    std::vector<SolverBody<Real>> bodies;
    std::vector<GyroscopicInertia<Real>> inertias;
    std::vector<std::uint8_t> precesses;
    std::vector<RoundRim> rims;
    std::vector<SolverAcceleration<Real>> accelerations;
    enum class Settled : std::uint8_t { no, yes, lost };
    std::vector<Settled> settled;
    /// roomy_steps  in a row, with far more room than constraints
    struct Scratch {
        Wavefront wave;
        int roomy_steps = 0;
    } scratch;
};

}  // namespace throng
