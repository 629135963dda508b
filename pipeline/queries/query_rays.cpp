// Query rays: what rays meet. They are followed a little further from round to round, as few of
// them go on for long in a crowd.
#include "kernels/geometry/ray_cast.hpp"
#include "pipeline/queries/query_scene.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A search begins with this many times the usual size of a box and grows so fast. Half or twice the
// first is no faster in a pile.
constexpr double kFirstReach = 2;
constexpr double kGrowth = 3;

// Scaled first: a direction may be so short or long that its square is 0 or infinite.
Vec3 unit(const Vec3& direction)
{
    const Vec3 scaled = direction / direction.cwiseAbs().maxCoeff();
    return scaled / scaled.norm();
}

// The part of a ray's line within a box that it meets, in m from the ray's start; good to rounding,
// and so to put boxes in order.
std::pair<double, double> part_within(const Ray& ray, const Box3& box)
{
    double enter = -kInfinity, leave = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
        const double along = ray.along[axis];
        if (along == 0) continue;
        const double low = (box.lower[axis] - ray.from[axis]) / along;
        const double high = (box.upper[axis] - ray.from[axis]) / along;
        enter = std::max(enter, std::min(low, high));
        leave = std::min(leave, std::max(low, high));
    }
    return {enter, leave};
}

// How far off a distance along a ray may be.
double slack_of(const Ray& ray, double distance)
{
    return 1e-12 * (ray.from.cwiseAbs().maxCoeff() + std::abs(distance));
}

}  // namespace

struct QueryScene::Search {
    Ray ray;                       // as far as to look next
    double searched = -kInfinity;  // m, what has been looked at
    double end = -kInfinity;       // m, where nothing is left to meet
    double first = 0;              // m, where the boxes begin
    double stride = 0;             // m, how far from there to look next
};

void QueryScene::cast(const RayQuery& query,
                      const Ray& ray,
                      std::uint32_t collider,
                      Best& best) const
{
    if (!is_asked(collider, query.mask)) return;
    const Pose at = placed(collider);
    const Quat back = at.orientation.conjugate();
    const LocalRay local{back * (ray.from - at.position), back * ray.along,
                         std::min(query.max_distance, best.distance)};
    const LocalRayHit met = throng::cast_ray(shapes_, colliders_.shape[collider], local);
    if (met.found() && beats(met.distance, collider, best))
        best = {met.distance, collider, met.normal};
}

// Boxes in the order in which the ray enters them, until the next one lies beyond the answer.
void QueryScene::cast_at_candidates(const RayQuery& query,
                                    const Search& search,
                                    std::span<const std::uint32_t> candidates,
                                    Order& order,
                                    Best& best) const
{
    order.clear();
    for (const std::uint32_t collider : candidates) {
        const double enter = part_within(search.ray, boxes_.held(collider)).first;
        // Entered within what has been looked at: it was a candidate before.
        const bool seen = enter + slack_of(search.ray, enter) < search.searched;
        if (!seen) order.emplace_back(enter, collider);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [enter, collider] : order) {
        if (enter > best.distance + slack_of(search.ray, best.distance)) break;
        cast(query, search.ray, collider, best);
    }
}

QueryScene::Search QueryScene::search_for(const RayQuery& query) const
{
    Search search;
    search.ray = {query.origin, unit(query.direction), 0};
    if (boxes_.bounds().empty()) return search;
    const auto [enter, leave] = part_within(search.ray, boxes_.bounds());
    if (enter - slack_of(search.ray, enter) > leave) return search;
    search.first = std::max(0.0, enter);
    search.stride = kFirstReach * boxes_.usual_size();
    search.end = std::min(query.max_distance, leave + slack_of(search.ray, leave));
    search.ray.longest = std::min(search.end, search.first + search.stride);
    return search;
}

// Further along the rays from round to round, until what has been looked at holds the answer.
void QueryScene::search_met(std::span<const RayQuery> rays, std::span<Best> best, bool any)
{
    std::vector<std::uint32_t> open;
    std::vector<Search> searches(rays.size());
    const auto is_done = [&](std::uint32_t i) {
        const bool met =
            best[i].collider != kNoBody && (any || best[i].distance <= searches[i].searched);
        return met || searches[i].searched >= searches[i].end;
    };
    for_each_block(rays.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            searches[i] = search_for(rays[i]);
            for (const std::uint32_t plane : planes_)
                cast(rays[i], searches[i].ray, plane, best[i]);
        }
    });
    for (std::uint32_t i = 0; i < rays.size(); ++i)
        if (searches[i].end >= 0 && !is_done(i)) open.push_back(i);
    while (!open.empty()) {
        rays_.clear();
        for (const std::uint32_t i : open) rays_.push_back(searches[i].ray);
        boxes_.meet_rays(rays_, candidates_);
        for_each_block(open.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
            Order order;
            for (std::size_t k = begin; k < end; ++k) {
                const std::uint32_t i = open[k];
                cast_at_candidates(rays[i], searches[i], candidates_.of(k), order, best[i]);
                Search& search = searches[i];
                search.searched = search.ray.longest;
                search.stride *= kGrowth;
                search.ray.longest = std::min(search.end, search.first + search.stride);
            }
        });
        std::erase_if(open, is_done);
    }
}

RayHit QueryScene::hit_of(const RayQuery& ray, const Best& best) const
{
    if (best.collider == kNoBody) return {};
    const auto [body, part] = state_.owner_of(best.collider);
    return {true,
            body,
            part,
            best.distance,
            ray.origin + unit(ray.direction) * best.distance,
            placed(best.collider).orientation * best.local};
}

void QueryScene::cast_rays(std::span<const RayQuery> rays, std::span<RayHit> hits)
{
    const auto cast_some = [&](std::size_t first, std::size_t count) {
        best_.assign(count, {});
        search_met(rays.subspan(first, count), best_, false);
        for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i)
                hits[first + i] = hit_of(rays[first + i], best_[i]);
        });
    };
    run_in_batches(rays.size(), cast_some);
}

void QueryScene::find_blocked(std::span<const RayQuery> rays, std::span<std::uint8_t> blocked)
{
    const auto cast_some = [&](std::size_t first, std::size_t count) {
        best_.assign(count, {});
        search_met(rays.subspan(first, count), best_, true);
        for (std::size_t i = 0; i < count; ++i)
            blocked[first + i] = best_[i].collider != kNoBody ? 1 : 0;
    };
    run_in_batches(rays.size(), cast_some);
}

}  // namespace throng
