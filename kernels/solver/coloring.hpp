// Coloring: contacts split so that no color moves a body twice, and laid out in blocks of 16.
#pragma once

#include "kernels/data/islands.hpp"
#include "kernels/solver/island_splitter.hpp"

#include <array>

namespace throng {

/// Small islands share a batch until it holds this many contacts: enough to fill the lanes, few
/// enough that the constraints of a batch stay in one core's cache through all substeps.
inline constexpr std::size_t kBatchContacts = 512;

/// Gathers small islands that call for the same into batches, cuts big ones into slices, colors
/// each slice greedily in the order of its contacts, and lays the contacts out: slice by slice,
/// color by color, those of more points before those of fewer. Ids and positions decide, and
/// nothing of the step before.
///
/// A block of contacts of one point is solved in another way. Where islands share a batch, and not
/// all contacts of theirs are such, it is told to have two, as a block has of which others are:
/// who else is in it is a matter of the islands beside.
class ConstraintGraph {
public:
    SplitRule split_rule;
    // Greatest island, in contacts and in bodies, that goes to the direct solver; above 0 each
    // island is a batch of its own.
    std::size_t direct_limit = 0;
    std::span<const Effort> efforts;  // [islands]; empty where all are solved alike

    void lay_out(const Islands& islands,
                 const ActiveContacts& active,
                 const BodyStates& states,
                 std::span<const Vec3> positions,
                 Layout& layout);

private:
    // Colors are bits of a word. A body that has used them all (a plate under a hundred things)
    // puts its further contacts into a last color whose blocks go one after another.
    static constexpr int kColors = 63;
    static constexpr std::uint32_t kPoints = 4;  // a contact has at most
    static constexpr std::size_t kBins = kPoints * (kColors + 1);

    // What is known of a slice before all are colored.
    struct Plan {
        std::array<std::uint32_t, kBins> size;  // contacts by color and points
        std::uint32_t blocks, colors, first_block;
        std::uint8_t least_points;                       // that a block is told to have
        std::vector<std::uint32_t> kinematic, standing;  // that it touches, ascending
    };

    void gather_slices(const Islands& islands,
                       const ActiveContacts& active,
                       const BodyStates& states,
                       std::span<const Vec3> positions,
                       Layout& layout);
    void number_solver_bodies(const Slice& slice, Layout& layout);
    void color_contacts(const ActiveContacts& active,
                        const BodyStates& states,
                        const Layout& layout,
                        const Slice& slice,
                        Plan& plan);
    static void count_blocks(Plan& plan);
    void lay_out_colors(Layout& layout);
    void place(const ActiveContacts& active,
               const BodyStates& states,
               const Plan& plan,
               const Slice& slice,
               Layout& layout);

    IslandSplitter splitter_;
    std::vector<Plan> plans_;            // [slices]
    std::vector<std::uint64_t> used_;    // by body: colors of the contacts of its slice
    std::vector<std::uint64_t> before_;  // by body: of the contacts of the slice before
    std::vector<std::uint8_t> bin_;      // [contacts] color and points
    std::vector<std::uint32_t> rank_;    // [contacts] among those of its bin
};

}  // namespace throng
