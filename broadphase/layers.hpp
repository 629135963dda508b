// Layers: what a finder remembers between calls, and which part of it a call has to touch.
//
// Still colliders, settled ones (moving, but as they were when the big index was built) and moved
// ones (asked about since) each get an index of their own. A call builds a small index of the moved
// ones and leaves the big one alone, until keeping them apart has cost as much as building anew.
// Boxes that are infinite, or absurdly large beside the others, would spoil any index: they stand
// aside in a list and are compared one by one.
#pragma once

#include "broadphase/overlap_query.hpp"
#include "kernels/parallel/compact.hpp"

namespace throng {

enum class Place : std::uint8_t { nowhere, still, settled, moved, aside };

/// A place with about half of these boxes on either side of it, along each axis: strays do not draw
/// it away. Depends on the boxes alone; needs at least one.
Vec3 middle_of(std::span<const Box3> boxes, const std::vector<std::uint32_t>& ids);

/// Who is in which layer. Lists are ascending.
class Layers {
public:
    /// aside_ratio: how many times larger than nearly all others a box may be before it stands
    /// aside
    explicit Layers(double aside_ratio) : aside_ratio_(aside_ratio) { }

    /// Takes in a query: afterwards every list is true to it.
    void update(const OverlapQuery& query);

    std::vector<std::uint32_t> still, settled, moved, aside;
    /// Those asked about that are in one of the first three layers.
    std::vector<std::uint32_t> askers;
    /// Per collider.
    std::vector<Place> place;
    std::vector<std::uint8_t> asked;
    /// A point among the settled ones, for indexes that count in floats from there.
    Vec3 origin = Vec3::Zero();
    /// What update() changed. A new origin renews both.
    bool still_renewed = false;
    bool settled_renewed = false;
    /// The settled layer is new and so many were asked that joining it with itself is cheapest.
    bool join_all = false;

private:
    bool due() const;
    void renew_still(const OverlapQuery& query);
    void renew_settled(const OverlapQuery& query);
    void move_asked(const OverlapQuery& query);
    void note_askers();
    bool follow(std::span<const Box3> boxes);
    void split_off(std::vector<std::uint32_t>& ids, std::span<const Box3> boxes, double limit);

    double aside_ratio_;
    double moving_limit_ = 0;           // m, largest moving box that does not stand aside
    std::size_t moving_count_ = 0;      // settled ones when their layer was built
    std::size_t spent_ = 0;             // what keeping moved ones apart has cost since
    std::vector<std::uint32_t> named_;  // whose asked flag is up
    bool started_ = false;
};

/// Decides about pairs whose boxes an index found to overlap.
struct PairRule {
    const OverlapQuery& query;
    const Layers& layers;
    /// The layer that b comes from: an index may still hold colliders that have left it.
    Place b_place = Place::settled;
    /// Each pair comes up once. Otherwise two asked colliders meet twice, and the lower id reports.
    bool once = false;

    bool wants(std::uint32_t a, std::uint32_t b) const
    {
        return layers.place[b] == b_place && allows(a, b);
    }
    bool allows(std::uint32_t a, std::uint32_t b) const
    {
        if (layers.asked[b] != 0 ? (!once && layers.asked[a] != 0 && b < a) : layers.asked[a] == 0)
            return false;
        if (query.moving[a] == 0 && query.moving[b] == 0) return false;
        return query.filter == nullptr || query.filter->allows(a, b);
    }
};

/// An index of boxes: the part of a finder that makes it fast.
///
///   build  forgets all, then holds the boxes of these ids; two indexes that meet share an origin
///   join   appends each wanted pair of two of its own boxes that overlap, each pair once
///   meet   the same for one of its own (a) with one of the other's (b)
template <class T>
concept BoxIndex = requires(T index,
                            const T& other,
                            const std::vector<std::uint32_t>& ids,
                            std::span<const Box3> boxes,
                            const Vec3& origin,
                            const PairRule& rule,
                            std::vector<PairKey>& pairs)
{
    index.build(ids, boxes, origin);
    index.join(rule, pairs);
    index.find_overlaps(other, rule, pairs);
};

/// Pairs of an asked collider with one that stands aside, either way round.
void compare_aside(const OverlapQuery& query,
                   const Layers& layers,
                   BlockLists<PairKey>& lists,
                   std::vector<PairKey>& pairs);

/// Finds pairs with any index.
template <BoxIndex Index>
class LayeredFinder {
public:
    explicit LayeredFinder(double aside_ratio) : layers_(aside_ratio) { }

    void find(const OverlapQuery& query, std::vector<PairKey>& pairs);

private:
    void ask(Index& askers, const OverlapQuery& query, std::vector<PairKey>& pairs);

    Layers layers_;
    Index still_, settled_, moved_, askers_;
    BlockLists<PairKey> lists_;
    std::vector<PairKey> scratch_;
};

}  // namespace throng
