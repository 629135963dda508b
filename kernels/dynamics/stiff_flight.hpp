// Stiff flight: bodies that touch nothing and are on stiff springs, through a time.
//
// What else acts is taken half before places change and half after it, as springs are; a body
// precesses by itself half before and half after, where it cannot as it goes.
#pragma once

#include "kernels/dynamics/rigid_motion.hpp"
#include "kernels/dynamics/stiff_springs.hpp"

namespace throng {

class StiffFlight {
public:
    /// bodies  ascending
    StiffFlight(const RigidRule& rule,
                const RigidFacts& facts,
                std::span<const std::uint32_t> bodies,
                const Flights& flights);
    StiffFlight(const StiffFlight&) = delete;
    StiffFlight& operator=(const StiffFlight&) = delete;

    /// On for a span, s, from a time since the step began: in parts where springs would turn a body
    /// too far in it to be followed.
    void carry(double time, double span);

    /// With what has become of the bodies.
    const RigidMotion& law() const { return law_; }

private:
    void carry_part(double time, double span, int halvings);
    void look();
    void look_at_speeds();
    void give(std::span<const StiffSprings::Six> change);

    RigidRule rule_;
    RigidMotion law_;
    StiffSprings springs_;
    int parts_ = 0;
};

}  // namespace throng
