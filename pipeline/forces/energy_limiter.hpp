// Energy limiter: bodies start a substep with no more than serves them of what contacts gave in the
// last one; and those that stiff springs press on others end it with no more energy than they had.
//
// Contacts start with what they gave in the substep before, and few iterations do not take back
// what is too much by then. Where a column has just landed they give the blow once more and throw
// it apart: 30 slabs by pgs at twice the speed of their fall. Where a stiff spring turned a body
// round meanwhile, a needle between a box and the floor spins at thousands of rad/s before a single
// contact is looked at. So bodies start from that share of their impulses by which their kinetic
// energy is least: all of them at rest, next to none after a blow. What friction and springs make
// of one another in the iterations that follow is held against what was there, in motion and in
// springs, and against the fall: what is too much is taken from the motion.
//
// Of soft_step only after a blow: one iteration follows, and a tower stands by what its contacts
// remember. From then on, and by finer substeps always, contacts may in no substep leave more
// energy than there would be without them: who is spun far round within a step, in rows that are
// of its beginning, gains by each substep a few hundredths of what he has. Of those with somebody
// who can only turn neither is ever more: by a short lever arm he is pushed with all that turning
// far takes, and relaxed so slowly that a push out of overlap stays with him as spin.
//
// Source: the kinetic energy is what Gauss-Seidel sweeps over inelastic contacts bring down
// (Moreau, Quadratic programming in mechanics: dynamics of one-sided constraints, 1966); along the
// impulses it is a parabola.
#pragma once

#include "kernels/parallel/disjoint_sets.hpp"
#include "pipeline/forces/state_dependent_forces.hpp"
#include "pipeline/step/step_data.hpp"

#include <functional>
#include <span>
#include <utility>

namespace throng {

/// Whether more than springs and gravity may give energy to a body.
bool is_fed(const Forces& forces, std::uint32_t body);

/// By what share of it bodies are to move, beside what they go by together, once energy is taken
/// that was gained, J: 1 where that is next to nothing.
///
///   among_them  J, of motion, without what they go by together
///   rounding    J, that rounding may make of all of it
double share_kept(double gained, double among_them, double rounding);

/// Whether what contacts gave may take a group of these bodies to a speed, m/s, that it has not
/// without: not where hardly anybody gains so much, as what lies alone takes a blow back by itself;
/// nor, of a single island, where all together do not.
template <class Real>
bool may_gain(std::span<const SolverBody<Real>> bodies, bool one_island, double speed);

template <class Real>
class EnergyLimiter {
public:
    /// Of a batch those that stiff springs pull and all that touch them, besides those that touch
    /// in such numbers that a blow goes through, or those with somebody who can only turn and all
    /// that touch him, or all; but for those that touch what moves by itself.
    enum class Whose : std::uint8_t { on_springs, stacked, turning, all };

    ///   springs  of which some are stiff, to be kept as long as this; null: there are none
    ///   fall     m/s, that gravity gives in a substep
    EnergyLimiter(const Layout& layout,
                  const Batch& batch,
                  const RigidFacts& facts,
                  const StateDependentForces* springs,
                  Whose whose,
                  const Vec3& fall);

    /// Before anything acts in a substep.
    void open(const ContactConstraints<Real>& constraints);
    /// Before contacts are solved: takes motions and impulses to the share that serves best.
    void take_share(ContactConstraints<Real>& constraints) const;
    /// The same where all of them would make more of it than none, by what takes a group to a
    /// speed, m/s: only after a blow, and of what it may go through. Of the groups of an island, by
    /// its solver bodies, first and behind the last.
    void take_share_of_blow(double speed,
                            std::pair<std::size_t, std::size_t> island,
                            ContactConstraints<Real>& constraints);
    /// The same where they make more of it than gravity gives in a substep. Notes what bodies do
    /// without contacts.
    void open_free(ContactConstraints<Real>& constraints);
    /// Once contacts are solved: slows down groups that have more than they would without them, but
    /// for those that are slower than that by and large, m/s: what all but rests gives way and
    /// comes back. Of those that touch in numbers only where a blow went through their island; and
    /// of a group only if `wanted` says so of its first solver body.
    void limit_contacts(double slowest,
                        const std::function<bool(std::uint32_t)>& wanted,
                        ContactConstraints<Real>& constraints) const;
    /// The same against what was noted, where they have more by what gravity gives in a substep.
    void close_free(ContactConstraints<Real>& constraints) const;
    /// Between the two: forces that act once bodies have moved give what is no gain. Adds motions
    /// as they are to what was noted, times -1 before these forces act and times 1 after.
    void add_to_free(const ContactConstraints<Real>& constraints, double times);
    /// Once all has acted: slows down who gained on springs.
    void close(ContactConstraints<Real>& constraints) const;

private:
    struct Member {
        std::uint32_t solver_index = 0;  // among the solver bodies
        double mass = 0;                 // kg; 0 of what cannot move along
        Mat3 inertia;                    // kg m2, in the axes that its spin is in
        Vec3 before = Vec3::Zero();      // m/s, as the substep began
        Vec3 free = Vec3::Zero(), free_spin = Vec3::Zero();  // m/s, rad/s, without contacts
    };
    // Bodies that touch or that springs join, the lanes of their contacts, and the springs.
    struct Group {
        std::vector<Member> members;
        std::vector<std::uint32_t> lanes;
        std::vector<std::uint32_t> springs;  // places among those of the forces
        bool floats = true;                  // touches nothing that stands still
        bool turns = false;                  // somebody can only turn
        bool fed = false;                    // may be given energy by more than springs and gravity
        bool driven = false;                 // touches what moves by itself
        bool watched = true;                 // contacts are held to giving it nothing
        double weighs = 0;                   // kg, of all members
        double kinetic = 0;                  // J, as the substep began

        double mass() const
        {
            double sum = 0;
            for (const Member& member : members) sum += member.mass;
            return sum;
        }
    };
    class Sets;
    // What impulses of the last substep would do to a group.
    struct WarmStart {
        double share = 1;   // by which its kinetic energy is least
        double gained = 0;  // J, by all of them over none
    };
    static double kinetic_of(const Group& group, const ContactConstraints<Real>& constraints);
    /// J, of motion, by what contacts give.
    static double given_by_contacts(const Group& group,
                                    const ContactConstraints<Real>& constraints);
    static WarmStart warm_start_of(const Group& group, const ContactConstraints<Real>& constraints);
    void scale(const Group& group, Real share, ContactConstraints<Real>& constraints) const;
    bool is_fed(const Group& group) const;
    double
    gained(const Group& group, double kinetic, const ContactConstraints<Real>& constraints) const;
    bool counts(const Group& group, double gained) const;
    Vec3 common_velocity(const Group& group, const ContactConstraints<Real>& constraints) const;
    void take_energy(const Group& group,
                     double kinetic,
                     double taken,
                     ContactConstraints<Real>& constraints) const;

    const StateDependentForces* springs_;
    IslandCalls calls_;  // of the batch
    Vec3 fall_;
    std::vector<Group> groups_;
};

}  // namespace throng
