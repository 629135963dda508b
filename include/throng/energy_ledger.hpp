// Energy ledger: whether energy grew that nothing put in.
//
// Kept by whoever asks, beside the steps of a world; a world that nobody keeps one of spends
// nothing on it.
#pragma once

#include "throng/world.hpp"

#include <cstdint>
#include <memory>

namespace throng {

/// The account of a run: kinetic and potential energy, less the work of forces, torques, wind and
/// the program's own field. Bodies are taken in groups that touch or are on springs together; while
/// something that moves by itself (a kinematic body, a driven one, a conveyor) is in a group, what
/// that group gains is its doing and stays out of the account. What a step may have made by
/// rounding is not counted; nor is what contacts lift as they give way less, but for the motion
/// that becomes of it, and of that none that they took out of others in the few steps before: a
/// soft contact gives back some of what it stopped. Heights are those that go with the velocities,
/// half a substep before, of what falls by the semi-implicit rule.
///
/// Where work is not known exactly, in the middle of a step, the most it can have been is taken:
/// what the account shows has no source, but it may miss some. So may it while others lose energy.
class EnergyLedger {
public:
    EnergyLedger();
    ~EnergyLedger();
    EnergyLedger(const EnergyLedger& other);
    EnergyLedger& operator=(const EnergyLedger& other);
    EnergyLedger(EnergyLedger&&) noexcept;
    EnergyLedger& operator=(EnergyLedger&&) noexcept;

    /// Looks at a world before a step and after it. What is done to it in between two steps counts
    /// for neither.
    void before_step(const World& world);
    void after_step(const World& world);

    /// J: the most by which the account ever rose above what it had been after an earlier step.
    double gained() const;
    /// Of that rise: the step after which it began, and after which it was greatest. 0: none.
    std::uint64_t from_step() const;
    std::uint64_t to_step() const;
    /// J, by how much kinetic and potential energy changed from the first step to the last, less
    /// all that work: below 0 where friction, impacts and drag took more than was made.
    double net() const;
    /// J, the greatest kinetic energy after any step, beside which the figure is much or little.
    double greatest_kinetic() const;

private:
    class Inside;
    std::unique_ptr<Inside> inside_;
};

}  // namespace throng
