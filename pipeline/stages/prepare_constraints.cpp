// Prepare constraints: bodies into what the solver walks, and room for the constraints of their
// contacts.
#include "kernels/math/rotation.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/parallel/capacity.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "pipeline/forces/velocity_lag.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
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

// Of those that roll, where they are.
void place_rims(const Islands& islands,
                const Layout& layout,
                const Poses& poses,
                const Shapes& shapes,
                const Colliders& colliders,
                std::vector<RoundRim>& rims)
{
    rims.assign(layout.body_of_solver_index.size(), {});
    for (const auto& [body, contacts] : islands.rolling) {
        RoundRim& rim = rims[layout.solver_index[body]];
        rim.contacts = contacts;
        const std::uint32_t collider = colliders.begin[body];
        const Quat turn = poses.orientation[body] * colliders.local[collider].orientation;
        const Vec3 axis = turn * Vec3::UnitZ();
        for (int k = 0; k < 3; ++k) rim.axis[k] = axis[k];
        rim.radius = shapes.cylinders[colliders.shape[collider].index].radius;
    }
}

// What any batch calls for.
IslandCalls called_for(const Layout& layout)
{
    IslandCalls any;
    for (const Batch& batch : layout.batches) {
        any.effects = any.effects | batch.calls.effects;
        any.carries = any.carries || batch.calls.carries;
        any.axes_turn = any.axes_turn || batch.calls.axes_turn;
        any.swings = any.swings || batch.calls.swings;
        any.rolls = any.rolls || batch.calls.rolls;
    }
    return any;
}

// Calls fill(body, solver index) for the solver bodies of batches that call for some of the
// effects, with their copies of others.
void for_bodies_that_call(const Layout& layout, Set<Effect> effects, const auto& fill)
{
    const auto fill_all = [&](std::size_t begin, std::size_t end) {
        for (std::size_t at = begin; at < end; ++at) fill(layout.body_of_solver_index[at], at);
    };
    const auto fill_copies = [&](const Batch& batch) {
        const std::size_t last = batch.first_slice + batch.slices;
        fill_all(layout.slices[batch.first_slice].first_kinematic_copy,
                 last < layout.slices.size() ? layout.slices[last].first_kinematic_copy
                                             : layout.body_of_solver_index.size());
    };
    for_each_block(layout.batches.size(), 1, [&](auto from, auto to, std::size_t) {
        for (std::size_t i = from; i < to; ++i) {
            const Batch& batch = layout.batches[i];
            if (!batch.calls.effects.meets(effects)) continue;
            const std::size_t begin = layout.island_begin[batch.first_island],
                              end = layout.island_begin[batch.first_island + batch.islands];
            for_each_block(end - begin, kBodies, [&](auto first, auto last, std::size_t) {
                fill_all(begin + first, begin + last);
            });
            fill_copies(batch);
        }
    });
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
    const auto solver_index = [&](std::uint32_t body) {
        return body < layout.solver_index.size() ? layout.solver_index[body]
                                                 : Layout::kNoSolverIndex;
    };
    constraints.prescribed.resize(constraints.bodies.size());
    constraints.prescribed[0] = {};
    for_bodies_that_call(layout, {Effect::drive},
                         [&](std::uint32_t, std::size_t at) { constraints.prescribed[at] = {}; });
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

// A crowd that lands has half as many blocks again as when it lies. Room that has been idle for a
// second is given back; not at once, as heaps are torn by what comes and goes.
template <class Real>
void give_back_room(std::size_t blocks, std::size_t points, ContactConstraints<Real>& constraints)
{
    constexpr int kPatience = 60;
    constexpr std::size_t kFew = 16;
    int& roomy = constraints.scratch.roomy_steps;
    roomy = constraints.blocks.capacity() > blocks + blocks / 3 + kFew ? roomy + 1 : 0;
    if (roomy < kPatience) return;
    roomy = 0;
    const auto drop = [](auto&... lists) { (std::decay_t<decltype(lists)>().swap(lists), ...); };
    drop(constraints.blocks, constraints.points, constraints.restitutions,
         constraints.surface_velocities, constraints.turning_arms, constraints.point_frictions,
         constraints.rolling_frictions);
    reserve_closely(constraints.blocks, blocks);
    reserve_closely(constraints.points, points);
}

// Lists that tell of what is called for.
template <class Real>
void make_room(const SolverParameters& parameters,
               const Layout& layout,
               const IslandCalls& calls,
               ContactConstraints<Real>& constraints)
{
    const std::size_t blocks = layout.points.size();
    const auto when = [](bool asked, std::size_t count) { return asked ? count : 0; };
    const std::uint32_t points = place_points(layout, constraints);
    give_back_room(blocks, points, constraints);
    constraints.blocks.resize(blocks);
    constraints.points.resize(points);
    constraints.restitutions.resize(when(calls.effects.has(Effect::restitution), blocks));
    constraints.surface_velocities.resize(when(calls.surfaces_go(), blocks));
    constraints.turning_arms.resize(when(calls.swings, blocks));
    constraints.point_frictions.resize(
        when(parameters.friction_at_points_or_pyramid(calls.effects), points));
    constraints.rolling_frictions.resize(when(calls.effects.has(Effect::rolling_friction), blocks));
}

}  // namespace

template <class Real>
void prepare_constraints(const StepContext& context,
                         const SolverParameters& parameters,
                         const Islands& islands,
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
    lag_velocities(context, forces, masses, layout, flights, velocities);
    const IslandCalls calls = called_for(layout);
    const std::size_t bodies = layout.body_of_solver_index.size();
    resize_closely(constraints.bodies, bodies);
    const auto fill = [&](std::uint32_t body, std::size_t solver_index, std::size_t = 0) {
        fill_body(body, poses, velocities, masses, states, constraints.bodies[solver_index]);
    };
    fill(kNoBody, 0);
    SolverBodyBlocks(layout, kBodies).for_each(fill);
    for (std::size_t at = layout.dynamic + std::size_t{1}; at < bodies; ++at)
        fill(layout.body_of_solver_index[at], at);

    const bool gyroscopic = calls.effects.has(Effect::gyroscopic);
    resize_closely(constraints.inertias, gyroscopic ? bodies : 0);
    constraints.precesses.assign(gyroscopic ? bodies : 0, 0);
    const auto fill_inertia_of = [&](std::uint32_t body, std::size_t solver_index) {
        auto& inertia = constraints.inertias[solver_index];
        fill_inertia(body, poses, masses, states, inertia);
        constraints.precesses[solver_index] = inertia.share[6] > 0 ? 1 : 0;
    };
    if (gyroscopic) {
        fill_inertia_of(kNoBody, 0);
        for_bodies_that_call(layout, {Effect::gyroscopic}, fill_inertia_of);
    }
    const bool forced = calls.effects.meets(kForces);
    constraints.accelerations.resize(forced ? bodies : 0);
    if (forced)
        for_bodies_that_call(layout, kForces, [&](std::uint32_t body, std::size_t solver_index) {
            fill_acceleration(body, accelerations, states, constraints.accelerations[solver_index]);
        });
    if (calls.effects.has(Effect::drive))
        prepare_prescribed_velocities(prescribed, layout, constraints);
    else
        constraints.prescribed.clear();
    if (calls.rolls)
        place_rims(islands, layout, poses, shapes, colliders, constraints.rims);
    else
        constraints.rims.clear();
    make_room(parameters, layout, calls, constraints);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void prepare_constraints<Real>(                                                       \
        const StepContext&, const SolverParameters&, const Islands&, const Layout&, const Forces&, \
        const Poses&, const Masses&, const BodyStates&, const Shapes&, const Colliders&,           \
        const ExternalAcceleration&, const PrescribedVelocities&, Flights&, Velocities&,           \
        ContactConstraints<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
