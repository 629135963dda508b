// k-DOP tree: k-DOPs round the faces of a polytope, two and two put together up to the whole.
//
// Built once, in the shape's own frame. In another frame a k-DOP is no k-DOP, but each direction
// there is a sum of three directions here, with weights at least 0, and the slabs' bounds summed
// alike hold for it. The weights are the same for all nodes of a pair. Single faces are placed
// corner by corner.
//
// There to be compared with: of convex shapes GJK takes less at any distance, and tells more.
//
// Source: Klosowski, Held, Mitchell, Sowizral, Zikan, Efficient Collision Detection Using Bounding
//         Volume Hierarchies of k-DOPs (1998), sections 3 and 4.
#pragma once

#include "narrowphase/alternatives/k_dop.hpp"

#include <vector>

namespace throng {

class KDopTree {
public:
    /// left   the first of two nodes that follow one another; 0: a leaf, of one face
    struct Node {
        KDop dop;
        std::uint32_t left = 0, face = 0;
    };

    /// Needs: k of 6, 14, 18 or 26; a shape that has faces.
    KDopTree(const PolytopeView& shape, int k);

    int k() const { return k_; }
    const Node& node(std::uint32_t i) const { return nodes_[i]; }  // 0 is the root
    std::size_t count() const { return nodes_.size(); }

private:
    int k_;
    std::vector<Node> nodes_;
};

/// The filter: `apart`, or `undecided` from the first two faces on that cannot be told apart. Never
/// `apart` of what touches, nor where one lies inside the other. Tells neither normal nor more.
///
///   a, b   of the pair's shapes, with the same k
///
/// rounds are pairs of nodes; after eight for each node of either, it is cut_short and undecided.
/// Allocates room for the nodes in hand, once a thread.
MethodAnswer query_k_dop_trees(const PolytopePair& pair, const KDopTree& a, const KDopTree& b);

}  // namespace throng
