// Contact patches, by directions: touches are grouped round normals, the groups named by where
// these look.
//
// No memory is kept, so what makes a point come out again in the next step is that nothing here
// turns on a small difference. Groups are begun from an end of the set along a direction at odds
// with all that meshes are built by. Equal places are told apart by their features, and depths are
// compared in steps that hardly moving bodies seldom cross.
#include "narrowphase/solids/contact_patches.hpp"

#include "kernels/math/hash.hpp"
#include "narrowphase/contact_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

// Cosine of the angle that a group takes in, 31 degrees. No round number: the normals of meshes
// made by formula often stand exactly 30 from one another.
constexpr double kAlike = 0.857;
// Of the angle over which the touches of a group too many join another, 45 degrees.
constexpr double kJoins = 0.7;
// Sine within which normals agree with one another: those of flat faces, rounding and grid
// included.
constexpr double kAgree = 0.05, kAll = 1e6;
// Far more groups than directions 31 degrees apart need. What is then left over joins or is left.
constexpr std::size_t kMostGroups = 48;
constexpr std::uint8_t kNone = 255;

// Parts of size: steps in which depths are compared, and how far places are moved to tell equal
// ones apart. A hundred and a thousand times what is left of a motion at rest.
constexpr double kDepthStep = 1e-4, kApart = 1e-3;

struct Group {
    Vec3 normal = Vec3::Zero();
    double deepest = std::numeric_limits<double>::infinity();  // least separation
    bool kept = false;
};

bool comes_before(const SurfaceTouch& a, const SurfaceTouch& b)
{
    if (a.feature != b.feature) return a.feature < b.feature;
    if (a.separation != b.separation) return a.separation < b.separation;
    for (int k = 0; k < 3; ++k)
        if (a.position[k] != b.position[k]) return a.position[k] < b.position[k];
    for (int k = 0; k < 3; ++k)
        if (a.normal[k] != b.normal[k]) return a.normal[k] < b.normal[k];
    return false;
}

// Axes that no face of a mesh is likely to look along.
const Mat3& odd_axes()
{
    static const Mat3 axes = Quat(1, 0.31, 0.23, 0.47).normalized().toRotationMatrix();
    return axes;
}

class Grouping {
public:
    Grouping(const std::vector<SurfaceTouch>& touches, double reach, double size)
        : touches_(touches), reach_(reach), least_weight_(1e-6 * size), group_of_(groups_of())
    {
        group_of_.assign(touches.size(), kNone);
        while (count_ < kMostGroups && gather()) ++count_;
        keep_deepest();
    }
    std::size_t left_out() const
    {
        return static_cast<std::size_t>(std::count(group_of_.begin(), group_of_.end(), kNone));
    }
    /// Visits each group that is kept, and the touches in it.
    template <class Visit>
    void visit(const Visit& visit) const
    {
        for (std::size_t g = 0; g < count_; ++g)
            if (groups_[g].kept) visit(groups_[g].normal, static_cast<std::uint8_t>(g));
    }
    bool holds(std::uint8_t group, std::size_t touch) const { return group_of_[touch] == group; }

private:
    static std::vector<std::uint8_t>& groups_of()
    {
        thread_local std::vector<std::uint8_t> scratch;
        return scratch;
    }

    // One more group, from the free touch that looks furthest along the odd direction: the mean of
    // what is round it, then the mean of what is round that, and so on to where most push, and most
    // deeply. The mean of directions within an angle of another is itself within that angle of one
    // of them, so a group is never empty.
    //
    // Source: the mean shift of Comaniciu and Meer, Mean Shift: A Robust Approach Toward Feature
    //         Space Analysis (2002), a few steps of it.
    bool gather()
    {
        const Vec3 start = odd_axes().col(0);
        std::size_t seed = touches_.size();
        double furthest = -2;
        for (std::size_t i = 0; i < touches_.size(); ++i) {
            if (group_of_[i] != kNone) continue;
            const double along = start.dot(touches_[i].normal);
            if (!(along > furthest)) continue;
            furthest = along;
            seed = i;
        }
        if (seed == touches_.size()) return false;
        Vec3 middle = touches_[seed].normal;
        for (const double width : {kAll, kAll, kAll, kAll, kAgree, kAgree})
            middle = mean_round(middle, width);
        groups_[count_].normal = middle;
        bool any = false;
        for (std::size_t i = 0; i < touches_.size(); ++i) {
            if (group_of_[i] != kNone || !(middle.dot(touches_[i].normal) >= kAlike)) continue;
            take(i);
            any = true;
        }
        if (any) return true;
        // Rounding.
        groups_[count_].normal = touches_[seed].normal;
        take(seed);
        return true;
    }

    // Smooth in what comes and goes: what is just within reach hardly counts, nor what is much
    // further from the direction than `width`, so that a face on a face is not tilted by its rim.
    Vec3 mean_round(const Vec3& direction, double width) const
    {
        Vec3 sum = Vec3::Zero();
        for (std::size_t i = 0; i < touches_.size(); ++i) {
            if (group_of_[i] != kNone || !(direction.dot(touches_[i].normal) >= kAlike)) continue;
            const double within = reach_ - touches_[i].separation + least_weight_;
            const double off2 = (touches_[i].normal - direction).squaredNorm() + width * width;
            sum += touches_[i].normal * (within * within / off2);
        }
        const double length = sum.norm();
        return length > 0 ? Vec3(sum / length) : direction;
    }

    void take(std::size_t touch)
    {
        group_of_[touch] = static_cast<std::uint8_t>(count_);
        groups_[count_].deepest = std::min(groups_[count_].deepest, touches_[touch].separation);
    }

    void keep_deepest()
    {
        std::array<std::size_t, kMostGroups> order;
        for (std::size_t g = 0; g < count_; ++g) order[g] = g;
        std::sort(order.begin(), order.begin() + count_, [&](std::size_t a, std::size_t b) {
            return groups_[a].deepest != groups_[b].deepest
                ? groups_[a].deepest < groups_[b].deepest
                : a < b;
        });
        for (std::size_t k = 0; k < std::min(count_, kMostPatches); ++k)
            groups_[order[k]].kept = true;
        for (std::size_t i = 0; i < touches_.size(); ++i)
            if (group_of_[i] == kNone || !groups_[group_of_[i]].kept)
                group_of_[i] = nearest_kept(i);
    }

    std::uint8_t nearest_kept(std::size_t touch) const
    {
        std::uint8_t nearest = kNone;
        double most = kJoins;
        for (std::size_t g = 0; g < count_; ++g) {
            const double along = groups_[g].normal.dot(touches_[touch].normal);
            if (!groups_[g].kept || !(along > most)) continue;
            most = along;
            nearest = static_cast<std::uint8_t>(g);
        }
        return nearest;
    }

    const std::vector<SurfaceTouch>& touches_;
    double reach_, least_weight_;
    std::vector<std::uint8_t>& group_of_;
    std::array<Group, kMostGroups> groups_;
    std::size_t count_ = 0;
};

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
std::uint32_t
free_name(const Vec3& normal, const std::vector<PatchManifold>& out, std::size_t first)
{
    std::uint32_t name = cell_of(normal);
    const auto taken = [&](const PatchManifold& other) { return other.patch == name; };
    while (std::any_of(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(), taken)) ++name;
    return name;
}

// A place that differs from all as near to it, by the same however the bodies tremble.
Vec3 told_apart(const SurfaceTouch& touch, double by)
{
    Hash hash;
    hash.add(std::uint64_t{touch.feature});
    const auto part = [&](int shift) {
        return static_cast<double>(hash.value() >> shift & 0xffff) / 32768 - 1;
    };
    return touch.position + by * Vec3(part(0), part(16), part(32));
}

// Chooses by places told apart and depths in steps, and takes the touches as they are.
void choose_points(const Grouping& groups,
                   std::uint8_t group,
                   const std::vector<SurfaceTouch>& touches,
                   double size,
                   LocalManifold<double>& manifold)
{
    thread_local std::vector<LocalManifold<double>::Point> candidates;
    candidates.clear();
    const double step = kDepthStep * size;
    for (std::size_t i = 0; i < touches.size(); ++i) {
        if (!groups.holds(group, i)) continue;
        const double along = touches[i].separation * manifold.normal.dot(touches[i].normal);
        candidates.push_back({told_apart(touches[i], kApart * size),
                              step > 0 ? std::round(along / step) * step : along,
                              static_cast<std::uint32_t>(i)});
    }
    reduce_to_four<double>(candidates, manifold);
    for (int k = 0; k < manifold.count; ++k) {
        auto& point = manifold.points[static_cast<std::size_t>(k)];
        const SurfaceTouch& touch = touches[point.feature];
        point = {touch.position, touch.separation * manifold.normal.dot(touch.normal),
                 touch.feature};
    }
}

}  // namespace

std::size_t make_patches(std::vector<SurfaceTouch>& touches,
                         double reach,
                         double size,
                         std::vector<PatchManifold>& out)
{
    std::erase_if(touches, [&](const SurfaceTouch& touch) {
        const bool finite = touch.position.allFinite() && touch.normal.allFinite()
            && std::isfinite(touch.separation);
        return !finite || touch.separation > reach;
    });
    if (touches.empty()) return 0;
    std::sort(touches.begin(), touches.end(), comes_before);
    const std::size_t first = out.size();
    const Grouping groups(touches, reach, size);
    groups.visit([&](const Vec3& normal, std::uint8_t group) {
        PatchManifold patch{free_name(normal, out, first), {}};
        patch.manifold.normal = normal;
        choose_points(groups, group, touches, size, patch.manifold);
        out.push_back(patch);
    });
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
              [](const PatchManifold& a, const PatchManifold& b) { return a.patch < b.patch; });
    return groups.left_out();
}

}  // namespace throng
