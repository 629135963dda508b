#include "pipeline/queries/query_scene.hpp"

#include "kernels/geometry/nearest_point.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/touching.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// A search goes on to so many times as far from round to round.
constexpr double kGrowth = 3;
// Of the numbers of a question and a box: far more than rounding takes.
constexpr double kRounding = 1e-14;

Box3 widened(const Box3& box)
{
    const double size = std::max(box.lower.cwiseAbs().maxCoeff(), box.upper.cwiseAbs().maxCoeff());
    const double margin = kRounding * size;
    return {box.lower.array() - margin, box.upper.array() + margin};
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

// From a point to the furthest corner of the box.
double furthest_of(const Box3& box, const Vec3& point)
{
    return ((box.lower - point).cwiseAbs().cwiseMax((box.upper - point).cwiseAbs())).norm();
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

QueryScene::QueryScene(const WorldState& state)
    // Asking changes nothing that a step would notice, so it may use the world's own threads.
    : pool_(&const_cast<WorldState&>(state).pool),  // NOLINT: threads are no part of the state
      shapes_(&state.get<Shapes>())
{
    const auto& all = state.get<Colliders>();
    const std::vector<std::uint32_t>& groups = state.get<PairFilter>().group;
    const auto& poses = state.get<Poses>();
    const auto& states = state.get<BodyStates>();
    std::vector<double> sizes;
    for (std::uint32_t body = 0; body < states.kind.size(); ++body) {
        if (states.kind[body] == BodyKind::removed) continue;
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
    pool_->run([&](std::size_t, std::size_t, std::size_t) { tree_.build(boxes_); });
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

NearestHit QueryScene::hit_of(const PointQuery& query, const Best& best) const
{
    if (best.collider == kNoBody) return {};
    const Collider& it = colliders_[best.collider];
    const bool inside = best.distance == 0;
    return {true, id(best.collider), it.part, best.distance,
            inside ? query.point : Vec3(it.placed * best.local)};
}

void QueryScene::overlap(const ShapeQuery& query,
                         std::span<const std::uint32_t> candidates,
                         Shapes& asked,
                         std::vector<BodyId>& found) const
{
    const ShapeRef shape = set_shape(query.shape, asked);
    const Quat turn(query.pose.orientation.normalized());
    const Pose pose{query.pose.position, turn};
    const auto try_one = [&](std::uint32_t collider) {
        const Collider& it = colliders_[collider];
        if ((it.group & query.mask) == 0) return;
        const Pose in_query{pose.to_local(it.placed.position),
                            turn.conjugate() * it.placed.orientation};
        if (touching(asked, shape, *shapes_, it.shape, in_query)) found.push_back(id(collider));
    };
    for (const std::uint32_t plane : planes_) try_one(plane);
    for (const std::uint32_t collider : candidates) try_one(collider);
    std::sort(found.begin(), found.end(),
              [](const BodyId& a, const BodyId& b) { return a.index < b.index; });
    found.erase(std::unique(found.begin(), found.end()), found.end());
}

void QueryScene::find_overlaps(std::span<const ShapeQuery> queries,
                               std::span<std::vector<BodyId>> found)
{
    const auto find_some = [&](std::size_t first, std::size_t count) {
        regions_.resize(count);
        for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
            Shapes asked;
            for (std::size_t i = begin; i < end; ++i) {
                const ShapeQuery& query = queries[first + i];
                const Pose pose{query.pose.position, query.pose.orientation.normalized()};
                regions_[i] = widened(shape_bounds(asked, set_shape(query.shape, asked), pose));
            }
        });
        tree_.meet_boxes(regions_, candidates_);
        for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
            Shapes asked;
            for (std::size_t i = begin; i < end; ++i)
                overlap(queries[first + i], candidates_.of(i), asked, found[first + i]);
        });
    };
    run_in_batches(queries.size(), find_some);
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
        for (std::size_t i = 0; i < count; ++i)
            nearest[first + i] = hit_of(points[first + i], best_[i]);
    };
    run_in_batches(points.size(), find_some);
}

}  // namespace throng
