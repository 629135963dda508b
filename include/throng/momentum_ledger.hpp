// Momentum ledger: whether momentum grew that nothing put in.
//
// Kept by whoever asks, beside the steps of a world; a world that nobody keeps one of spends
// nothing on it.
#pragma once

#include "throng/world.hpp"

#include <memory>

namespace throng {

/// The account of a run: what contacts and springs give one body they take from another, so that
/// the momentum of bodies that touch, or are on springs together, changes by gravity and by their
/// own constant forces alone. What else it changes by was made from nothing.
///
/// Groups that are held or pushed from outside stay out of the account, in each step in which they
/// are: by what is static, kinematic or driven, by springs to such, by a pivot or locks of
/// position, by attractors, drag, wind or a field of the program's own; and so do sleepers. So do
/// all, where a step is cut at touches (overlap back_up and subdivide) and anything is there that
/// is not dynamic: who touches whom is not kept there.
class MomentumLedger {
public:
    MomentumLedger();
    ~MomentumLedger();
    MomentumLedger(MomentumLedger&&) noexcept;
    MomentumLedger& operator=(MomentumLedger&&) noexcept;

    /// Looks at a world before a step and after it. Bodies that come or go in between are left out.
    void before_step(const World& world);
    void after_step(const World& world);

    /// N s: over steps and groups, the sum of the sizes of what momentum changed by without a
    /// cause, rounding included.
    double made() const;
    /// Groups that were in the account, over all steps: of none nothing is told.
    std::uint64_t groups() const;

private:
    class Inside;
    std::unique_ptr<Inside> inside_;
};

}  // namespace throng
