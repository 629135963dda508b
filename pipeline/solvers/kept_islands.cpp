#include "pipeline/solvers/kept_islands.hpp"

#include <algorithm>

namespace throng {

namespace {

template <class Real>
void put_back(const Lane16<Real>& kept, std::uint16_t lanes, Lane16<Real>& number)
{
    for (int lane = 0; lane < kBlock; ++lane)
        number.at[lane] = (lanes >> lane & 1) != 0 ? kept.at[lane] : number.at[lane];
}

}  // namespace

template <class Real>
KeptIslands<Real>::KeptIslands(const Layout& layout,
                               const Batch& batch,
                               std::span<const std::uint8_t> marked,
                               const ContactConstraints<Real>& constraints)
    : rolls_(batch.calls.effects.has(Effect::rolling_friction)),
      at_points_(batch.calls.effects.has(Effect::friction) && !constraints.point_frictions.empty())
{
    const Slice& slice = layout.slices[batch.first_slice];
    const auto is_kept = [&](std::size_t solver_index) {
        return marked[layout.island_of(batch, static_cast<std::int32_t>(solver_index))] == 0;
    };
    for (std::size_t at = slice.first_body; at < slice.first_body + slice.dynamic; ++at)
        if (is_kept(at)) motions_.emplace_back(at, std::to_array(constraints.bodies[at].motion));

    const auto [begin, end] = layout.blocks_of(slice);
    for (std::size_t at = begin; at < end; ++at) {
        const ContactConstraintWide<Real>& block = constraints.blocks[at];
        KeptBlock kept{at, 0, {}, block.torsional_impulse, {}};
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            const std::int32_t a = block.a[lane], b = block.b[lane];
            const std::int32_t moves = layout.movable(a) ? a : b;
            if (layout.movable(moves) && is_kept(static_cast<std::size_t>(moves)))
                kept.lanes = static_cast<std::uint16_t>(kept.lanes | 1u << lane);
        }
        if (kept.lanes == 0) continue;
        std::ranges::copy(block.friction_impulse, kept.friction);
        if (rolls_) std::ranges::copy(constraints.rolling_frictions[at].impulse, kept.rolling);
        blocks_.push_back(kept);
        for (std::size_t k = 0; k < static_cast<std::size_t>(block.points); ++k) {
            const std::size_t point = block.first_point + k;
            KeptPoint of_point{point, kept.lanes, constraints.points[point].impulse, {}};
            if (at_points_)
                std::ranges::copy(constraints.point_frictions[point].impulse, of_point.friction);
            points_.push_back(of_point);
        }
    }
}

template <class Real>
void KeptIslands<Real>::restore(ContactConstraints<Real>& constraints) const
{
    for (const auto& [at, motion] : motions_)
        std::ranges::copy(motion, constraints.bodies[at].motion);
    for (const KeptBlock& kept : blocks_) {
        ContactConstraintWide<Real>& block = constraints.blocks[kept.at];
        for (int k = 0; k < 2; ++k)
            put_back(kept.friction[k], kept.lanes, block.friction_impulse[k]);
        put_back(kept.torsional, kept.lanes, block.torsional_impulse);
        if (!rolls_) continue;
        for (int k = 0; k < 3; ++k)
            put_back(kept.rolling[k], kept.lanes,
                     constraints.rolling_frictions[kept.at].impulse[k]);
    }
    for (const KeptPoint& kept : points_) {
        put_back(kept.impulse, kept.lanes, constraints.points[kept.at].impulse);
        if (!at_points_) continue;
        for (int k = 0; k < 2; ++k)
            put_back(kept.friction[k], kept.lanes, constraints.point_frictions[kept.at].impulse[k]);
    }
}

template class KeptIslands<float>;
template class KeptIslands<double>;

}  // namespace throng
