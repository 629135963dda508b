// Find pairs: only colliders whose boxes changed are asked about; all other pairs live on.
#include "broadphase/broadphase.hpp"
#include "kernels/parallel/blocks.hpp"
#include "pipeline/stages.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::size_t kMergeGrain = 1 << 14;  // pairs a block: some 30 microseconds of work

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

// What became of a block of the old list: where its part of the new one lies, and how long it is.
struct Merged {
    std::size_t begin = 0, size = 0;
    bool changed = false;
};

// The new list of pairs from the old one and what was found. Pairs of colliders that were not asked
// about stay; all others are in `found` or gone.
class Merge {
public:
    explicit Merge(Pairs& pairs) : pairs_(pairs) { }

    // True if the list is another one now.
    bool run()
    {
        const std::size_t most = pairs_.keys.size() + pairs_.found.size();
        pairs_.merged.resize(most);
        pairs_.merged_from.resize(most);
        // At least one block, so that an empty list takes in what was found.
        const std::size_t count = std::max<std::size_t>(1, pairs_.keys.size());
        std::vector<Merged> parts(block_count(count, kMergeGrain));
        for_each_block(count, kMergeGrain, [&](auto begin, auto end, auto block) {
            parts[block] = merge(begin, std::min(end, pairs_.keys.size()));
        });
        if (std::none_of(parts.begin(), parts.end(), [](const auto& part) { return part.changed; }))
            return false;
        std::size_t size = 0;
        for (const Merged& part : parts) {
            move_down(pairs_.merged, part, size);
            move_down(pairs_.merged_from, part, size);
            size += part.size;
        }
        pairs_.merged.resize(size);
        pairs_.merged_from.resize(size);
        std::swap(pairs_.keys, pairs_.merged);
        std::swap(pairs_.from, pairs_.merged_from);
        return true;
    }

private:
    // Each block writes where its part would begin if nothing before it were lost.
    Merged merge(std::size_t begin, std::size_t end)
    {
        const std::vector<PairKey>&old = pairs_.keys, &found = pairs_.found;
        std::size_t next = begin == 0 ? 0 : first_found(old[begin]);
        const std::size_t last = end == old.size() ? found.size() : first_found(old[end]);
        Merged part{begin + next, 0, false};
        PairKey* keys = pairs_.merged.data() + part.begin;
        std::uint32_t* from = pairs_.merged_from.data() + part.begin;
        for (std::size_t i = begin; i < end || next < last;) {
            const PairKey limit = next < last ? found[next] : ~PairKey{0};
            // A run that nothing happens to.
            for (; i < end && old[i] < limit && !asked(old[i]); ++i) {
                *keys++ = old[i];
                *from++ = static_cast<std::uint32_t>(i);
            }
            if (i < end && old[i] < limit) {
                part.changed = true;  // asked about and not found again
                ++i;
                continue;
            }
            if (next >= last) continue;
            const bool known = i < end && old[i] == limit;
            *keys++ = limit;
            *from++ = known ? static_cast<std::uint32_t>(i++) : Pairs::kNewPair;
            part.changed |= !known;
            ++next;
        }
        part.size = static_cast<std::size_t>(keys - (pairs_.merged.data() + part.begin));
        return part;
    }

    std::size_t first_found(PairKey key) const
    {
        return static_cast<std::size_t>(
            std::lower_bound(pairs_.found.begin(), pairs_.found.end(), key) - pairs_.found.begin());
    }
    bool asked(PairKey key) const
    {
        return (pairs_.asked[first_of(key)] | pairs_.asked[second_of(key)]) != 0;
    }
    template <class T>
    static void move_down(std::vector<T>& list, const Merged& part, std::size_t to)
    {
        if (part.begin == to) return;
        const auto from = list.begin() + static_cast<std::ptrdiff_t>(part.begin);
        std::copy(from, from + static_cast<std::ptrdiff_t>(part.size),
                  list.begin() + static_cast<std::ptrdiff_t>(to));
    }

    Pairs& pairs_;
};

void note_meshes(const Shapes& shapes, const Colliders& colliders, Pairs& pairs)
{
    pairs.on_mesh.clear();
    if (shapes.meshes.empty()) return;
    const auto is_mesh = [&](std::uint32_t collider) {
        return colliders.shape[collider].kind == ShapeKind::mesh;
    };
    for (std::uint32_t i = 0; i < pairs.keys.size(); ++i)
        if (is_mesh(first_of(pairs.keys[i])) || is_mesh(second_of(pairs.keys[i])))
            pairs.on_mesh.push_back(i);
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
    if (!shapes.planes.empty())
        std::erase_if(pairs.found,
                      [&](PairKey key) { return !may_touch(key, bounds, shapes, colliders); });

    pairs.asked.resize(colliders.size(), 0);
    for (const std::uint32_t collider : bounds.asked) pairs.asked[collider] = 1;
    pairs.changed = Merge(pairs).run();
    for (const std::uint32_t collider : bounds.asked) pairs.asked[collider] = 0;
    if (pairs.changed) note_meshes(shapes, colliders, pairs);
}

}  // namespace throng
