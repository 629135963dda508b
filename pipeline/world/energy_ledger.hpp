// Energy ledger: whether energy grew that nothing put in.
//
// Kept by whoever asks, beside the steps of a world; a world that nobody keeps one of spends
// nothing on it.
#pragma once

#include "kernels/parallel/disjoint_sets.hpp"
#include "pipeline/world/world.hpp"

#include <array>
#include <cstdint>
#include <vector>

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
    /// Looks at a world before a step and after it. What is done to it in between two steps counts
    /// for neither.
    void before_step(const World& world);
    void after_step(const World& world);

    /// J: the most by which the account ever rose above what it had been after an earlier step.
    double gained() const { return gained_; }
    /// Of that rise: the step after which it began, and after which it was greatest. 0: none.
    std::uint64_t from_step() const { return from_step_; }
    std::uint64_t to_step() const { return to_step_; }
    /// J, by how much kinetic and potential energy changed from the first step to the last, less
    /// all that work: below 0 where friction, impacts and drag took more than was made.
    double net() const { return net_; }
    /// J, the greatest kinetic energy after any step, beside which the figure is much or little.
    double greatest_kinetic() const { return greatest_kinetic_; }

private:
    struct OfBody {
        double kinetic = 0, potential = 0;  // J
        Vec3 place = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero();
        double power = 0;  // W, of the program's own field
    };
    struct Look {
        std::vector<OfBody> bodies;
        std::vector<double> springs;  // J
    };
    struct OfGroup {
        double before = 0, after = 0;  // J
        double faster = 0;             // J, of which in motion
        double work = 0, rounding = 0;
        bool driven = false, touches = false;
    };

    void look(const World& world, Look& look) const;
    void join_groups(const World& world);
    void mark_groups(const World& world);
    void add_up(const World& world);
    double pay_back(double rise);
    void enter(double change, std::uint64_t step);
    double work_on(const World& world, std::uint32_t body) const;

    Look before_, after_;
    DisjointSets sets_;            // of bodies
    std::vector<OfGroup> groups_;  // [bodies] at the first of each
    double account_ = 0, lowest_ = 0, gained_ = 0, net_ = 0, greatest_kinetic_ = 0;
    // J, that contacts took in each of the last steps: of more of them than the four for which a
    // soft contact swings where a step has one substep.
    std::array<double, 6> taken_ = {};
    std::uint64_t lowest_step_ = 0, from_step_ = 0, to_step_ = 0;
};

}  // namespace throng
