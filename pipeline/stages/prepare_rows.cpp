// Prepare rows: bodies into what the solver walks, and room for the rows of their contacts.
#include "kernels/math/rotation.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr std::size_t kBodies = 256;  // a block: some 20 microseconds of work

template <class Real>
void seat_body(std::uint32_t body,
               const Poses& poses,
               const Velocities& velocities,
               const Masses& masses,
               const BodyStates& states,
               SolverBody<Real>& seat)
{
    seat = {};
    seat.drift[7] = 1;
    if (body == kNobody) return;
    for (int k = 0; k < 3; ++k) {
        seat.motion[k] = static_cast<Real>(velocities.linear[body][k]);
        seat.motion[4 + k] = static_cast<Real>(velocities.angular[body][k]);
    }
    if (!states.dynamic(body)) return;
    const Sym3 six = in_world_axes(masses.inverse_inertia[body], poses.orientation[body]);
    const double numbers[7] = {
        masses.inverse_mass[body], six.xx, six.yy, six.zz, six.xy, six.xz, six.yz};
    for (int k = 0; k < 7; ++k) seat.inertia[k] = static_cast<Real>(numbers[k]);
}

template <class Real>
void seat_inertia(std::uint32_t body,
                  const Poses& poses,
                  const Masses& masses,
                  const BodyStates& states,
                  SpinInertia<Real>& seat)
{
    seat = {};
    if (body == kNobody || !states.dynamic(body) || masses.spins_unevenly[body] == 0) return;
    const Sym3 six = in_world_axes(masses.inertia[body], poses.orientation[body]);
    const double trace = six.xx + six.yy + six.zz;
    const double numbers[6] = {six.xx, six.yy, six.zz, six.xy, six.xz, six.yz};
    for (int k = 0; k < 6; ++k) seat.share[k] = static_cast<Real>(numbers[k] / trace);
    seat.share[6] = 1;
    const Vec3& own = masses.symmetry_axis[body];
    if (own.isZero(0)) return;
    const Vec3 axis = poses.orientation[body] * own;
    const double about = own.dot(Vec3(masses.inertia[body].matrix() * own));
    for (int k = 0; k < 3; ++k) seat.axis[k] = static_cast<Real>(axis[k]);
    seat.axis[3] = static_cast<Real>(2 * about / (trace - about));
}

template <class Real>
void seat_pull(std::uint32_t body,
               const Pulls& pulls,
               const BodyStates& states,
               SolverPull<Real>& seat)
{
    seat = {};
    if (body == kNobody || !states.movable(body)) return;
    for (int k = 0; k < 3; ++k) {
        seat.rate[k] = static_cast<Real>(pulls.linear[body][k]);
        seat.rate[4 + k] = static_cast<Real>(pulls.angular[body][k]);
    }
}

// Whether anybody turns who would carry what is as light as any, and as easily turned.
template <class Real>
bool anybody_carries(const std::vector<SolverBody<Real>>& bodies, double dt)
{
    const auto turns = [](const SolverBody<Real>& body) {
        return body.motion[4] != 0 || body.motion[5] != 0 || body.motion[6] != 0;
    };
    // The first that moves says so, but in a crowd of those that never turn.
    if (std::none_of(bodies.begin(), bodies.end(), turns)) return false;
    Ease lightest;
    for (const SolverBody<Real>& body : bodies) {
        const Ease ease = ease_of(body);
        lightest = {std::max(lightest.of_moving, ease.of_moving),
                    std::max(lightest.of_turning, ease.of_turning)};
    }
    return std::any_of(bodies.begin(), bodies.end(), [&](const SolverBody<Real>& body) {
        // Most are told by a number or two.
        if (!turns(body)) return false;
        const double ease{body.inertia[0]};
        return !(ease > 0 && ease * kHeavier > lightest.of_moving) && carries(body, lightest, dt);
    });
}

template <class Real>
void seat_drive(const DriveVelocity& velocity,
                const SolverBody<Real>& body,
                SolverDrive<Real>& drive)
{
    for (std::size_t k = 0; k < 3; ++k) {
        const bool free = std::isnan(velocity[k]);
        drive.number[k] = free ? Real(0) : static_cast<Real>(velocity[k]);
        drive.number[4 + k] = free ? Real(0) : Real(1);
    }
    drive.number[3] = ease_of(body).of_turning > 0 ? Real(1) : Real(0);
}

// Drives of those that contacts push. Of nobody else does friction ask.
template <class Real>
void prepare_drives(const Drives& drives, const Layout& layout, Rows<Real>& rows)
{
    rows.drives.clear();
    const auto slot = [&](std::uint32_t body) {
        return body < layout.slot.size() ? layout.slot[body] : Layout::kNoSlot;
    };
    if (std::none_of(drives.body.begin(), drives.body.end(),
                     [&](std::uint32_t body) { return slot(body) != Layout::kNoSlot; }))
        return;
    rows.drives.assign(rows.bodies.size(), SolverDrive<Real>{});
    for_each_block(drives.body.size(), kBodies, [&](auto begin, auto end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i)
            if (const std::uint32_t at = slot(drives.body[i]); at != Layout::kNoSlot)
                seat_drive(drives.velocity[i], rows.bodies[at], rows.drives[at]);
    });
}

}  // namespace

template <class Real>
void prepare_rows(const Conditions& conditions,
                  const Layout& layout,
                  const Poses& poses,
                  const Velocities& velocities,
                  const Masses& masses,
                  const BodyStates& states,
                  const Pulls& pulls,
                  const Drives& drives,
                  Rows<Real>& rows)
{
    const bool forced = conditions.effects.meets(kForces);
    const bool gyroscopic = conditions.has(Effect::gyroscopic);
    rows.bodies.resize(layout.body_of_slot.size());
    rows.inertias.resize(gyroscopic ? rows.bodies.size() : 0);
    rows.pulls.resize(forced ? rows.bodies.size() : 0);
    const auto seat = [&](std::uint32_t body, std::size_t slot) {
        seat_body(body, poses, velocities, masses, states, rows.bodies[slot]);
        if (gyroscopic) seat_inertia(body, poses, masses, states, rows.inertias[slot]);
        if (forced) seat_pull(body, pulls, states, rows.pulls[slot]);
    };
    seat(kNobody, 0);
    // In order of bodies, of which many arrays are read; that of slots may be any other.
    const std::size_t bodies = layout.slot.size();
    for_each_block(bodies, kBodies, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (auto body = static_cast<std::uint32_t>(begin); body < end; ++body)
            if (layout.slot[body] != Layout::kNoSlot) seat(body, layout.slot[body]);
    });
    for (std::size_t slot = layout.dynamic + std::size_t{1}; slot < rows.bodies.size(); ++slot)
        seat(layout.body_of_slot[slot], slot);

    const std::size_t blocks = layout.points.size();
    rows.blocks.resize(blocks);
    rows.first_point.resize(blocks);
    std::uint32_t points = 0;
    for (std::size_t i = 0; i < blocks; ++i) {
        rows.first_point[i] = points;
        points += layout.points[i];
    }
    rows.points.resize(points);
    rows.bounces.resize(conditions.has(Effect::restitution) ? blocks : 0);
    rows.carry_turns = anybody_carries(rows.bodies, conditions.settings.dt);
    if (conditions.has(Effect::drive))
        prepare_drives(drives, layout, rows);
    else
        rows.drives.clear();
    rows.carries.resize(rows.carry_turns || !rows.drives.empty() ? blocks : 0);
    rows.grips.resize(conditions.grips_apart() ? points : 0);
    rows.rollings.resize(conditions.has(Effect::rolling_friction) ? blocks : 0);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void prepare_rows<Real>(const Conditions&, const Layout&, const Poses&,               \
                                     const Velocities&, const Masses&, const BodyStates&,          \
                                     const Pulls&, const Drives&, Rows<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
