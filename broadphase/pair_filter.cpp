#include "broadphase/pair_filter.hpp"

namespace throng {

void PairFilter::add(std::uint32_t its_body, std::uint32_t its_group, std::uint32_t its_mask)
{
    body.push_back(its_body);
    group.push_back(its_group);
    mask.push_back(its_mask);
}

void PairFilter::resize(std::size_t colliders)
{
    // A place that nobody filled in touches nothing.
    body.resize(colliders, ~0u);
    group.resize(colliders, 0);
    mask.resize(colliders, 0);
}

}  // namespace throng
