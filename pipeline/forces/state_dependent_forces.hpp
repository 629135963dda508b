// State-dependent forces: what changes as bodies go (springs, pivots, attractors, a program's own
// field), asked in each substep, on bodies that contacts may hold. All solvers and responses have
// it from here.
//
// Taken as it was when the step began such a force makes energy at any stiffness: of a swing with
// frequency w a step of n substeps, h each, makes a share (n - 1) n (h w)^2 / 2. Asked in each
// substep before bodies move it makes none, and bodies go as the semi-implicit integrator has them
// in flight; with any other integrator it acts half before they move and half after it, as of then
// (Verlet's rule, of second order).
//
// Who is borne by contacts has all of it before it moves, as gravity comes to all others:
// iterations would have to find half of each load and then the whole of it, substep by substep, and
// a stack would never come to rest. Springs give half after it even there, unless friction holds
// against them, and pivots always: by the two rules velocities are half a substep apart, and who
// swings would lose by each change from one to the other.
//
// Springs that a substep is too long for go by a rule of their own (stiff_springs.hpp), and what
// they pull is moved half before and half after likewise.
//
// Source: Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), I.1.
#pragma once

#include "kernels/dynamics/rigid_motion.hpp"
#include "kernels/dynamics/stiff_springs.hpp"
#include "pipeline/step/step_context.hpp"

namespace throng {

/// Whether springs of bodies that they join go by the rule for stiff ones, where nobody of them
/// flies by an integrator that they asked for: a substep is too long for them, or turns their arms
/// too far.
bool too_stiff(const StepContext& context,
               const RigidFacts& facts,
               std::span<const std::uint32_t> group);
/// The same where they all fly, whatever answers contacts.
bool by_stiff_springs(const StepContext& context,
                      const RigidFacts& facts,
                      std::span<const std::uint32_t> group);

/// A body that such forces act on.
///
///   at                     where whoever asks has it
///   pose, velocity, spin   in: as they are now; of the point that its inertia is about
///   axis, carries          in: how its spin turns it (see BodyTurn)
///   gained, gained_spin    out: to be added to the velocities
struct ForcedBody {
    std::uint32_t body = kNoBody, at = 0;
    Pose pose;
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
    Vec3 axis = Vec3::UnitZ();
    double carries = 1;
    Vec3 gained = Vec3::Zero(), gained_spin = Vec3::Zero();
    // m/s, by find_changes(): what all that acts does, gravity too; and by who knows contacts, what
    // they leave of it, whether they bear the body, and by friction on what does not roll
    Vec3 change = Vec3::Zero();
    Vec3 pressing = Vec3::Zero();  // m/s, likewise, where things bounce: with stiff springs, too
    double left = 0;
    bool borne = false, grips = false;
    Vec3 carried_spin = Vec3::Zero();  // kept by who asks: as of after it moved
    bool late = false;                 // half of what forces give acts after it moved
    bool falls_late = false;           // and half of gravity
    bool stiff = false;
    std::uint32_t place = 0;  // in its law
};

class StateDependentForces {
public:
    /// Those of some bodies, by where they are in the list.
    ///
    ///   facts  as the step began
    StateDependentForces(const StepContext& context,
                         const RigidFacts& facts,
                         std::span<const std::uint32_t> bodies);
    StateDependentForces(const StateDependentForces&) = delete;
    StateDependentForces& operator=(const StateDependentForces&) = delete;

    std::vector<ForcedBody>& forced_bodies() { return forced_bodies_; }
    std::span<const ForcedBody> forced_bodies() const { return forced_bodies_; }
    /// Whether there is any of a kind.
    bool late() const { return late_; }
    bool stiff() const { return !stiff_.empty(); }
    /// Of stiff springs, group by group: the followers that they join, and themselves.
    std::span<const std::vector<std::uint32_t>> joined() const { return members_; }
    const StiffSprings& springs_of(std::size_t group) const { return stiff_[group]; }
    /// J, of all springs on the followers, which are where their poses say.
    double energy_of_springs() const;
    /// s, the longest step that their springs bear where none is stiff by itself.
    double longest_step() const { return longest_; }

    /// Finds what acts on each does in a substep, as the step begins. Poses and velocities are
    /// those of then.
    void find_changes();
    /// m/s, of all bodies the least that acts in a step: slower than twice that is resting, not
    /// bouncing. After find_changes().
    double least_change_of_step() const;
    /// On those that are borne all acts before they move but for what springs give, and that too
    /// where contacts hold against it.
    void bear();
    /// Before bodies move: from velocities to which gravity was added and contacts have done
    /// nothing yet. A substep begins at a time, s since the step began.
    void begin(double time, double span);
    /// Of stiff springs, once contacts have had a say.
    void again();
    /// After bodies moved.
    void end();

private:
    void list(std::span<const std::uint32_t> bodies);
    void find_accelerations(double time, bool fallen);
    void look_stiff();
    void look_stiff_speeds();
    void give_stiff(std::size_t group, std::span<const StiffSprings::Six> change);
    void clear();
    Vec3 fall_of(const ForcedBody& forced) const;
    bool is_held(const ForcedBody& forced) const;

    const StepContext& context_;
    RigidRule rule_;
    RigidFacts facts_;
    RigidMotion soft_law_, stiff_law_;       // with springs and without
    std::vector<ForcedBody> forced_bodies_;  // ascending
    // Of each group its springs, and where each of its bodies is among the followers.
    std::vector<StiffSprings> stiff_;
    std::vector<std::vector<std::uint32_t>> members_;
    bool late_ = false;
    double time_ = 0, span_ = 0, longest_ = 0;
};

}  // namespace throng
