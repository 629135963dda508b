// Parts order: the order in which contacts and events are told.
#pragma once

#include "throng/contact_events.hpp"

#include <tuple>

namespace throng {

/// By bodies, then by their parts; of two who held one place, the earlier first.
inline bool comes_before(const TouchingParts& one, const TouchingParts& other)
{
    const auto order = [](const TouchingParts& of) {
        return std::tuple(of.a.index, of.b.index, of.part_a, of.part_b, of.a.generation,
                          of.b.generation);
    };
    return order(one) < order(other);
}

}  // namespace throng
