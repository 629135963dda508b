// Contact places: which pair has which contact, while pairs come and go and contacts begin and end.
#pragma once

#include "kernels/data/contacts.hpp"

namespace throng {

/// After the list of pairs has changed: what each pair knew, at its new place. Whoever is in the
/// list no more gives its contact back.
template <class Real>
void follow_pairs(const Pairs& pairs, ConvexContacts<Real>& contacts);

/// Takes back the places of contacts that ended, then gives places to new ones, in order of pairs.
template <class Real>
void move_in_and_out(ConvexContacts<Real>& contacts);

/// Contacts into the order of their pairs, once many have taken places anywhere: whoever goes
/// through them does so in that order, and would wait for memory at each.
template <class Real>
void put_in_order(ConvexContacts<Real>& contacts);

}  // namespace throng
