// Uniform grid: boxes in cells of equal size, each compared with those in the cells it reaches.
//
// A grid for each class of sizes, so that a few large boxes do not coarsen the cells of all others.
#pragma once

#include "broadphase/overlap_query.hpp"

#include <memory>

namespace throng {

class UniformGrid {
public:
    UniformGrid();
    ~UniformGrid();
    UniformGrid(UniformGrid&&) noexcept;
    UniformGrid& operator=(UniformGrid&&) noexcept;

    void find(const OverlapQuery& query, std::vector<PairKey>& pairs);

private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

}  // namespace throng
