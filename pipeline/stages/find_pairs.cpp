// Find pairs: only colliders whose boxes changed are asked about; all other pairs live on.
#include "broadphase/broadphase.hpp"
#include "kernels/check.hpp"
#include "pipeline/stages.hpp"

#include <algorithm>

namespace throng {

namespace {

// A half-space has no useful box: its pairs are cut by the plane itself, as far as it may move.
bool box_reaches_plane(const Box3& box, const Plane& plane, const Pose& placed, double reach)
{
    const Vec3 normal = placed.orientation * plane.normal;
    const double offset = plane.offset + normal.dot(placed.position) + reach;
    const Vec3 lowest = (normal.array() > 0).select(box.lower, box.upper);
    return normal.dot(lowest) <= offset;
}

bool may_touch(PairKey key, const Bounds& bounds, const Shapes& shapes, const Colliders& colliders)
{
    for (const auto& [plane, other] :
         {std::pair(first_of(key), second_of(key)), std::pair(second_of(key), first_of(key))}) {
        const ShapeRef shape = colliders.shape[plane];
        if (shape.kind == ShapeKind::plane
            && !box_reaches_plane(bounds.boxes[other], shapes.planes[shape.index],
                                  bounds.placed[plane], bounds.reach[plane]))
            return false;
    }
    return true;
}

}  // namespace

void find_pairs(const Bounds& bounds,
                const Shapes& shapes,
                const Colliders& colliders,
                const PairFilter& filter,
                Finder& finder,
                Pairs& pairs)
{
    pairs.changed = false;
    if (bounds.asked.empty()) return;
    pairs.found.clear();
    find_overlaps({bounds.boxes, bounds.moving, bounds.asked, bounds.still_changed, &filter},
                  finder.finder, pairs.found);
    std::erase_if(pairs.found,
                  [&](PairKey key) { return !may_touch(key, bounds, shapes, colliders); });

    // Pairs of colliders that were not asked about stay; all others are in `found` or gone.
    std::vector<std::uint8_t> asked(colliders.size(), 0);
    for (const std::uint32_t collider : bounds.asked) asked[collider] = 1;
    pairs.merged.clear();
    pairs.from.clear();
    std::size_t next = 0;
    const auto take_found = [&](PairKey up_to) {
        while (next < pairs.found.size() && pairs.found[next] < up_to) {
            pairs.merged.push_back(pairs.found[next++]);
            pairs.from.push_back(Pairs::kNewPair);
        }
    };
    for (std::uint32_t old = 0; old < pairs.keys.size(); ++old) {
        const PairKey key = pairs.keys[old];
        take_found(key);
        const bool found = next < pairs.found.size() && pairs.found[next] == key;
        if (found) ++next;
        if (!found && (asked[first_of(key)] != 0 || asked[second_of(key)] != 0)) continue;
        pairs.merged.push_back(key);
        pairs.from.push_back(old);
    }
    take_found(~PairKey{0});

    if (pairs.merged == pairs.keys) return;
    pairs.changed = true;
    std::swap(pairs.keys, pairs.merged);
    pairs.on_mesh.clear();
    for (std::uint32_t i = 0; i < pairs.keys.size(); ++i)
        if (colliders.shape[first_of(pairs.keys[i])].kind == ShapeKind::mesh
            || colliders.shape[second_of(pairs.keys[i])].kind == ShapeKind::mesh)
            pairs.on_mesh.push_back(i);
}

}  // namespace throng
