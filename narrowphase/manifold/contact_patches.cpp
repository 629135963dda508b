// Contact patches, by directions: touches are grouped round normals, the groups named by where
// these look.
//
// No memory is kept, so what makes a point come out again in the next step is that nothing here
// turns on a small difference. Groups are begun from an end of the set along a direction at odds
// with all that meshes are built by. Equal places are told apart by their features, and depths are
// compared in steps that hardly moving bodies seldom cross.
//
// A round side in a hollow of its own shape, as a bolt in its nut or a ring on its post, touches
// all round, and may turn there. Under the mean of a group's normals its ends could not: at either
// end that mean leans against one way of turning. So an end whose normal differs keeps its own.
#include "narrowphase/manifold/contact_patches.hpp"

#include "kernels/math/hash.hpp"
#include "narrowphase/manifold/patch_groups.hpp"
#include "narrowphase/manifold/places_between.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

// Cosines of the angles up to which a chosen place goes by its group's normal, 8 degrees, and from
// which it goes by its own, 12; by some of either between them, so that what trembles does not
// jump. By the group's up to 15 bolts made of spheres do not turn.
constexpr double kGroupNormal = 0.9903, kOwnNormal = 0.9781;
// How many times a depth missing weighs as much as a distance to span. Of a ball of radius R that
// keeps what lies within R / 20 of the deepest place. Less where the speculative margin is more
// than this part of size, as then bodies are fast, and what is far apart yet may be the first to
// touch.
constexpr double kShallow = 20, kShortReach = 0.1;
// Part of size that places between those that span a patch stand apart at least.
constexpr double kSpacing = 0.03;
// More than there are names of groups. What is by itself is named by its group and which end it is.
constexpr std::uint32_t kNames = 256;

// Parts of size: steps in which depths are compared, and how far places are moved to tell equal
// ones apart. A hundred and a thousand times what is left of a motion at rest.
constexpr double kDepthStep = 1e-4, kApart = 1e-3;

bool comes_before(const ContactCandidate& a, const ContactCandidate& b)
{
    if (a.feature != b.feature) return a.feature < b.feature;
    if (a.separation != b.separation) return a.separation < b.separation;
    for (int k = 0; k < 3; ++k)
        if (a.position[k] != b.position[k]) return a.position[k] < b.position[k];
    for (int k = 0; k < 3; ++k)
        if (a.normal[k] != b.normal[k]) return a.normal[k] < b.normal[k];
    return false;
}

// Which of 96 cells of a cube about odd axes the direction goes through: four by four a side.
// Groups look 31 degrees apart or more, and cells span 27 or less.
std::uint32_t cell_of(const Vec3& direction)
{
    const Vec3 seen = odd_axes().transpose() * direction;
    Eigen::Index side = 0;
    const double most = seen.cwiseAbs().maxCoeff(&side);
    std::uint32_t cell = static_cast<std::uint32_t>(2 * side) + (seen[side] < 0 ? 1 : 0);
    for (const Eigen::Index k : {(side + 1) % 3, (side + 2) % 3})
        cell = 4 * cell + static_cast<std::uint32_t>(std::clamp(2 + 2 * seen[k] / most, 0.0, 3.0));
    return cell;
}

// Names the group that looks along `normal`; should others be named so, the next that is free.
std::uint32_t free_name(const Vec3& normal, const std::vector<PartManifold>& out, std::size_t first)
{
    std::uint32_t name = cell_of(normal);
    const auto taken = [&](const PartManifold& other) { return other.part % kNames == name; };
    while (std::any_of(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(), taken)) ++name;
    return name;
}

// A place that differs from all as near to it, by the same however the bodies tremble.
Vec3 told_apart(const ContactCandidate& candidate, double by)
{
    return candidate.position + by * spot_of(candidate.feature);
}

// A direction across the normal that moves smoothly with it, but for seams far from odd axes.
Vec3 across(const Vec3& normal)
{
    Eigen::Index greatest = 0;
    (odd_axes().transpose() * normal).cwiseAbs().maxCoeff(&greatest);
    return normal.cross(odd_axes().col((greatest + 1) % 3)).normalized();
}

// Four places that span a group: one end, the other end, and the furthest to either side of the
// line between them, where what lies shallower than the deepest counts as so much nearer. Of a
// round body on a floor that leaves what bears it, of a face the corners.
class Spread {
public:
    using Point = LocalManifold<double>::Point;

    /// How much a depth missing weighs: see kShallow; and from which depth on none is missing, m.
    Spread(const std::vector<Point>& points, const Vec3& normal, double shallow, double deep)
        : points_(points), shallow_(shallow)
    {
        deepest_ = best([](const Point&) { return 0.0; });
        deep_ = -deep;  // of the others, not of which is the deepest
        const Vec3 start = across(normal);
        take(best([&](const Point& p) { return start.dot(p.position); }));
        const Vec3 from = points_[chosen_[0]].position;
        const std::size_t end = best([&](const Point& p) { return (p.position - from).norm(); });
        take(end);
        const Vec3 along = points_[end].position - from;
        const double length = along.norm();
        const Vec3 side = length > 0 ? Vec3(normal.cross(along / length)) : start;
        take(best([&](const Point& p) { return side.dot(p.position - from); }));
        take(best([&](const Point& p) { return -side.dot(p.position - from); }));
        keep_deepest();
    }

    /// In the order of the points, and which of the four places each has.
    template <class Visitor>
    void visit(const Visitor& visit) const
    {
        std::array<std::uint32_t, 4> order{};
        for (std::uint32_t place = 0; place < count_; ++place) {
            std::size_t at = place;
            for (; at > 0 && chosen_[order[at - 1]] > chosen_[place]; --at)
                order[at] = order[at - 1];
            order[at] = place;
        }
        for (std::size_t k = 0; k < count_; ++k) visit(points_[chosen_[order[k]]], order[k]);
    }

    std::span<const std::size_t> chosen() const { return std::span(chosen_).first(count_); }

private:
    template <class Place>
    std::size_t best(const Place& place) const
    {
        const double deepest = deepest_ < points_.size() ? points_[deepest_].separation : 0;
        const double full = std::max(deepest, deep_);
        std::size_t best = 0;
        double most = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const double missing = std::max(points_[i].separation, deep_) - full;
            const double score = place(points_[i]) - shallow_ * missing;
            if (!(score > most)) continue;
            most = score;
            best = i;
        }
        return best;
    }
    void take(std::size_t point)
    {
        if (std::find(chosen_.begin(), chosen_.begin() + count_, point) == chosen_.begin() + count_)
            chosen_[count_++] = point;
    }
    // Where it was not chosen it takes the place of the chosen one nearest to it.
    void keep_deepest()
    {
        const double depth = points_[deepest_].separation;
        std::size_t nearest = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < count_; ++k) {
            if (points_[chosen_[k]].separation <= depth) return;
            const double distance =
                (points_[chosen_[k]].position - points_[deepest_].position).norm();
            if (!(distance < least)) continue;
            least = distance;
            nearest = k;
        }
        chosen_[nearest] = deepest_;
    }

    const std::vector<Point>& points_;
    double shallow_, deep_ = -std::numeric_limits<double>::infinity();
    std::size_t deepest_ = std::numeric_limits<std::size_t>::max();
    std::array<std::size_t, 4> chosen_{};
    std::size_t count_ = 0;
};

double weight_of_depth(double speculative_margin, double size)
{
    const double fast = speculative_margin / (kShortReach * size);
    return fast > 1 ? kShallow / (fast * fast) : kShallow;
}

// Of a place whose normal does not agree with its group's: see kOwnNormal.
Vec3 normal_between(const Vec3& group, const Vec3& own, double cosine)
{
    if (cosine <= kOwnNormal) return own;
    const double part = (kGroupNormal - cosine) / (kGroupNormal - kOwnNormal);
    return (part * own + (1 - part) * group).normalized();
}

// The manifolds of one set of candidates, put behind what `out` holds.
class PatchMaker {
public:
    PatchMaker(const std::vector<ContactCandidate>& candidates,
               double speculative_margin,
               double size,
               double deep,
               std::vector<PartManifold>& out)
        : candidates_(candidates), groups_(candidates, speculative_margin, size),
          speculative_margin_(speculative_margin), size_(size), deep_(deep),
          fills_(speculative_margin > kShortReach * size && groups_.oppose()), out_(out),
          first_(out.size())
    { }

    /// Touches that overlap and are in no manifold.
    std::size_t make()
    {
        groups_.visit([&](const Vec3& normal, std::uint8_t group) { add(normal, group); });
        std::sort(out_.begin() + static_cast<std::ptrdiff_t>(first_), out_.end(),
                  [](const PartManifold& a, const PartManifold& b) { return a.part < b.part; });
        return groups_.left_out();
    }

private:
    // What agrees with the group's normal together, and the rest each by itself.
    void add(const Vec3& normal, std::uint8_t group)
    {
        const std::vector<LocalManifold<double>::Point>& places = places_of(normal, group);
        const Spread spread(places, normal, weight_of_depth(speculative_margin_, size_), deep_);
        const std::uint32_t name = free_name(normal, out_, first_);
        PartManifold together{name, {}};
        together.manifold.normal = normal;
        spread.visit([&](const auto& chosen, std::uint32_t end) {
            const ContactCandidate& candidate = candidates_[chosen.feature];
            const double along = normal.dot(candidate.normal);
            if (along >= kGroupNormal)
                put(candidate, together.manifold);
            else
                add_alone(candidate, normal_between(normal, candidate.normal, along), name, end);
        });
        if (together.manifold.count > 0) out_.push_back(together);
        if (fills_ && bends(normal, places)) fill(places, spread.chosen(), name);
    }

    static void put(const ContactCandidate& candidate, LocalManifold<double>& manifold)
    {
        manifold.add(candidate.position,
                     candidate.separation * manifold.normal.dot(candidate.normal),
                     candidate.feature);
    }

    // `end` tells apart what stands alone of one group.
    void add_alone(const ContactCandidate& candidate,
                   const Vec3& normal,
                   std::uint32_t name,
                   std::uint32_t end)
    {
        PartManifold& alone = out_.emplace_back(PartManifold{kNames * (end + 1) + name, {}});
        alone.manifold.normal = normal;
        put(candidate, alone.manifold);
    }

    bool bends(const Vec3& normal, const std::vector<LocalManifold<double>::Point>& places) const
    {
        return std::any_of(places.begin(), places.end(), [&](const auto& place) {
            return normal.dot(candidates_[place.feature].normal) < kGroupNormal;
        });
    }

    void fill(const std::vector<LocalManifold<double>::Point>& places,
              std::span<const std::size_t> chosen,
              std::uint32_t name)
    {
        thread_local std::vector<std::size_t> taken;
        taken.assign(chosen.begin(), chosen.end());
        take_between(places, kSpacing * size_, weight_of_depth(speculative_margin_, size_),
                     kMostBetween, taken);
        for (std::size_t k = chosen.size(); k < taken.size(); ++k) {
            const ContactCandidate& candidate = candidates_[places[taken[k]].feature];
            const auto end = static_cast<std::uint32_t>(4 + k - chosen.size());
            add_alone(candidate, candidate.normal, name, end);
        }
    }

    // The candidates of a group, places told apart and depths in steps; features are those of
    // `candidates_`.
    const std::vector<LocalManifold<double>::Point>& places_of(const Vec3& normal,
                                                               std::uint8_t group) const
    {
        thread_local std::vector<LocalManifold<double>::Point> places;
        places.clear();
        const double step = kDepthStep * size_;
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            if (!groups_.holds(group, i)) continue;
            const double along = candidates_[i].separation * normal.dot(candidates_[i].normal);
            places.push_back({told_apart(candidates_[i], kApart * size_),
                              step > 0 ? std::round(along / step) * step : along,
                              static_cast<std::uint32_t>(i)});
        }
        return places;
    }

    const std::vector<ContactCandidate>& candidates_;
    const PatchGroups groups_;
    double speculative_margin_, size_, deep_;
    bool fills_;  // patches that bend
    std::vector<PartManifold>& out_;
    std::size_t first_;  // of this set in `out`
};

}  // namespace

std::size_t make_patches(std::vector<ContactCandidate>& candidates,
                         double speculative_margin,
                         double size,
                         double deep,
                         std::vector<PartManifold>& out)
{
    std::erase_if(candidates, [&](const ContactCandidate& candidate) {
        const bool finite = candidate.position.allFinite() && candidate.normal.allFinite()
            && std::isfinite(candidate.separation);
        return !finite || candidate.separation > speculative_margin;
    });
    if (candidates.empty()) return 0;
    std::sort(candidates.begin(), candidates.end(), comes_before);
    return PatchMaker(candidates, speculative_margin, size, deep, out).make();
}

}  // namespace throng
