#include "pipeline/query_scene.hpp"

#include "kernels/geometry/nearest_point.hpp"
#include "kernels/geometry/ray_cast.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/touching.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kGrain = 64;    // questions a block
constexpr std::size_t kBatch = 8192;  // questions whose candidates are held at one time
// A search begins with this many times the usual size of a box, and goes on to so many times as
// far.
constexpr double kFirstReach = 3;
constexpr double kGrowth = 3;
// Of the numbers of a question and a box: far more than rounding takes.
constexpr double kRounding = 1e-14;

// Scaled first: a direction may be so short or long that its square is 0 or infinite.
Vec3 unit(const Vec3& direction)
{
    const Vec3 scaled = direction / direction.cwiseAbs().maxCoeff();
    return scaled / scaled.norm();
}

Box3 widened(const Box3& box)
{
    const double size = std::max(box.lower.cwiseAbs().maxCoeff(), box.upper.cwiseAbs().maxCoeff());
    const double margin = kRounding * size;
    return {box.lower.array() - margin, box.upper.array() + margin};
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

Box3 cube(const Vec3& middle, double half)
{
    return widened({middle.array() - half, middle.array() + half});
}

// From a point to the box, 0 inside.
double distance_to(const Box3& box, const Vec3& point)
{
    return box.empty() ? 0 : (point - point.cwiseMax(box.lower).cwiseMin(box.upper)).norm();
}

// From a point to the furthest of the box, or a bit more.
double furthest_of(const Box3& box, const Vec3& point)
{
    return ((box.lower - point).cwiseAbs().cwiseMax((box.upper - point).cwiseAbs())).norm();
}

template <class Questions, class Work>
void in_batches(const Questions& questions, const Work& work)
{
    for (std::size_t begin = 0; begin < questions.size(); begin += kBatch)
        work(begin, std::min(kBatch, questions.size() - begin));
}

// The shape of a question, among shapes that hold nothing else.
ShapeRef set_shape(const QueryShape& shape, Shapes& shapes)
{
    struct Setter {
        Shapes& shapes;
        ShapeRef operator()(const SphereShape& s) const
        {
            shapes.spheres.assign(1, {s.radius});
            return {ShapeKind::sphere, 0};
        }
        ShapeRef operator()(const CapsuleShape& s) const
        {
            shapes.capsules.assign(1, {s.radius, s.half_length});
            return {ShapeKind::capsule, 0};
        }
        ShapeRef operator()(const CylinderShape& s) const
        {
            shapes.cylinders.assign(1, {s.radius, s.half_length});
            return {ShapeKind::cylinder, 0};
        }
        ShapeRef operator()(const BoxShape& s) const
        {
            shapes.boxes.assign(1, {s.half_extents});
            return {ShapeKind::box, 0};
        }
    };
    return std::visit(Setter{shapes}, shape);
}

}  // namespace

struct QueryScene::Search {
    Ray ray;                    // as far as to look next
    double reach = -kInfinity;  // m, what has been looked at
    double end = -kInfinity;    // m, where nothing is left to meet
};

QueryScene::QueryScene(const World::State& state)
    // Asking changes nothing that a step would notice, so it may use the world's own threads.
    : pool_(&const_cast<World::State&>(state).pool),  // NOLINT: threads are no part of the state
      shapes_(&state.get<Shapes>())
{
    const Colliders& all = state.get<Colliders>();
    const std::vector<std::uint32_t>& groups = state.get<PairFilter>().group;
    const Poses& poses = state.get<Poses>();
    const BodyStates& states = state.get<BodyStates>();
    std::vector<double> sizes;
    for (std::uint32_t body = 0; body < states.kind.size(); ++body) {
        if (states.kind[body] == BodyKind::gone) continue;
        for (std::uint32_t part = 0; part < all.count[body]; ++part) {
            const std::size_t i = all.begin[body] + part;
            const auto own = static_cast<std::uint32_t>(colliders_.size());
            colliders_.push_back({body, state.generation[body], part, groups[i], all.shape[i],
                                  poses.at(body) * all.local[i]});
            boxes_.emplace_back();
            if (all.shape[i].kind == ShapeKind::plane) {
                planes_.push_back(own);
                continue;
            }
            Box3& box = boxes_.back();
            box = widened(shape_bounds(*shapes_, all.shape[i], colliders_.back().placed));
            bounds_ = {bounds_.lower.cwiseMin(box.lower), bounds_.upper.cwiseMax(box.upper)};
            sizes.push_back((box.upper - box.lower).maxCoeff());
        }
    }
    if (!sizes.empty()) {
        const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
        std::nth_element(sizes.begin(), middle, sizes.end());
        usual_size_ = *middle;
    }
    run([&] { tree_.build(boxes_); });
}

template <class Work>
void QueryScene::run(const Work& work)
{
    pool_->run([&](std::size_t, std::size_t, std::size_t) { work(); });
}

BodyId QueryScene::id(std::uint32_t collider) const
{
    return {colliders_[collider].body, colliders_[collider].generation};
}

// Of equals the first collider, which belongs to the smaller body.
bool QueryScene::beats(double distance, std::uint32_t collider, const Best& best) const
{
    return distance < best.distance || (distance == best.distance && collider < best.collider);
}

void QueryScene::meet(const RayQuery& query,
                      const Ray& ray,
                      std::uint32_t collider,
                      Best& best) const
{
    const Collider& it = colliders_[collider];
    if ((it.group & query.mask) == 0) return;
    const Quat back = it.placed.orientation.conjugate();
    const LocalRay local{back * (ray.from - it.placed.position), back * ray.along,
                         std::min(query.max_distance, best.distance)};
    const RayMeeting met = throng::cast_ray(*shapes_, it.shape, local);
    if (met.found() && beats(met.distance, collider, best))
        best = {met.distance, collider, met.normal};
}

// Boxes in the order in which the ray enters them, until the next one lies beyond the answer.
void QueryScene::meet_candidates(const RayQuery& query,
                                 const Search& search,
                                 std::span<const std::uint32_t> candidates,
                                 Order& order,
                                 Best& best) const
{
    order.clear();
    for (const std::uint32_t collider : candidates) {
        const double enter = part_within(search.ray, boxes_[collider]).first;
        // Entered within what has been looked at: it was a candidate before.
        const bool seen = enter + slack_of(search.ray, enter) < search.reach;
        if (!seen) order.emplace_back(enter, collider);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [enter, collider] : order) {
        if (enter > best.distance + slack_of(search.ray, best.distance)) break;
        meet(query, search.ray, collider, best);
    }
}

QueryScene::Search QueryScene::search_for(const RayQuery& query) const
{
    Search search;
    search.ray = {query.origin, unit(query.direction), 0};
    if (bounds_.empty()) return search;
    const auto [enter, leave] = part_within(search.ray, bounds_);
    if (enter - slack_of(search.ray, enter) > leave) return search;
    const double first = std::max(0.0, enter);
    search.end = std::min(query.max_distance, leave + slack_of(search.ray, leave));
    search.ray.longest = std::min(search.end, first + kFirstReach * usual_size_);
    return search;
}

// Further along the rays from round to round, until what has been looked at holds the answer.
void QueryScene::search_met(std::span<const RayQuery> rays, std::span<Best> best, bool any)
{
    std::vector<std::uint32_t> open;
    std::vector<Search> searches(rays.size());
    const auto is_done = [&](std::uint32_t i) {
        const bool met =
            best[i].collider != kNobody && (any || best[i].distance <= searches[i].reach);
        return met || searches[i].reach >= searches[i].end;
    };
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        searches[i] = search_for(rays[i]);
        for (const std::uint32_t plane : planes_) meet(rays[i], searches[i].ray, plane, best[i]);
        if (searches[i].end >= 0 && !is_done(i)) open.push_back(i);
    }
    while (!open.empty()) {
        rays_.clear();
        for (const std::uint32_t i : open) rays_.push_back(searches[i].ray);
        tree_.meet_rays(rays_, candidates_);
        for_each_block(open.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
            Order order;
            for (std::size_t k = begin; k < end; ++k) {
                const std::uint32_t i = open[k];
                meet_candidates(rays[i], searches[i], candidates_.of(k), order, best[i]);
                Search& search = searches[i];
                search.reach = search.ray.longest;
                search.ray.longest = std::min(search.end, kGrowth * search.reach);
            }
        });
        std::erase_if(open, is_done);
    }
}

void QueryScene::cast_rays(std::span<const RayQuery> rays, std::span<RayHit> hits)
{
    const auto cast_some = [&](std::size_t first, std::size_t count) {
        best_.assign(count, {});
        search_met(rays.subspan(first, count), best_, false);
        for (std::size_t i = 0; i < count; ++i) {
            const Best& best = best_[i];
            const RayQuery& ray = rays[first + i];
            RayHit& hit = hits[first + i];
            hit = {};
            if (best.collider == kNobody) continue;
            const Collider& it = colliders_[best.collider];
            hit = {true,
                   id(best.collider),
                   it.part,
                   best.distance,
                   ray.origin + unit(ray.direction) * best.distance,
                   it.placed.orientation * best.local};
        }
    };
    run([&] { in_batches(rays, cast_some); });
}

void QueryScene::find_blocked(std::span<const RayQuery> rays, std::span<std::uint8_t> blocked)
{
    const auto cast_some = [&](std::size_t first, std::size_t count) {
        best_.assign(count, {});
        search_met(rays.subspan(first, count), best_, true);
        for (std::size_t i = 0; i < count; ++i)
            blocked[first + i] = best_[i].collider != kNobody ? 1 : 0;
    };
    run([&] { in_batches(rays, cast_some); });
}

void QueryScene::find_overlaps(std::span<const ShapeQuery> queries,
                               std::span<std::vector<BodyId>> found)
{
    const auto find_some = [&](std::size_t first, std::size_t count) {
        regions_.resize(count);
        Shapes own;
        for (std::size_t i = 0; i < count; ++i) {
            const ShapeQuery& query = queries[first + i];
            regions_[i] = widened(shape_bounds(own, set_shape(query.shape, own), query.pose));
        }
        tree_.meet_boxes(regions_, candidates_);
        for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
            Shapes asked;
            for (std::size_t i = begin; i < end; ++i) {
                const ShapeQuery& query = queries[first + i];
                const ShapeRef shape = set_shape(query.shape, asked);
                std::vector<BodyId>& bodies = found[first + i];
                const auto try_one = [&](std::uint32_t collider) {
                    const Collider& it = colliders_[collider];
                    if ((it.group & query.mask) == 0) return;
                    const Pose in_query{query.pose.to_local(it.placed.position),
                                        query.pose.orientation.conjugate() * it.placed.orientation};
                    if (touching(asked, shape, *shapes_, it.shape, in_query))
                        bodies.push_back(id(collider));
                };
                for (const std::uint32_t plane : planes_) try_one(plane);
                for (const std::uint32_t collider : candidates_.of(i)) try_one(collider);
                std::sort(bodies.begin(), bodies.end(),
                          [](const BodyId& a, const BodyId& b) { return a.index < b.index; });
                bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
            }
        });
    };
    run([&] { in_batches(queries, find_some); });
}

void QueryScene::approach(const PointQuery& query, std::uint32_t collider, Best& best) const
{
    const Collider& it = colliders_[collider];
    if ((it.group & query.mask) == 0) return;
    const double limit = std::min(query.max_distance, best.distance);
    const NearestPoint nearest =
        nearest_point(*shapes_, it.shape, it.placed.to_local(query.point), limit);
    if (nearest.distance <= limit && beats(nearest.distance, collider, best))
        best = {nearest.distance, collider, nearest.point};
}

// Cubes about the points, larger from round to round, until a cube holds the ball up to the answer.
void QueryScene::search_nearest(std::span<const PointQuery> points, std::span<Best> best)
{
    std::vector<std::uint32_t> open;
    std::vector<double> radius(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        for (const std::uint32_t plane : planes_) approach(points[i], plane, best[i]);
        radius[i] = distance_to(bounds_, points[i].point) + usual_size_;
        if (!bounds_.empty()) open.push_back(i);
    }
    while (!open.empty()) {
        regions_.clear();
        for (const std::uint32_t i : open) {
            radius[i] = std::min({radius[i], points[i].max_distance, best[i].distance});
            regions_.push_back(cube(points[i].point, radius[i]));
        }
        tree_.meet_boxes(regions_, candidates_);
        for_each_block(open.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t k = begin; k < end; ++k)
                for (const std::uint32_t collider : candidates_.of(k))
                    approach(points[open[k]], collider, best[open[k]]);
        });
        std::erase_if(open, [&](std::uint32_t i) {
            const double known = radius[i];
            radius[i] *= kGrowth;
            return best[i].distance <= known || points[i].max_distance <= known
                || furthest_of(bounds_, points[i].point) <= known;
        });
    }
}

void QueryScene::find_nearest(std::span<const PointQuery> points, std::span<NearestHit> nearest)
{
    const auto find_some = [&](std::size_t first, std::size_t count) {
        best_.assign(count, {});
        search_nearest(points.subspan(first, count), best_);
        for (std::size_t i = 0; i < count; ++i) {
            NearestHit& hit = nearest[first + i];
            hit = {};
            const Best& best = best_[i];
            if (best.collider == kNobody) continue;
            const Collider& it = colliders_[best.collider];
            const bool inside = best.distance == 0;
            hit = {true, id(best.collider), it.part, best.distance,
                   inside ? points[first + i].point : Vec3(it.placed * best.local)};
        }
    };
    run([&] { in_batches(points, find_some); });
}

}  // namespace throng
