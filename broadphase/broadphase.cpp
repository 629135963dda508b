#include "broadphase/broadphase.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

void find_overlaps(const OverlapQuery& query, AnyPairFinder& finder, std::vector<PairKey>& pairs)
{
    std::visit([&](PairFinder auto& chosen) { chosen.find(query, pairs); }, finder);
}

AnyPairFinder make_finder(FinderKind kind)
{
    switch (kind) {
    case FinderKind::embree:
        return EmbreeTree();
    case FinderKind::grid:
        return UniformGrid();
    case FinderKind::sweep:
        return SweepAndPrune();
    case FinderKind::all_pairs:
        break;
    }
    return AllPairs();
}

namespace {

// From timings on 16 to 100 000 boxes: README.md of this folder.
constexpr std::size_t kFewBoxes = 100;
constexpr std::size_t kSmallScene = 200;
// From there on the large ones of a grid look through too many cells: of 10,000 balls and boxes of
// 1:8 a step finds pairs in 1.7 ms by the grid and 2.4 by the tree, of 1:16 in 4.6 and 2.2, of
// 1:1000 in 52 and 3.2.
constexpr double kMixedSizes = 8;
constexpr std::size_t kSample = 1024;

// How many times larger a large one of the moving boxes is than a small one, from a sample: a tenth
// is larger, a tenth smaller. A few that are far larger a grid takes aside.
double mixture(std::span<const Box3> boxes, std::span<const std::uint8_t> moving)
{
    std::vector<double> sizes;
    const std::size_t stride = std::max<std::size_t>(1, boxes.size() / kSample);
    for (std::size_t id = 0; id < boxes.size(); id += stride) {
        const double size = (boxes[id].upper - boxes[id].lower).maxCoeff();
        if (moving[id] != 0 && size > 0 && std::isfinite(size)) sizes.push_back(size);
    }
    if (sizes.empty()) return 1;
    std::sort(sizes.begin(), sizes.end());
    return sizes[(sizes.size() - 1) * 9 / 10] / sizes[(sizes.size() - 1) / 10];
}

}  // namespace

FinderKind choose_finder(std::span<const Box3> boxes, std::span<const std::uint8_t> moving)
{
    if (boxes.size() < kFewBoxes) return FinderKind::all_pairs;
    if (boxes.size() < kSmallScene) return FinderKind::sweep;
    return mixture(boxes, moving) < kMixedSizes ? FinderKind::grid : FinderKind::embree;
}

}  // namespace throng
