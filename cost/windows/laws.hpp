// Laws: what the steps of a window miss of the laws of motion and contact, whatever the reference
// makes of it.
#pragma once

#include "cost/windows/errors.hpp"
#include "throng/contact_check.hpp"
#include "throng/momentum_ledger.hpp"

#include <span>

namespace throng {

/// Looks on at the steps of a window.
class LawWatch {
public:
    void before_step(const World& world, bool is_last);
    void after_step(const World& world, bool is_last);

    /// Puts in momentum, complementarity and friction_cone.
    void put_into(Errors& errors) const;

private:
    MomentumLedger momentum_;
    ContactResiduals residuals_;
};

/// Which of the bodies rest, by place: from one state to the other they stay where they are, within
/// a millimetre, and are slower than a millimetre a second in both.
std::vector<std::uint8_t> resting(const BodyStates& from, const BodyStates& to);

/// The share of pairs that touch of which nothing was found; both ascending. 0 where none touches.
double missed_share(std::span<const BodyPair> touching, std::span<const BodyPair> found);

/// The square of the share, where bodies are by now: a pair touches that overlaps by more than a
/// micrometre by the geometry of another world of the same scene, which is put there. Infinite
/// where a step keeps no list of contacts and some touch.
double missed_squared(const World& world, World& geometry);

/// The mean square, over bodies that rest, of what is left of the forces on each over its weight. 0
/// where there are none.
double force_squared(const World& world, std::span<const std::uint8_t> rests);

}  // namespace throng
