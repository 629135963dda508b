// Kept islands: what a batch's constraints did to some of its islands, put aside while others go
// on.
#pragma once

#include "pipeline/step/step_data.hpp"

#include <array>

namespace throng {

/// Velocities and impulses of those islands of a batch of one slice that are not marked.
template <class Real>
class KeptIslands {
public:
    KeptIslands(const Layout& layout,
                const Batch& batch,
                std::span<const std::uint8_t> marked,
                const ContactConstraints<Real>& constraints);

    void restore(ContactConstraints<Real>& constraints) const;

private:
    // Of a block, those of its lanes that are kept.
    struct KeptBlock {
        std::size_t at = 0;
        std::uint16_t lanes = 0;
        Lane16<Real> friction[2], torsional, rolling[3];
    };
    struct KeptPoint {
        std::size_t at = 0;
        std::uint16_t lanes = 0;
        Lane16<Real> impulse, friction[2];
    };

    std::vector<std::pair<std::size_t, std::array<Real, 8>>> motions_;  // by solver body
    std::vector<KeptBlock> blocks_;
    std::vector<KeptPoint> points_;
    bool rolls_ = false, at_points_ = false;  // friction
};

}  // namespace throng
