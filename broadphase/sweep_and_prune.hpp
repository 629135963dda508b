// Sweep and prune: boxes sorted along one axis, each compared with those it reaches there.
//
// Wins in small scenes, and in long ones: its cost follows how many boxes share a slice of the
// axis.
#pragma once

#include "broadphase/overlap_query.hpp"

#include <memory>

namespace throng {

class SweepAndPrune {
public:
    SweepAndPrune();
    ~SweepAndPrune();
    SweepAndPrune(SweepAndPrune&&) noexcept;
    SweepAndPrune& operator=(SweepAndPrune&&) noexcept;

    void find(const OverlapQuery& query, std::vector<PairKey>& pairs);

private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

}  // namespace throng
