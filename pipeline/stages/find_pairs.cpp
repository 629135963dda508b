// Find pairs: only colliders whose boxes changed are asked about; all other pairs live on.
#include "broadphase/broadphase.hpp"
#include "kernels/parallel/blocks.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::size_t kMergeGrain = 1 << 14;  // pairs a block: some 30 microseconds of work

// A half-space has no useful box: its pairs are cut by the plane itself, as far as it may move.
bool box_reaches_plane(const Box3& box,
                       const Plane& plane,
                       const Pose& placed,
                       double speculative_margin)
{
    const Vec3 normal = placed.orientation * plane.normal;
    const double offset = plane.offset + normal.dot(placed.position) + speculative_margin;
    const Vec3 lowest = (normal.array() > 0).select(box.lower, box.upper);
    return normal.dot(lowest) <= offset;
}

bool may_touch(PairKey key, const Bounds& bounds, const Shapes& shapes, const Colliders& colliders)
{
    const auto may = [&](std::uint32_t one, std::uint32_t other) {
        const ShapeRef shape = colliders.shape[one];
        return shape.kind != ShapeKind::plane
            || box_reaches_plane(bounds.boxes[other], shapes.planes[shape.index],
                                 bounds.placed[one], bounds.speculative_margin[one]);
    };
    return may(first_of(key), second_of(key)) && may(second_of(key), first_of(key));
}

// What became of a block of the old list: where its part of `from` lies, and of what was found; how
// long the first is, and how much of the second was not in the list.
struct Merged {
    std::size_t begin = 0, size = 0;
    std::size_t found = 0, fresh = 0;
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
        if (pairs_.keys.empty()) return begin_with_found();
        const std::size_t count = pairs_.keys.size();
        resize_closely(pairs_.from, count + pairs_.scratch.found.size());
        std::vector<Merged> parts(block_count(count, kMergeGrain) + 1);
        for (std::size_t i = 1; i + 1 < parts.size(); ++i)
            parts[i].found = first_found(pairs_.keys[i * kMergeGrain]);
        parts.back().found = pairs_.scratch.found.size();
        for_each_block(count, kMergeGrain, [&](auto begin, auto end, auto block) {
            merge(begin, end, parts[block + 1].found, parts[block]);
        });
        parts.pop_back();
        if (std::none_of(parts.begin(), parts.end(), [](const auto& part) { return part.changed; }))
            return false;
        std::size_t size = 0, fresh = 0;
        for (const Merged& part : parts) {
            move_down(pairs_.from, part.begin, part.size, size);
            move_down(pairs_.scratch.found, part.found, part.fresh, fresh);
            size += part.size;
            fresh += part.fresh;
        }
        pairs_.from.resize(size);
        follow(
            pairs_.from, pairs_.keys, [&](std::size_t n) { return pairs_.scratch.found[n]; },
            [](PairKey) {});
        return true;
    }

private:
    bool begin_with_found()
    {
        pairs_.keys.swap(pairs_.scratch.found);
        pairs_.from.assign(pairs_.keys.size(), Pairs::kNewPair);
        return !pairs_.keys.empty();
    }

    // Each block writes where its part would begin if nothing before it were lost.
    void merge(std::size_t begin, std::size_t end, std::size_t last, Merged& part)
    {
        const std::vector<PairKey>& old = pairs_.keys;
        std::vector<PairKey>& found = pairs_.scratch.found;
        std::size_t next = part.found;
        PairKey* fresh = found.data() + next;
        part.begin = begin + next;
        std::uint32_t* from = pairs_.from.data() + part.begin;
        for (std::size_t i = begin; i < end || next < last;) {
            const PairKey limit = next < last ? found[next] : ~PairKey{0};
            // A run that nothing happens to.
            for (; i < end && old[i] < limit && !asked(old[i]); ++i)
                *from++ = static_cast<std::uint32_t>(i);
            if (i < end && old[i] < limit) {
                part.changed = true;  // asked about and not found again
                ++i;
                continue;
            }
            if (next >= last) continue;
            const bool known = i < end && old[i] == limit;
            *from++ = known ? static_cast<std::uint32_t>(i++) : Pairs::kNewPair;
            if (!known) *fresh++ = limit;
            part.changed |= !known;
            ++next;
        }
        part.size = static_cast<std::size_t>(from - (pairs_.from.data() + part.begin));
        part.fresh = static_cast<std::size_t>(fresh - (found.data() + part.found));
    }

    std::size_t first_found(PairKey key) const
    {
        return static_cast<std::size_t>(
            std::lower_bound(pairs_.scratch.found.begin(), pairs_.scratch.found.end(), key)
            - pairs_.scratch.found.begin());
    }
    bool asked(PairKey key) const
    {
        return (pairs_.asked[first_of(key)] | pairs_.asked[second_of(key)]) != 0;
    }
    template <class T>
    static void move_down(std::vector<T>& list, std::size_t begin, std::size_t size, std::size_t to)
    {
        if (begin == to) return;
        const auto from = list.begin() + static_cast<std::ptrdiff_t>(begin);
        std::copy(from, from + static_cast<std::ptrdiff_t>(size),
                  list.begin() + static_cast<std::ptrdiff_t>(to));
    }

    Pairs& pairs_;
};

// Those that other stages look after than that of convex shapes.
void note_pairs_apart(const Shapes& shapes, const Colliders& colliders, Pairs& pairs)
{
    pairs.on_mesh.clear();
    pairs.on_solid.clear();
    if (shapes.meshes.empty() && shapes.solids.empty()) return;
    for (std::uint32_t i = 0; i < pairs.keys.size(); ++i) {
        const ShapeKind a = colliders.shape[first_of(pairs.keys[i])].kind;
        const ShapeKind b = colliders.shape[second_of(pairs.keys[i])].kind;
        if (a == ShapeKind::solid || b == ShapeKind::solid)
            pairs.on_solid.push_back(i);
        else if (a == ShapeKind::mesh || b == ShapeKind::mesh)
            pairs.on_mesh.push_back(i);
    }
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
    clear_closely(pairs.scratch.found);
    find_overlaps({bounds.boxes, bounds.moving, bounds.asked, bounds.still_changed, &filter},
                  finder.finder, pairs.scratch.found);
    if (!shapes.planes.empty())
        std::erase_if(pairs.scratch.found,
                      [&](PairKey key) { return !may_touch(key, bounds, shapes, colliders); });

    pairs.asked.resize(colliders.size(), 0);
    for (const std::uint32_t collider : bounds.asked) pairs.asked[collider] = 1;
    pairs.changed = Merge(pairs).run();
    for (const std::uint32_t collider : bounds.asked) pairs.asked[collider] = 0;
    if (pairs.changed) note_pairs_apart(shapes, colliders, pairs);
}

}  // namespace throng
