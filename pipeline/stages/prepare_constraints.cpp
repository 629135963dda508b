// Prepare constraints: bodies into what the solver walks, and room for the constraints of their
// contacts.
#include "kernels/math/rotation.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "pipeline/forces/velocity_lag.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace throng {

namespace {

constexpr std::size_t kBodies = 256;  // a block: some 20 microseconds of work

template <class Real>
void fill_body(std::uint32_t body,
               const Poses& poses,
               const Velocities& velocities,
               const Masses& masses,
               const BodyStates& states,
               SolverBody<Real>& out)
{
    out = {};
    out.delta_pose[7] = 1;
    if (body == kNoBody) return;
    for (int k = 0; k < 3; ++k) {
        out.motion[k] = static_cast<Real>(velocities.linear[body][k]);
        out.motion[4 + k] = static_cast<Real>(velocities.angular[body][k]);
    }
    if (!states.dynamic(body)) return;
    const Sym3 six = in_world_axes(masses.inverse_inertia[body], poses.orientation[body]);
    const double numbers[7] = {
        masses.inverse_mass[body], six.xx, six.yy, six.zz, six.xy, six.xz, six.yz};
    for (int k = 0; k < 7; ++k) out.inertia[k] = static_cast<Real>(numbers[k]);
}

template <class Real>
void fill_inertia(std::uint32_t body,
                  const Poses& poses,
                  const Masses& masses,
                  const BodyStates& states,
                  GyroscopicInertia<Real>& out)
{
    out = {};
    if (body == kNoBody || !states.dynamic(body) || masses.gyroscopic_kind[body] == 0) return;
    const Sym3 six = in_world_axes(masses.inertia[body], poses.orientation[body]);
    const double trace = six.xx + six.yy + six.zz;
    const double numbers[6] = {six.xx, six.yy, six.zz, six.xy, six.xz, six.yz};
    for (int k = 0; k < 6; ++k) out.share[k] = static_cast<Real>(numbers[k] / trace);
    out.share[6] = 1;
    const Vec3& own = masses.symmetry_axis[body];
    if (own.isZero(0)) return;
    const Vec3 axis = poses.orientation[body] * own;
    const double about = own.dot(Vec3(masses.inertia[body].matrix() * own));
    for (int k = 0; k < 3; ++k) out.axis[k] = static_cast<Real>(axis[k]);
    out.axis[3] = static_cast<Real>(2 * about / (trace - about));
}

template <class Real>
void fill_acceleration(std::uint32_t body,
                       const ExternalAcceleration& accelerations,
                       const BodyStates& states,
                       SolverAcceleration<Real>& out)
{
    out = {};
    if (body == kNoBody || !states.movable(body)) return;
    for (int k = 0; k < 3; ++k) {
        out.rate[k] = static_cast<Real>(accelerations.linear[body][k]);
        out.rate[4 + k] = static_cast<Real>(accelerations.angular[body][k]);
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
    InverseMass lightest;
    for (const SolverBody<Real>& body : bodies) {
        const InverseMass inverse_mass = inverse_mass_of(body);
        lightest = {std::max(lightest.linear, inverse_mass.linear),
                    std::max(lightest.angular, inverse_mass.angular)};
    }
    return std::any_of(bodies.begin(), bodies.end(), [&](const SolverBody<Real>& body) {
        // Most are told by a number or two.
        if (!turns(body)) return false;
        const double inverse_mass{body.inertia[0]};
        return !(inverse_mass > 0 && inverse_mass * kHeavier > lightest.linear)
            && carries(body, lightest, dt);
    });
}

// Somebody who may hang, or lie with a flat side on a round one.
bool anybody_swings(const Layout& layout, const Shapes& shapes, const Colliders& colliders)
{
    const bool rounds = !shapes.capsules.empty() || !shapes.cylinders.empty();
    const unsigned how = Colliders::kMayHang | (rounds ? Colliders::kFlat : 0u);
    const auto first = layout.body_of_solver_index.begin() + 1;
    return std::any_of(first, first + layout.dynamic,
                       [&](std::uint32_t body) { return (colliders.may_swing[body] & how) != 0; });
}

// Of all that have one, where they are; none where nobody has.
void place_rims(const Layout& layout,
                const Poses& poses,
                const Shapes& shapes,
                const Colliders& colliders,
                std::vector<RoundRim>& rims)
{
    rims.clear();
    if (shapes.cylinders.empty()) return;
    for (std::size_t i = 1; i <= layout.dynamic; ++i) {
        const std::uint32_t body = layout.body_of_solver_index[i];
        if ((colliders.may_swing[body] & Colliders::kRim) == 0) continue;
        rims.resize(layout.body_of_solver_index.size());
        const std::uint32_t collider = colliders.begin[body];
        const Quat turn = poses.orientation[body] * colliders.local[collider].orientation;
        const Vec3 axis = turn * Vec3::UnitZ();
        for (int k = 0; k < 3; ++k) rims[i].axis[k] = axis[k];
        rims[i].radius = shapes.cylinders[colliders.shape[collider].index].radius;
    }
}

// Of those that turn, or touch somebody who does; none where nobody does.
void find_rims(double dt,
               const Layout& layout,
               const Poses& poses,
               const Velocities& velocities,
               const Shapes& shapes,
               const Colliders& colliders,
               std::vector<RoundRim>& rims)
{
    constexpr double kSeen = 1e-4;  // rad, in a step
    // Who is held at more places rolls nowhere: in a heap it would cost a fifth of the step.
    constexpr std::uint32_t kMostContacts = 2;
    place_rims(layout, poses, shapes, colliders, rims);
    if (rims.empty()) return;
    const auto turns = [&](std::size_t i) {
        return i > 0 && i <= layout.dynamic
            && (velocities.angular[layout.body_of_solver_index[i]] * dt).squaredNorm()
            > kSeen * kSeen;
    };
    for (std::size_t place = 0; place < layout.lanes.size(); ++place) {
        if (layout.lanes[place].entry == LaneSource{}.entry) continue;
        const auto a = static_cast<std::size_t>(layout.solver_index_a[place]),
                   b = static_cast<std::size_t>(layout.solver_index_b[place]);
        if (!(rims[a].radius > 0) && !(rims[b].radius > 0)) continue;
        const bool rolls = turns(a) || turns(b);
        for (const std::size_t i : {a, b}) {
            if (!(rims[i].radius > 0)) continue;
            ++rims[i].contacts;
            rims[i].rolls = rims[i].rolls || rolls;
        }
    }
    bool some = false;
    for (RoundRim& rim : rims) {
        if (!rim.rolls || rim.contacts > kMostContacts) rim.radius = 0;
        some = some || rim.rolls;
    }
    if (!some) rims.clear();
}

template <class Real>
void fill_prescribed_velocity(const PrescribedVelocity& velocity,
                              const SolverBody<Real>& body,
                              SolverPrescribedVelocity<Real>& drive)
{
    for (std::size_t k = 0; k < 3; ++k) {
        const bool free = std::isnan(velocity[k]);
        drive.number[k] = free ? Real(0) : static_cast<Real>(velocity[k]);
        drive.number[4 + k] = free ? Real(0) : Real(1);
    }
    drive.number[3] = inverse_mass_of(body).angular > 0 ? Real(1) : Real(0);
}

// Drives of those that contacts push. Of nobody else does friction ask.
template <class Real>
void prepare_prescribed_velocities(const PrescribedVelocities& prescribed,
                                   const Layout& layout,
                                   ContactConstraints<Real>& constraints)
{
    constraints.prescribed.clear();
    const auto solver_index = [&](std::uint32_t body) {
        return body < layout.solver_index.size() ? layout.solver_index[body]
                                                 : Layout::kNoSolverIndex;
    };
    if (std::none_of(prescribed.body.begin(), prescribed.body.end(), [&](std::uint32_t body) {
            return solver_index(body) != Layout::kNoSolverIndex;
        }))
        return;
    constraints.prescribed.assign(constraints.bodies.size(), SolverPrescribedVelocity<Real>{});
    for_each_block(prescribed.body.size(), kBodies, [&](auto begin, auto end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i)
            if (const std::uint32_t at = solver_index(prescribed.body[i]);
                at != Layout::kNoSolverIndex)
                fill_prescribed_velocity(prescribed.velocity[i], constraints.bodies[at],
                                         constraints.prescribed[at]);
    });
}

// Says where the points of each block begin, and how many there are.
template <class Real>
std::uint32_t place_points(const Layout& layout, ContactConstraints<Real>& constraints)
{
    const std::size_t blocks = layout.points.size();
    constraints.first_point.resize(blocks);
    std::uint32_t points = 0;
    for (std::size_t i = 0; i < blocks; ++i) {
        constraints.first_point[i] = points;
        points += layout.points[i];
    }
    return points;
}

// Whose axes turn, who swings or is driven, has the lists that tell of it.
template <class Real>
void make_room(const StepContext& context,
               const SolverParameters& parameters,
               const Layout& layout,
               bool swings,
               ContactConstraints<Real>& constraints)
{
    const std::size_t blocks = layout.points.size();
    const auto when = [](bool asked, std::size_t count) { return asked ? count : 0; };
    const std::uint32_t points = place_points(layout, constraints);
    constraints.blocks.resize(blocks);
    constraints.points.resize(points);
    constraints.restitutions.resize(when(context.has(Effect::restitution), blocks));
    constraints.surface_velocities.resize(
        when(constraints.surfaces_turn || constraints.axes_turn || !constraints.prescribed.empty(),
             blocks));
    constraints.turning_arms.resize(when(swings, blocks));
    constraints.point_frictions.resize(
        when(parameters.friction_at_points_or_pyramid(context.effects), points));
    constraints.rolling_frictions.resize(when(context.has(Effect::rolling_friction), blocks));
}

}  // namespace

template <class Real>
void prepare_constraints(const StepContext& context,
                         const SolverParameters& parameters,
                         const Layout& layout,
                         const Forces& forces,
                         const Poses& poses,
                         const Masses& masses,
                         const BodyStates& states,
                         const Shapes& shapes,
                         const Colliders& colliders,
                         const ExternalAcceleration& accelerations,
                         const PrescribedVelocities& prescribed,
                         Flights& flights,
                         Velocities& velocities,
                         ContactConstraints<Real>& constraints)
{
    lag_velocities(context, forces, masses,
                   std::span(layout.body_of_solver_index).subspan(1, layout.dynamic), flights,
                   velocities);
    const bool forced = context.effects.meets(kForces);
    const bool gyroscopic = context.has(Effect::gyroscopic);
    std::atomic<bool> axes_turn = false;
    constraints.bodies.resize(layout.body_of_solver_index.size());
    constraints.inertias.resize(gyroscopic ? constraints.bodies.size() : 0);
    constraints.accelerations.resize(forced ? constraints.bodies.size() : 0);
    const auto fill = [&](std::uint32_t body, std::size_t solver_index, std::size_t = 0) {
        fill_body(body, poses, velocities, masses, states, constraints.bodies[solver_index]);
        if (gyroscopic) {
            auto& inertia = constraints.inertias[solver_index];
            fill_inertia(body, poses, masses, states, inertia);
            if (!axes_turn && axis_turns(constraints.bodies[solver_index], inertia, context.dt))
                axes_turn = true;
        }
        if (forced)
            fill_acceleration(body, accelerations, states, constraints.accelerations[solver_index]);
    };
    fill(kNoBody, 0);
    SolverBodyBlocks(layout, kBodies).for_each(fill);
    for (std::size_t solver_index = layout.dynamic + std::size_t{1};
         solver_index < constraints.bodies.size(); ++solver_index)
        fill(layout.body_of_solver_index[solver_index], solver_index);

    constraints.surfaces_turn = anybody_carries(constraints.bodies, context.dt);
    constraints.axes_turn = axes_turn && context.has(Effect::friction);
    if (context.has(Effect::drive))
        prepare_prescribed_velocities(prescribed, layout, constraints);
    else
        constraints.prescribed.clear();
    find_rims(context.dt, layout, poses, velocities, shapes, colliders, constraints.rims);
    const bool swings = !constraints.rims.empty() || anybody_swings(layout, shapes, colliders);
    make_room(context, parameters, layout, swings, constraints);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void prepare_constraints<Real>(                                                       \
        const StepContext&, const SolverParameters&, const Layout&, const Forces&, const Poses&,   \
        const Masses&, const BodyStates&, const Shapes&, const Colliders&,                         \
        const ExternalAcceleration&, const PrescribedVelocities&, Flights&, Velocities&,           \
        ContactConstraints<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
