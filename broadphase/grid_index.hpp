// Grid index: boxes in rows of equal cross-section, sorted along the rows.
//
// A row runs along the longest side of the crowd. Each box lies in one row, that of its lower
// corner, so a row is a short sorted list and a search is a walk along a few of them.
#pragma once

#include "broadphase/layers.hpp"

namespace throng {

class GridIndex {
public:
    void
    build(const std::vector<std::uint32_t>& ids, std::span<const Box3> boxes, const Vec3& origin);
    void join(const PairRule& rule, std::vector<PairKey>& pairs);
    void meet(const GridIndex& other, const PairRule& rule, std::vector<PairKey>& pairs);

private:
    struct Cursors;

    void lay_out(const std::vector<std::uint32_t>& ids, std::span<const Box3> boxes);
    std::uint64_t step(double along) const;
    std::size_t row(int side, double place) const;
    void join_one(std::size_t a,
                  Cursors& cursors,
                  const PairRule& rule,
                  std::vector<PairKey>& found) const;
    void meet_one(const Box3& box,
                  std::uint32_t id,
                  const PairRule& rule,
                  std::vector<PairKey>& found) const;
    void walk(const Box3& box,
              std::uint32_t id,
              std::size_t begin,
              std::uint64_t end_slot,
              const PairRule& rule,
              std::vector<PairKey>& found) const;

    int along_ = 0, across_[2] = {1, 2};  // axes: of the rows, of their cross-section
    Vec3 start_ = Vec3::Zero();           // where rows, and the steps along them, begin
    double steps_per_m_ = 1;              // along a row
    double rows_per_m_ = 1;               // across, either way
    std::uint64_t steps_ = 1, rows_[2] = {1, 1};
    Vec3 reach_ = Vec3::Zero();  // m, no box is longer
    Box3 bounds_;                // of all boxes
    std::uint64_t reach_steps_ = 0;

    // In order of row, then of step: where each box lies (row * steps_ + step), the box and its id.
    std::vector<std::uint64_t> slots_;
    std::vector<Box3> boxes_;
    std::vector<std::uint32_t> ids_;
    std::vector<std::uint32_t> row_begin_;  // [rows + 1]

    std::vector<std::uint64_t> keys_, scratch_;
    BlockLists<PairKey> lists_;
};

}  // namespace throng
