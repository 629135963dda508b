// Coloring: contacts split so that no color moves a body twice, and laid out in blocks of 16.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/contacts.hpp"
#include "kernels/data/islands.hpp"
#include "kernels/data/rows.hpp"

namespace throng {

/// Small islands share a batch until it holds this many contacts: enough to fill the lanes, few
/// enough that the rows of a batch stay in one core's cache through all substeps.
inline constexpr std::size_t kBatchContacts = 512;

/// Gathers islands into batches, colors each batch greedily in the order of its contacts, and lays
/// the contacts out: batch by batch, color by color, those of more points before those of fewer.
/// All of it depends on ids alone.
void lay_out(const Islands& islands,
             const ActiveContacts& contacts,
             const BodyStates& states,
             Layout& layout);

}  // namespace throng
