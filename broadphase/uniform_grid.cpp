#include "broadphase/uniform_grid.hpp"

#include "broadphase/grid_index.hpp"
#include "broadphase/layered_finder.hpp"

#include <algorithm>
#include <array>

namespace throng {
namespace {

// Only what would make numbers useless stands aside: large boxes have a level of their own.
constexpr double kAsideRatio = 1e6;
constexpr int kLevels = 6;
// The first level holds all boxes up to this many times a small one's size, each further one boxes
// up to so many times larger than the one before. Every level is searched by all, so a few is best.
constexpr double kFirstLevel = 2;
constexpr double kNextLevel = 4;
constexpr std::size_t kSample = 1024;

double size_of(const Box3& box) { return (box.upper - box.lower).maxCoeff(); }

// The size that a tenth stays below.
double small_size(const std::vector<std::uint32_t>& ids, std::span<const Box3> boxes)
{
    std::vector<double> sizes;
    const std::size_t stride = std::max<std::size_t>(1, ids.size() / kSample);
    for (std::size_t i = 0; i < ids.size(); i += stride) sizes.push_back(size_of(boxes[ids[i]]));
    const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 10);
    std::nth_element(sizes.begin(), place, sizes.end());
    return *place;
}

// A grid for each class of sizes. Boxes of one level meet by rows; a box of a higher level asks the
// lower ones, so that the cost follows how many small boxes lie about the large one.
class LeveledGrid {
public:
    void
    build(const std::vector<std::uint32_t>& ids, std::span<const Box3> boxes, const Vec3& origin)
    {
        for (auto& of_level : ids_) of_level.clear();
        const double small = ids.empty() ? 0 : small_size(ids, boxes);
        for (const std::uint32_t id : ids) {
            const double size = size_of(boxes[id]);
            std::size_t level = 0;
            for (double limit = kFirstLevel * small; level + 1 < kLevels && size > limit; ++level)
                limit *= kNextLevel;
            ids_[level].push_back(id);
        }
        for (std::size_t level = 0; level < kLevels; ++level)
            levels_[level].build(ids_[level], boxes, origin);
    }

    void join(const PairRule& rule, std::vector<PairKey>& pairs)
    {
        for (std::size_t level = 0; level < kLevels; ++level) {
            levels_[level].join(rule, pairs);
            for (std::size_t lower = 0; lower < level; ++lower)
                levels_[level].meet(levels_[lower], rule, pairs);
        }
    }

    void meet(const LeveledGrid& other, const PairRule& rule, std::vector<PairKey>& pairs)
    {
        for (GridIndex& mine : levels_)
            for (const GridIndex& theirs : other.levels_) mine.meet(theirs, rule, pairs);
    }

private:
    std::array<GridIndex, kLevels> levels_;
    std::array<std::vector<std::uint32_t>, kLevels> ids_;
};

}  // namespace

struct UniformGrid::Inside {
    LayeredFinder<LeveledGrid> finder{kAsideRatio};
};

UniformGrid::UniformGrid() : inside_(std::make_unique<Inside>()) { }
UniformGrid::~UniformGrid() = default;
UniformGrid::UniformGrid(UniformGrid&&) noexcept = default;
UniformGrid& UniformGrid::operator=(UniformGrid&&) noexcept = default;

void UniformGrid::find(const OverlapQuery& query, std::vector<PairKey>& pairs)
{
    inside_->finder.find(query, pairs);
}

}  // namespace throng
