// Solver bodies: what a substep does to them besides contacts.
#pragma once

#include "kernels/data/contact_constraints.hpp"
#include "kernels/math/numbers.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/carried_points.hpp"
#include "throng/math.hpp"

#include <cmath>
#include <span>

namespace throng {

/// The axes, as a turn since the step began, in which the solver has a body's angular velocity.
///
/// Contacts are solved with the inertia that bodies had when the step began. Of what turns equally
/// easily about any axis that is always right. Of a needle it is not: a spin about its length that
/// stayed behind as it tips over would become tumbling, with all the energy that its greater moment
/// makes of it. So what has a GyroscopicInertia has its spin in axes that go with it, in which its
/// inertia stays the same: the body's own or, where that is symmetric about an axis, those that
/// follow this axis on the shortest way and do not take part in the spin about it.
///
///   inertia  null: the body has none, and the axes are those of the world
template <class Real>
Quat spin_frame(const SolverBody<Real>& body, const GyroscopicInertia<Real>* inertia);

/// The same as spin_frame() would have it had the step begun here: what a body has of velocities
/// and inertia is turned into world axes, and goes along with it from here on. Returns the turn.
template <class Real>
Quat take_axes_anew(SolverBody<Real>& body, GyroscopicInertia<Real>* inertia);

/// Turns the bodies that turn by kFastTurn and more in a time, and no other: the exponential map,
/// exact for a constant angular velocity. The wide kernels turn the rest.
///
///   inertias  [bodies], or null
template <class Real>
void turn_fast(std::span<SolverBody<Real>> bodies,
               const GyroscopicInertia<Real>* inertias,
               Real time);

/// Those that can be moved, in blocks: in order of bodies, as many arrays by body are read and
/// written, but where most bodies have no solver body, which then take no time.
class SolverBodyBlocks {
public:
    SolverBodyBlocks(const Layout& layout, std::size_t grain)
        : layout_(layout), grain_(grain),
          few_(std::size_t{layout.dynamic} * kFew < layout.solver_index.size())
    { }

    std::size_t blocks() const { return block_count(size(), grain_); }

    /// Calls each(body, solver index, block).
    template <class Each>
    void for_each(const Each& each) const
    {
        for_each_block(size(), grain_, [&](std::size_t begin, std::size_t end, std::size_t block) {
            for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
                if (few_)
                    each(layout_.body_of_solver_index[i + 1], i + 1, block);
                else if (layout_.solver_index[i] != Layout::kNoSolverIndex)
                    each(i, layout_.solver_index[i], block);
            }
        });
    }

private:
    static constexpr std::size_t kFew = 8;  // one body in so many
    std::size_t size() const { return few_ ? layout_.dynamic : layout_.solver_index.size(); }

    const Layout& layout_;
    std::size_t grain_;
    bool few_;
};

/// True for a body that begin_substep() stopped because its velocity could not be held.
template <class Real>
bool ran_away(const SolverBody<Real>& body)
{
    return body.delta_pose[3] != 0;
}

template <class Real>
InverseMass inverse_mass_of(const SolverBody<Real>& body)
{
    const Real* const inertia = body.inertia;
    return {double{inertia[0]}, double{inertia[1]} + double{inertia[2]} + double{inertia[3]}};
}

/// Whether a body takes another along as it turns, in steps of dt: see carried_points.hpp.
template <class Real>
bool carries(const SolverBody<Real>& carrier, const InverseMass& carried, double dt)
{
    return carries(vector_at(carrier.motion + 4), inverse_mass_of(carrier), carried, dt);
}

/// Whether an axis that a body is symmetric about, and its spin with it (see spin_frame), turns
/// enough in dt to be seen where the body rolls, and less than kFarthestAxisTurn.
inline bool axis_turns(const Vec3& axis, const Vec3& spin, double dt)
{
    constexpr double kSeen = 1e-3;  // rad
    const double about = axis.dot(spin);
    const double squared = (spin.squaredNorm() - about * about) * dt * dt;
    return squared > kSeen * kSeen && squared < kFarthestAxisTurn * kFarthestAxisTurn;
}

/// The same of a body. Who can only turn rolls nowhere.
template <class Real>
bool axis_turns(const SolverBody<Real>& body, const GyroscopicInertia<Real>& inertia, double dt)
{
    return inertia.axis[3] > 0 && body.inertia[0] > 0
        && axis_turns(vector_at(inertia.axis), vector_at(body.motion + 4), dt);
}

/// Whether a body is pushed, along a normal at an arm, straight below the axis that it is symmetric
/// about, and across rather than along it.
template <class Real>
bool rolls_on_axis(const GyroscopicInertia<Real>& inertia, const Vec3& normal, const Vec3& arm)
{
    constexpr double kBeside = 1e-2, kLeastAcross = 0.5;  // of the arm; sine
    const Vec3 side = vector_at(inertia.axis).cross(normal);
    return side.squaredNorm() >= kLeastAcross * kLeastAcross
        && std::abs(side.dot(arm)) <= kBeside * arm.norm();
}

/// How far a body has turned since the step began.
template <class Real>
Quat turn_of(const SolverBody<Real>& body)
{
    return {double{body.delta_pose[7]}, double{body.delta_pose[4]}, double{body.delta_pose[5]},
            double{body.delta_pose[6]}};
}

}  // namespace throng
