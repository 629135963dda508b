#include "broadphase/sweep_and_prune.hpp"

#include "broadphase/layered_finder.hpp"

#include <algorithm>

namespace throng {
namespace {

// Boxes this many times larger than usual would make each scan pass over most of the others.
constexpr double kAsideRatio = 32;
constexpr std::size_t kGrain = 512;

// Boxes in the order in which they begin along the axis.
class SweepIndex {
public:
    void build(const std::vector<std::uint32_t>& ids, std::span<const Box3> boxes, const Vec3&)
    {
        axis_ = widest_axis(ids, boxes);
        order_.clear();
        for (const std::uint32_t id : ids) order_.emplace_back(boxes[id].lower[axis_], id);
        std::sort(order_.begin(), order_.end());

        boxes_.clear();
        greatest_upper_.clear();
        double greatest_upper = -std::numeric_limits<double>::infinity();
        for (const auto& [begin, id] : order_) {
            boxes_.push_back(boxes[id]);
            greatest_upper = std::max(greatest_upper, boxes[id].upper[axis_]);
            greatest_upper_.push_back(greatest_upper);
        }
    }

    void join(const PairRule& rule, std::vector<PairKey>& pairs)
    {
        run(order_.size(), pairs, [&](std::size_t a, std::vector<PairKey>& found) {
            for (std::size_t b = a + 1; b < order_.size(); ++b) {
                if (order_[b].first > boxes_[a].upper[axis_]) break;
                consider(boxes_[a], order_[a].second, *this, b, rule, found);
            }
        });
    }

    void find_overlaps(const SweepIndex& other, const PairRule& rule, std::vector<PairKey>& pairs)
    {
        const int along = other.axis_;
        run(other.order_.empty() ? 0 : order_.size(), pairs, [&](std::size_t a, auto& found) {
            // From the last that begins before a ends, back to where none can reach a any more.
            const auto end = std::partition_point(
                other.order_.begin(), other.order_.end(),
                [&](const auto& entry) { return entry.first <= boxes_[a].upper[along]; });
            for (auto b = static_cast<std::size_t>(end - other.order_.begin()); b-- > 0;) {
                if (other.greatest_upper_[b] < boxes_[a].lower[along]) break;
                consider(boxes_[a], order_[a].second, other, b, rule, found);
            }
        });
    }

private:
    static void consider(const Box3& box,
                         std::uint32_t id,
                         const SweepIndex& other,
                         std::size_t b,
                         const PairRule& rule,
                         std::vector<PairKey>& found)
    {
        const std::uint32_t other_id = other.order_[b].second;
        if (box.overlaps(other.boxes_[b]) && id != other_id && rule.wants(id, other_id))
            found.push_back(pair_key(id, other_id));
    }

    template <class Body>
    void run(std::size_t count, std::vector<PairKey>& pairs, const Body& body)
    {
        lists_.start(block_count(count, kGrain));
        for_each_block(count, kGrain, [&](auto begin, auto end, auto block) {
            for (std::size_t a = begin; a < end; ++a) body(a, lists_[block]);
        });
        lists_.append_to(pairs);
    }

    // The axis along which the boxes lie furthest apart: it separates best.
    static int widest_axis(const std::vector<std::uint32_t>& ids, std::span<const Box3> boxes)
    {
        if (ids.empty()) return 0;
        const Vec3 origin = boxes[ids.front()].lower;
        Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
        for (const std::uint32_t id : ids) {
            const Vec3 place = boxes[id].lower - origin;
            sum += place;
            squares += place.cwiseAbs2();
        }
        const Vec3 spread = squares - sum.cwiseAbs2() / static_cast<double>(ids.size());
        int widest = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (spread[axis] > spread[widest]) widest = axis;
        return widest;
    }

    int axis_ = 0;
    std::vector<std::pair<double, std::uint32_t>> order_;  // where each begins, and whose it is
    std::vector<Box3> boxes_;                              // in that order
    std::vector<double> greatest_upper_;  // how far this one or any before it extends
    BlockLists<PairKey> lists_;
};

}  // namespace

struct SweepAndPrune::Inside {
    LayeredFinder<SweepIndex> finder{kAsideRatio};
};

SweepAndPrune::SweepAndPrune() : inside_(std::make_unique<Inside>()) { }
SweepAndPrune::~SweepAndPrune() = default;
SweepAndPrune::SweepAndPrune(SweepAndPrune&&) noexcept = default;
SweepAndPrune& SweepAndPrune::operator=(SweepAndPrune&&) noexcept = default;

void SweepAndPrune::find(const OverlapQuery& query, std::vector<PairKey>& pairs)
{
    inside_->finder.find(query, pairs);
}

}  // namespace throng
