// Contact check: how far contacts are from their laws, by what a step left behind and without a
// reference.
#pragma once

#include "throng/world.hpp"

#include <compare>
#include <memory>
#include <vector>

namespace throng {

/// How far the contacts of a step are from the laws of contact and friction, as its last substep
/// left them: each the greatest of any contact, m/s. Forces are told by the speed that they give
/// in 1/60 s to what they push, whatever the step, so that steps of any length compare.
///
/// Contacts that are driven (prescribed velocities, conveyors) are left out of friction, and so is
/// what bounces off where it may; torsional and rolling friction are not looked at.
class ContactResiduals {
public:
    ContactResiduals();
    ~ContactResiduals();
    ContactResiduals(ContactResiduals&&) noexcept;
    ContactResiduals& operator=(ContactResiduals&&) noexcept;

    /// Looks at a world before a step and after it.
    void before_step(const World& world);
    void after_step(const World& world);

    /// m/s, the greatest over points of |min(q, w)|: q what the normal force gives; w the speed at
    /// which the point parts, or, where that is more, what its separation at the step's end is over
    /// the substep. Above 0 where a point pushes what parts or is apart; or goes in on what it
    /// overlaps.
    ///
    /// Source: the natural map of a complementarity problem: Facchinei and Pang, Finite-dimensional
    ///         variational inequalities and complementarity problems (2003), section 1.5.
    double complementarity() const;
    /// m/s, the greatest over contacts of |q - P(q - v)|: q what friction gives, v the velocity of
    /// sliding in the middle of the points, P to the nearest within a disc whose radius r is mu
    /// times what the normal forces give; or, where that is less, of |q + sum of r_k v_k / |v_k||,
    /// by points k, for friction that acts at every one of them. Above 0 where friction is beyond
    /// its cone, does not oppose what slides, or could do more to stop it. The cone is round,
    /// whatever `friction_cone` is.
    ///
    /// Source: as above, by the principle of maximum dissipation.
    double friction_cone() const;
    /// False where a step is cut at touches (overlap back_up and subdivide), which keeps no list of
    /// contacts: both are infinite then.
    bool known() const;

private:
    class Inside;
    std::unique_ptr<Inside> inside_;
};

/// Two bodies, the one with the smaller index first.
struct BodyPair {
    std::uint32_t a = 0, b = 0;  // indices of bodies
    auto operator<=>(const BodyPair&) const = default;
};

/// Pairs of bodies that the last step had a contact for, touching or not; ascending, each once.
/// Empty where a step is cut at touches.
std::vector<BodyPair> contact_pairs(const World& world);

/// Pairs of bodies, one of them dynamic at least, that overlap by more than a depth, m, found
/// afresh from geometry as World::measure() does; ascending, each once.
std::vector<BodyPair> overlapping_pairs(const World& world, double deeper_than);

/// What is left of the forces on each body by index, N: contacts over the last substep (see
/// World::contact_force()), gravity and its own constant force; nothing is left on what rests.
/// Not a number of who is not dynamic or is pushed by anything else.
std::vector<Vec3> unbalanced_forces(const World& world);

}  // namespace throng
