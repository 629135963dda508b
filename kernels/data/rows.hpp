// Rows: contacts as the solver sees them, 16 side by side, in the order in which they are solved.
//
// A block is an array of structs of arrays: each quantity holds 16 numbers, one a lane, so that the
// same layout serves registers of any width. The lanes of a block share no movable body. A lane
// that is not in use has slot 0 on both sides (the still body of its batch) and zero masses.
#pragma once

#include <cstdint>
#include <vector>

namespace throng {

inline constexpr int kBlock = 16;

/// What the solver knows of one body, in three lines of eight numbers.
///
///   motion   velocity, 0, angular velocity, 0
///   drift    how far it moved since the step began (3), 1 once it ran away (see stop_runaways) and
///            else 0, and its turn as a quaternion x, y, z, w
///   inertia  inverse mass, inverse inertia in world axes xx, yy, zz, xy, xz, yz, 0
template <class Real>
struct SolverBody {
    alignas(8 * sizeof(Real)) Real motion[8];
    Real drift[8];
    Real inertia[8];
};

/// One number a lane.
template <class Real>
struct alignas(64) Lane16 {
    Real at[kBlock];
};

/// A point of 16 contacts.
template <class Real>
struct PointRows {
    Lane16<Real> from_a[3], from_b[3];  // m, from the centers of mass
    Lane16<Real> gap;                   // m, separation less what the anchors say
    Lane16<Real> mass;                  // kg, effective along the normal; 0: no such point
    Lane16<Real> impulse;               // N s, total
    Lane16<Real> approach;              // m/s, normal velocity before the step; for restitution
    Lane16<Real> greatest;              // N s, greatest impulse of the step
};

/// 16 contacts of up to four points each. Friction acts once a contact, at the middle of its
/// points.
template <class Real>
struct ContactBlock {
    std::int32_t a[kBlock], b[kBlock];  // places among the solver bodies
    std::uint16_t writes_a, writes_b;   // bit a lane: that body may be changed
    std::int32_t points;                // greatest number of points of a lane
    Lane16<Real> normal[3];
    Lane16<Real> tangent[3];        // the other tangent is normal x tangent
    Lane16<Real> round_a, round_b;  // m, of sides that look the same however they are turned
    Lane16<Real> center_a[3], center_b[3];
    Lane16<Real> friction, restitution, rolling;  // coefficients
    Lane16<Real> friction_mass[3];  // inverse of the 2x2 matrix at the center: 11, 22, 12
    Lane16<Real> sliding_mass;      // 1 / its greatest eigenvalue: keeps the cone round
    Lane16<Real> sliding_answer;    // that eigenvalue, 1/kg: the speed that an impulse gives
    Lane16<Real> twist_mass, rolling_mass;
    Lane16<Real> friction_impulse[2], twist_impulse, rolling_impulse[3];
    Lane16<Real> bias_rate, impulse_scale;  // softness, see contact_rows.hpp
    Lane16<Real> inverse_deep;              // 1/m, of the overlap from which a contact turns rigid
    Lane16<Real> reach[4];  // m, each point's distance from the center, for the twist
    PointRows<Real> point[4];
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

/// What one task solves through all substeps: some small islands, or one big one.
struct Batch {
    std::uint32_t first_body = 0;  // solver bodies; the first is the still one
    std::uint32_t dynamic = 0;     // how many follow it that can be moved
    std::uint32_t kinematic =
        0;  // and how many after those that move by themselves; then conveyors
    std::uint32_t first_color = 0, colors = 0;
    std::uint32_t first_block = 0, blocks = 0;
    bool wide = false;  // big: its colors are shared among the threads
};

/// Which contact goes into which lane, and which body is which solver body.
struct Layout {
    std::vector<Batch> batches;
    std::vector<Color> colors;
    std::vector<LaneSource> lanes;             // [blocks * 16]
    std::vector<std::int32_t> slot_a, slot_b;  // [blocks * 16] places among the solver bodies
    std::vector<std::uint32_t> body_of_slot;   // [solver bodies] body, or none for the still one
};

template <class Real>
struct Rows {
    std::vector<ContactBlock<Real>> blocks;
    std::vector<SolverBody<Real>> bodies;
};

}  // namespace throng
