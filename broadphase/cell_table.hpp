// Cell table: boxes in a hashed grid of cells, each in the one cell of its lower corner.
//
// A box that changes costs the same however many others there are: it leaves one cell and enters
// another. Nearly all boxes of a scene share a level of cells; far smaller and larger ones have
// levels of their own. Boxes that no cell can hold, such as infinite ones, stand aside and are
// compared one by one.
#pragma once

#include "broadphase/overlap_query.hpp"

#include <array>

namespace throng {

class CellTable {
public:
    /// Takes in a query: afterwards every box is where it belongs, and searched() is true to it.
    void update(const OverlapQuery& query);

    /// Those to find the overlaps of: the asked ones, and of larger boxes that are few all others.
    const std::vector<std::uint32_t>& searched() const { return searched_; }

    /// Appends the pairs of a collider with all that its box meets, of which one is asked; those of
    /// two that are searched by one of them alone. Some may come up twice. May run on several
    /// threads.
    void
    find_overlaps(const OverlapQuery& query, std::uint32_t id, std::vector<PairKey>& pairs) const;

private:
    static constexpr std::uint8_t kNowhere = 0, kAside = 1, kLowest = 2, kMiddle = 100;

    // Rounded outward: most that do not meet are told apart without a look at the box itself.
    struct Entry {
        alignas(16) float lower[3];
        std::uint32_t id;
        alignas(16) float upper[3];
        std::uint32_t unused;
    };
    // The entries of a bucket follow one another, with room for some more.
    struct Bucket {
        std::uint32_t begin = 0, count = 0, capacity = 0;
    };
    struct EntryPlace {
        std::uint32_t bucket = 0, at = 0;
    };
    struct Level {
        double cell = 0, per_m = 0;   // m, 1/m; 0 while no box was in it
        Vec3 longest = Vec3::Zero();  // m, of any box that was ever in it
        std::size_t count = 0;
        std::vector<std::uint32_t> ids;  // of those in it; not told of the middle level
        bool looks_down = false;         // they look for those of smaller cells, not these for them
    };
    struct Cells {
        std::int64_t first[3], last[3];
        double count = 0;
    };

    class Search;

    void take_in(const OverlapQuery& query);
    void rebuild(const OverlapQuery& query);
    void choose_searched(const OverlapQuery& query);
    bool pays_to_look_down(const OverlapQuery& query, std::uint8_t level) const;
    void put(std::uint32_t id, const Box3& box);
    void take_out(std::uint32_t id);
    void insert(const Entry& entry, std::uint32_t at);
    void leave_room(const Bucket& bucket);
    std::uint32_t find_free_places(std::uint32_t capacity);
    static Entry entry_of(std::uint32_t id, const Box3& box);
    std::uint8_t level_of(const Box3& box) const;
    Cells cells_round(const Box3& box, const Level& level) const;
    std::uint64_t row_of(std::uint8_t level, std::int64_t y, std::int64_t z) const;

    std::vector<Entry> entries_;  // of all buckets
    std::array<std::vector<std::uint32_t>, 32>
        free_places_;                   // among them, free; by the power of two
    std::vector<Bucket> buckets_;       // a power of two of them
    std::vector<EntryPlace> places_;    // [colliders]
    std::vector<std::uint8_t> level_;   // [colliders]
    std::vector<std::uint8_t> asked_;   // [colliders] 1 for those of the last query
    std::vector<std::uint32_t> named_;  // whose flag is up
    std::vector<std::uint32_t> searched_;
    std::vector<std::uint32_t> seat_;  // [colliders] place in the list of its level, if any
    std::vector<std::uint32_t> aside_;
    std::array<Level, 256> levels_;
    std::vector<std::uint8_t> active_;  // levels that ever held a box
    double usual_ = 1;                  // m, of a cell of the middle level
};

}  // namespace throng
