#include "narrowphase/manifold/patch_groups.hpp"

#include <algorithm>
#include <span>

namespace throng {

namespace {

// Cosine of the angle that a group takes in, 31 degrees. No round number: the normals of meshes
// made by formula often stand exactly 30 from one another.
constexpr double kAlike = 0.857;
// Of the angle over which the candidates of a group too many join another, 45 degrees.
constexpr double kJoins = 0.7;
// How often a group's middle is sought anew at most.
constexpr int kRounds = 4;
// Cosine of the angle from which on two groups hold a body from opposite sides, 134 degrees.
constexpr double kOpposite = -0.7;
constexpr std::uint8_t kNone = 255;  // no group
// Sine within which normals agree with one another: those of flat faces, rounding and grid
// included.
constexpr double kAgree = 0.05;

}  // namespace

const Mat3& odd_axes()
{
    static const Mat3 axes = Quat(1, 0.31, 0.23, 0.47).normalized().toRotationMatrix();
    return axes;
}

std::vector<std::uint8_t>& PatchGroups::groups_of()
{
    thread_local std::vector<std::uint8_t> scratch;
    return scratch;
}

std::vector<PatchGroups::Free>& PatchGroups::free_ones()
{
    thread_local std::vector<Free> scratch;
    scratch.clear();
    return scratch;
}

PatchGroups::PatchGroups(const std::vector<ContactCandidate>& candidates,
                         double speculative_margin,
                         double size)
    : candidates_(candidates), group_of_(groups_of()), free_(free_ones())
{
    group_of_.assign(candidates.size(), kNone);
    // What is just within the margin hardly counts.
    const double least_weight = 1e-6 * size;
    for (std::uint32_t i = 0; i < candidates.size(); ++i) {
        const double within = speculative_margin - candidates[i].separation + least_weight;
        free_.push_back({candidates[i].normal, within * within, i});
    }
    while (count_ < kMost && gather()) ++count_;
    keep_deepest();
}

std::size_t PatchGroups::left_out() const
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < candidates_.size(); ++i)
        count += group_of_[i] == kNone && candidates_[i].separation < 0 ? 1 : 0;
    return count;
}

bool PatchGroups::oppose() const
{
    const auto kept = std::span(groups_).first(count_);
    return std::any_of(kept.begin(), kept.end(), [&](const Group& a) {
        return std::any_of(kept.begin(), kept.end(), [&](const Group& b) {
            return a.kept && b.kept && a.normal.dot(b.normal) < kOpposite;
        });
    });
}

// Smooth in what comes and goes.
//
//   share  of a normal, by the square of how far it is from the direction
template <class Share>
Vec3 PatchGroups::mean_round(const Vec3& direction, const Share& share) const
{
    Vec3 sum = Vec3::Zero();
    for (const Free& one : free_) {
        if (!(direction.dot(one.normal) >= kAlike)) continue;
        sum += one.normal * (one.weight * share((one.normal - direction).squaredNorm()));
    }
    const double length = sum.norm();
    return length > 0 ? Vec3(sum / length) : direction;
}

// One more group, from the free touch that looks furthest along the odd direction: the mean of
// what is round it, then the mean of what is round that, and so on to where most push, and most
// deeply. The mean of directions within an angle of another is itself within that angle of one
// of them, so a group is never empty.
//
// Source: the mean shift of Comaniciu and Meer, Mean Shift: A Robust Approach Toward Feature
//         Space Analysis (2002), a few steps of it.
bool PatchGroups::gather()
{
    if (free_.empty()) return false;
    const Vec3 start = odd_axes().col(0);
    const Free* seed = nullptr;
    double furthest = -2;
    for (const Free& one : free_) {
        const double along = start.dot(one.normal);
        if (!(along > furthest)) continue;
        furthest = along;
        seed = &one;
    }
    if (seed == nullptr) return false;
    const std::uint32_t first = seed->candidate;
    Vec3 middle = seed->normal;
    for (int round = 0; round < kRounds; ++round) {
        const Vec3 before = middle;
        middle = mean_round(middle, [](double) { return 1.0; });
        if (middle == before) break;  // the same touches, and so from here on
    }
    // Less of what is much further from the direction than others are, so that a face on a face
    // is not tilted by its rim.
    for (int round = 0; round < 2; ++round)
        middle = mean_round(middle, [](double off2) { return 1 / (off2 + kAgree * kAgree); });
    groups_[count_].normal = middle;
    const std::size_t were = free_.size();
    std::erase_if(free_, [&](const Free& one) {
        const bool taken = middle.dot(one.normal) >= kAlike;
        if (taken) take(one.candidate);
        return taken;
    });
    if (free_.size() < were) return true;
    // Rounding.
    groups_[count_].normal = candidates_[first].normal;
    take(first);
    std::erase_if(free_, [&](const Free& one) { return one.candidate == first; });
    return true;
}

void PatchGroups::take(std::size_t candidate)
{
    group_of_[candidate] = static_cast<std::uint8_t>(count_);
    groups_[count_].deepest = std::min(groups_[count_].deepest, candidates_[candidate].separation);
}

void PatchGroups::keep_deepest()
{
    std::array<std::size_t, kMost> order;
    for (std::size_t g = 0; g < count_; ++g) order[g] = g;
    std::sort(order.begin(), order.begin() + count_, [&](std::size_t a, std::size_t b) {
        return groups_[a].deepest != groups_[b].deepest ? groups_[a].deepest < groups_[b].deepest
                                                        : a < b;
    });
    for (std::size_t k = 0; k < std::min(count_, kMostPatches); ++k) groups_[order[k]].kept = true;
    for (std::size_t i = 0; i < candidates_.size(); ++i)
        if (group_of_[i] == kNone || !groups_[group_of_[i]].kept) group_of_[i] = nearest_kept(i);
}

std::uint8_t PatchGroups::nearest_kept(std::size_t candidate) const
{
    std::uint8_t nearest = kNone;
    double most = kJoins;
    for (std::size_t g = 0; g < count_; ++g) {
        const double along = groups_[g].normal.dot(candidates_[candidate].normal);
        if (!groups_[g].kept || !(along > most)) continue;
        most = along;
        nearest = static_cast<std::uint8_t>(g);
    }
    return nearest;
}

}  // namespace throng
