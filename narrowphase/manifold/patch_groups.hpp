// Patch groups: touches of two bodies by where their normals look.
#pragma once

#include "narrowphase/manifold/contact_patches.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace throng {

/// Axes that no face of a mesh is likely to look along.
const Mat3& odd_axes();

/// Groups of candidates whose normals lie within 31 degrees of the group's: as many as are needed,
/// of which the deepest kMostPatches are kept. Begun and told apart by nothing that turns on a
/// small difference. The candidates must outlive it; one at a time on a thread, whose scratch it
/// uses.
class PatchGroups {
public:
    /// `speculative_margin` and `size` as of make_patches().
    PatchGroups(const std::vector<ContactCandidate>& candidates,
                double speculative_margin,
                double size);

    /// Touches that overlap and are in no group.
    std::size_t left_out() const;
    /// Whether two of the groups that are kept look at one another.
    bool oppose() const;
    bool holds(std::uint8_t group, std::size_t candidate) const
    {
        return group_of_[candidate] == group;
    }
    /// Calls visit(normal, group) for each group that is kept.
    template <class Visitor>
    void visit(const Visitor& visit) const
    {
        for (std::size_t g = 0; g < count_; ++g)
            if (groups_[g].kept) visit(groups_[g].normal, static_cast<std::uint8_t>(g));
    }

private:
    // Far more than directions 31 degrees apart need. What is then left over joins or is left.
    static constexpr std::size_t kMost = 48;

    struct Group {
        Vec3 normal = Vec3::Zero();
        double deepest = std::numeric_limits<double>::infinity();  // least separation
        bool kept = false;
    };
    // A touch that is in no group yet.
    struct Free {
        Vec3 normal;
        double weight;
        std::uint32_t candidate;
    };

    static std::vector<std::uint8_t>& groups_of();
    static std::vector<Free>& free_ones();
    bool gather();
    template <class Share>
    Vec3 mean_round(const Vec3& direction, const Share& share) const;
    void take(std::size_t candidate);
    void keep_deepest();
    std::uint8_t nearest_kept(std::size_t candidate) const;

    const std::vector<ContactCandidate>& candidates_;
    std::vector<std::uint8_t>& group_of_;
    std::vector<Free>& free_;
    std::array<Group, kMost> groups_;
    std::size_t count_ = 0;
};

}  // namespace throng
