// Spring energy limiter: bodies that stiff springs press on others start a substep with no more
// than serves them, and end it with no more energy than they had.
//
// Contacts start with what they gave in the substep before. Where a stiff spring turned a body
// round meanwhile that throws it off: a needle between a box and the floor spins at thousands of
// rad/s before a single contact is looked at, and there are too few iterations to bring that back.
// So bodies that stiff springs pull, and all that touch, start from that share of their impulses by
// which their kinetic energy is least. What friction and springs make of one another in the
// iterations that follow is held against what was there, in motion and in springs, and against the
// fall: what is too much is taken from the motion.
//
// Source: the kinetic energy is what Gauss-Seidel sweeps over inelastic contacts bring down
// (Moreau,
//         Quadratic programming in mechanics: dynamics of one-sided constraints, 1966); along the
//         impulses it is a parabola.
#pragma once

#include "kernels/parallel/disjoint_sets.hpp"
#include "pipeline/forces/state_dependent_forces.hpp"
#include "pipeline/step/step_data.hpp"

#include <span>

namespace throng {

template <class Real>
class SpringEnergyLimiter {
public:
    /// Of the bodies of a batch that stiff springs pull, and all that touch; but for those that
    /// touch what moves by itself.
    ///
    ///   forces  of which some are stiff; to be kept as long as this
    ///   fall    m/s, that gravity gives in a substep
    SpringEnergyLimiter(const Layout& layout,
                        const Batch& batch,
                        const RigidFacts& facts,
                        const StateDependentForces& forces,
                        const Vec3& fall);

    /// Before anything acts in a substep.
    void open(const ContactConstraints<Real>& constraints);
    /// Before contacts are solved: takes motions and impulses to the share that serves best.
    void take_share(ContactConstraints<Real>& constraints) const;
    /// Once all has acted: slows down who gained.
    void close(ContactConstraints<Real>& constraints) const;

private:
    struct Member {
        std::uint32_t solver_index = 0;  // among the solver bodies
        double mass = 0;                 // kg; 0 of what cannot move along
        Mat3 inertia;                    // kg m2, in the axes that its spin is in
        Vec3 before = Vec3::Zero();      // m/s, as the substep began
    };
    // Bodies that touch or that springs join, the lanes of their contacts, and the springs.
    struct Group {
        std::vector<Member> members;
        std::vector<std::uint32_t> lanes;
        std::vector<std::uint32_t> springs;  // places among those of the forces
        bool floats = true;                  // touches nothing that stands still
        bool fed = false;                    // may be given energy by more than springs and gravity
        bool driven = false;                 // touches what moves by itself
        double kinetic = 0;                  // J, as the substep began
    };
    class Sets;
    static double kinetic_of(const Group& group, const ContactConstraints<Real>& constraints);
    static double share_of(const Group& group, const ContactConstraints<Real>& constraints);
    static void scale(const Group& group, Real share, ContactConstraints<Real>& constraints);
    bool is_fed(const Group& group, const ContactConstraints<Real>& constraints) const;
    double
    gained(const Group& group, double kinetic, const ContactConstraints<Real>& constraints) const;
    Vec3 common_velocity(const Group& group, const ContactConstraints<Real>& constraints) const;
    void slow_down(const Group& group, double share, ContactConstraints<Real>& constraints) const;

    const StateDependentForces& forces_;
    Vec3 fall_;
    std::vector<Group> groups_;
};

}  // namespace throng
