// Sphere walk: down a tree of spheres, or two at once, to the spheres of the last level.
#pragma once

#include "kernels/data/solids.hpp"

#include <vector>

namespace throng {

namespace detail {

/// A sphere of a tree, and the level that it is on.
struct SpherePlace {
    std::uint32_t level = 0, index = 0;

    const SphereTree::Node& in(const SphereTree& tree) const
    {
        return tree.levels[level].nodes[index];
    }
    bool last_of(const SphereTree& tree) const { return level + 1 >= tree.levels.size(); }
};

inline std::uint32_t root_count(const SphereTree& tree)
{
    return tree.levels.empty() ? 0 : static_cast<std::uint32_t>(tree.levels[0].nodes.size());
}

}  // namespace detail

/// Visits the spheres of the last level, of those whose balls about all that is below them are
/// reached. Always in the same order.
///
///   reached  (node) -> bool; of a node that is not, nothing below is looked at
///   visit    (node, which)
template <class Reached, class Visitor>
void visit_spheres(const SphereTree& tree, Reached reached, Visitor visit)
{
    using detail::SpherePlace;
    std::vector<SpherePlace> waiting;
    for (std::uint32_t i = 0; i < detail::root_count(tree); ++i) waiting.push_back({0, i});
    while (!waiting.empty()) {
        const SpherePlace at = waiting.back();
        waiting.pop_back();
        const SphereTree::Node& node = at.in(tree);
        if (!reached(node)) continue;
        if (at.last_of(tree)) visit(node, at.index);
        for (std::uint32_t i = 0; !at.last_of(tree) && i < node.count; ++i)
            waiting.push_back({at.level + 1, node.first + i});
    }
}

/// The same of pairs of two trees' spheres.
///
///   reached  (node of a, node of b) -> bool
///   visit    (node of a, node of b)
template <class Reached, class Visitor>
void visit_sphere_pairs(const SphereTree& a, const SphereTree& b, Reached reached, Visitor visit)
{
    using detail::SpherePlace;
    std::vector<std::pair<SpherePlace, SpherePlace>> waiting;
    for (std::uint32_t i = 0; i < detail::root_count(a); ++i)
        for (std::uint32_t k = 0; k < detail::root_count(b); ++k)
            waiting.push_back({{0, i}, {0, k}});
    while (!waiting.empty()) {
        const auto [at_a, at_b] = waiting.back();
        waiting.pop_back();
        const SphereTree::Node &node_a = at_a.in(a), &node_b = at_b.in(b);
        if (!reached(node_a, node_b)) continue;
        const bool last_a = at_a.last_of(a), last_b = at_b.last_of(b);
        if (last_a && last_b) {
            visit(node_a, node_b);
        } else if (last_b || (!last_a && node_a.bound >= node_b.bound)) {
            for (std::uint32_t i = 0; i < node_a.count; ++i)
                waiting.push_back({{at_a.level + 1, node_a.first + i}, at_b});
        } else {
            for (std::uint32_t k = 0; k < node_b.count; ++k)
                waiting.push_back({at_a, {at_b.level + 1, node_b.first + k}});
        }
    }
}

}  // namespace throng
