// Contact packing: contacts into the lanes of the solver, and their impulses given back.
#pragma once

#include "kernels/data/contact_constraints.hpp"
#include "kernels/data/contacts.hpp"
#include "kernels/solver/solve_kernels.hpp"

namespace throng {

/// What a lane holds of a vector.
template <class Real>
Vec3T<Real> vector_at(const Lane16<Real> (&from)[3], std::size_t lane)
{
    return {from[0].at[lane], from[1].at[lane], from[2].at[lane]};
}
template <class Real>
Vec3 in_double(const Lane16<Real> (&from)[3], std::size_t lane)
{
    return vector_at(from, lane).template cast<double>();
}

/// How a contact gives way: a damped spring, integrated implicitly, seen as three numbers.
///
///   bias_rate      1/s, share of the overlap that is pushed apart
///   impulse_scale  share of the total impulse that leaks; the rest of 1 is the share of the
///                  velocity error that is taken away
///
/// Source: Catto, Soft Constraints (GDC 2011).
template <class Real>
struct Softness {
    Real bias_rate = 0, impulse_scale = 0;
};

/// The softness of a spring of a rate (Hz) and damping ratio over a substep (s). A load of j equal
/// bodies above a contact sinks by about 2 j g / (2 pi rate)^2.
template <class Real>
Softness<Real> softness(double rate, double damping_ratio, double substep);

/// Numbers of a contact that do not come from its geometry.
template <class Real>
struct ContactParameters {
    Real friction = 0, restitution = 0, rolling_friction = 0;
    Softness<Real> softness;
    Real deep = 0;  // m, overlap from which the contact no longer gives way; 0: it always does
    bool on_rim = false;  // it rolls on a rim
};

/// Puts a contact into one lane of a block of packed contacts, which refers to it.
template <class Real>
void pack_contact(const Contact<Real>& contact,
                  const ContactParameters<Real>& terms,
                  int lane,
                  PackedContacts<Real>& packed);

/// Makes a lane of a block of packed contacts do nothing.
template <class Real>
void pack_empty_lane(int lane, PackedContacts<Real>& packed);

/// Starts a lane from all the friction that its contact holds, within whatever limit: prepare() has
/// cut it to the round cone.
template <class Real>
void pack_unclamped_friction(const Contact<Real>& contact,
                             int lane,
                             ContactConstraintWide<Real>& block);

/// Gives the impulses of a lane of the block at `place` back to its contact, to start the next step
/// from.
template <class Real>
void store_impulses(const ContactConstraintsView<Real>& constraints,
                    std::size_t place,
                    int lane,
                    Contact<Real>& contact);

/// What the impacts of the step gave b in a lane, N s. Constraints of a scene where something
/// bounces.
template <class Real>
Vec3T<Real>
impact_impulse(const ContactConstraints<Real>& constraints, std::size_t place, int lane);

/// Makes all that a contact holds this times as much.
template <class Real>
void scale_impulses(Real scale, Contact<Real>& contact);

/// Carries impulses over from the contact of the same pair in the last step: point by point where
/// the same features touch, friction turned into the new tangent plane. What of it lies beyond the
/// cone is cut when constraints are made.
///
///   scale  new substep over old, for the impulses of a step of another length
template <class Real>
void carry_impulses(const Contact<Real>& before, Real scale, Contact<Real>& contact);

}  // namespace throng
