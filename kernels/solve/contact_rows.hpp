// Contact rows: a contact made into one lane of a block, and its impulses given back.
#pragma once

#include "kernels/data/contacts.hpp"
#include "kernels/data/rows.hpp"

namespace throng {

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
struct ContactTerms {
    Real friction = 0, restitution = 0, rolling_friction = 0;
    Softness<Real> softness;
    Real deep = 0;  // m, overlap from which the contact no longer gives way; 0: it always does
};

/// Fills one lane from a contact. The lane's two places among `bodies` are already set.
template <class Real>
void fill_lane(ContactBlock<Real>& block,
               int lane,
               const Contact<Real>& contact,
               const SolverBody<Real>& a,
               const SolverBody<Real>& b,
               const ContactTerms<Real>& terms);

/// Makes a lane do nothing; `still` is the place of the batch's still body.
template <class Real>
void clear_lane(ContactBlock<Real>& block, int lane, std::int32_t still);

/// Gives the lane's impulses back to its contact, to start the next step from.
template <class Real>
void store_impulses(const ContactBlock<Real>& block, int lane, Contact<Real>& contact);

/// Carries impulses over from the contact of the same pair in the last step: point by point where
/// the same features touch, friction turned into the new tangent plane and cut to the cone.
///
///   scale  new substep over old, for the impulses of a step of another length
template <class Real>
void carry_impulses(const Contact<Real>& before, Real friction, Real scale, Contact<Real>& contact);

}  // namespace throng
