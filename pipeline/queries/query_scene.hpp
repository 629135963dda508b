// Query scene: a world's colliders, laid out for questions, and brought up to date by those that
// moved since.
//
// Boxes name candidates, closed forms in double decide. Planes have no box and are asked one by
// one.
#pragma once

#include "broadphase/live_boxes.hpp"
#include "pipeline/world/world_state.hpp"
#include "throng/queries.hpp"

#include <algorithm>

namespace throng {

/// Answers what Queries asks, once the questions are known to be good.
class QueryScene {
public:
    explicit QueryScene(WorldState& state);

    /// Looks at who moved, came and went since the last time. Before each question.
    void refresh();

    /// Colliders whose boxes meet regions, planes apart; on the threads of the pool that the caller
    /// runs in.
    void find_near(std::span<const Box3> regions, Candidates& candidates)
    {
        boxes_.meet_boxes(regions, candidates);
    }
    std::span<const std::uint32_t> planes() const { return planes_; }
    Pose placed(std::uint32_t collider) const;
    /// Whether a convex shape shares a point with a collider.
    bool
    overlaps(const Shapes& shapes, ShapeRef shape, const Pose& pose, std::uint32_t collider) const;

    void cast_rays(std::span<const RayQuery> rays, std::span<RayHit> hits);
    void find_blocked(std::span<const RayQuery> rays, std::span<std::uint8_t> blocked);
    void find_overlaps(std::span<const ShapeQuery> queries, std::span<std::vector<BodyId>> found);
    void find_nearest(std::span<const PointQuery> points, std::span<NearestHit> nearest);

private:
    /// The best answer so far: a collider and, in its own frame, the normal where a ray meets it or
    /// the point of it that is nearest.
    struct Best {
        double distance = std::numeric_limits<double>::infinity();
        std::uint32_t collider = kNoBody;
        Vec3 local = Vec3::Zero();
    };
    struct Search;
    using Order = std::vector<std::pair<double, std::uint32_t>>;  // m along a ray, collider

    static constexpr std::size_t kGrain = 64;    // questions a block
    static constexpr std::size_t kBatch = 8192;  // questions whose candidates are held at one time

    /// Calls work(first, count) for one batch after another, on the world's threads.
    template <class Work>
    void run_in_batches(std::size_t questions, const Work& work)
    {
        state_.pool.run([&](std::size_t, std::size_t, std::size_t) {
            for (std::size_t first = 0; first < questions; first += kBatch)
                work(first, std::min(kBatch, questions - first));
        });
    }
    bool is_asked(std::uint32_t collider, std::uint32_t mask) const;
    void find_touched(bool stepped);
    bool stays(std::uint32_t collider) const;
    Box3 box_of(std::uint32_t collider) const;
    void put(std::uint32_t collider);
    bool beats(double distance, std::uint32_t collider, const Best& best) const;

    void cast(const RayQuery& query, const Ray& ray, std::uint32_t collider, Best& best) const;
    void cast_at_candidates(const RayQuery& query,
                            const Search& search,
                            std::span<const std::uint32_t> candidates,
                            Order& order,
                            Best& best) const;
    Search search_for(const RayQuery& query) const;
    void search_met(std::span<const RayQuery> rays, std::span<Best> best, bool any);

    void overlap(const ShapeQuery& query,
                 std::span<const std::uint32_t> candidates,
                 Shapes& asked,
                 std::vector<BodyId>& found) const;

    void approach(const PointQuery& query, std::uint32_t collider, Best& best) const;
    void search_nearest(std::span<const PointQuery> points, std::span<Best> best);

    RayHit hit_of(const RayQuery& ray, const Best& best) const;
    NearestHit hit_of(const PointQuery& query, const Best& best) const;

    WorldState& state_;
    const Shapes& shapes_;
    const Colliders& colliders_;
    std::vector<std::uint32_t> planes_;  // ascending
    LiveBoxes boxes_;
    std::uint64_t step_ = 0;  // of the world, as of the last refresh

    // Of the last refresh: colliders that may have moved, and those of them that left their room.
    std::vector<std::uint32_t> touched_;
    BlockLists<std::uint32_t> left_;

    // Of the questions asked last.
    std::vector<Ray> rays_;
    std::vector<Box3> regions_;
    std::vector<Best> best_;
    Candidates candidates_;
};

}  // namespace throng
