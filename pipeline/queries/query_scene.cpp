#include "pipeline/queries/query_scene.hpp"

#include "kernels/geometry/nearest_point.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/touching.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace throng {
namespace {

// A search goes on to so many times as far from round to round.
constexpr double kGrowth = 3;
// Of the numbers of a question and a box: far more than rounding takes.
constexpr double kRounding = 1e-14;
constexpr std::size_t kTouched = 1024;  // colliders a block: some 50 microseconds

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

QueryScene::QueryScene(WorldState& state)
    : state_(state), shapes_(state.get<Shapes>()), colliders_(state.get<Colliders>())
{
    state_.moved.all = true;
}

void QueryScene::refresh()
{
    MovedColliders& moved = state_.moved;
    const bool stepped = state_.report.step != step_;
    if (!stepped && !moved.all && moved.some.empty()) return;
    boxes_.resize(colliders_.size());
    find_touched(stepped);
    state_.pool.run([&](std::size_t, std::size_t, std::size_t) {
        const std::size_t blocks = block_count(touched_.size(), kTouched);
        left_.start(blocks);
        for_each_block(touched_.size(), kTouched, [&](auto begin, auto end, std::size_t block) {
            for (std::size_t i = begin; i < end; ++i)
                if (moved.all || !stays(touched_[i])) left_[block].push_back(touched_[i]);
        });
        for (std::size_t block = 0; block < blocks; ++block)
            for (const std::uint32_t collider : left_[block]) put(collider);
        boxes_.settle();
    });
    moved.all = false;
    moved.some.clear();
    step_ = state_.report.step;
}

void QueryScene::find_touched(bool stepped)
{
    const MovedColliders& moved = state_.moved;
    if (moved.all) {
        touched_.resize(colliders_.size());
        std::iota(touched_.begin(), touched_.end(), 0u);
        return;
    }
    touched_ = moved.some;
    if (!stepped) return;
    const ActiveBodies& active = state_.get<BodyStates>().active_bodies;
    for (const auto* bodies : {&active.dynamic, &active.kinematic})
        for (const std::uint32_t body : *bodies)
            for (std::uint32_t part = 0; part < colliders_.count[body]; ++part)
                touched_.push_back(colliders_.begin[body] + part);
}

// Nearly all that move do.
bool QueryScene::stays(std::uint32_t collider) const
{
    return colliders_.body[collider] != kNoBody
        && colliders_.shape[collider].kind != ShapeKind::plane
        && boxes_.stays(collider, box_of(collider));
}

Box3 QueryScene::box_of(std::uint32_t collider) const
{
    return widened(shape_bounds(shapes_, colliders_.shape[collider], placed(collider)));
}

// Who moves has room for what it may do in a while, or less where it is slow.
void QueryScene::put(std::uint32_t collider)
{
    constexpr double kWhile = 0.2;   // s
    constexpr double kAround = 0.1;  // of its smallest half extent
    const std::uint32_t body = colliders_.body[collider];
    const bool plane = body != kNoBody && colliders_.shape[collider].kind == ShapeKind::plane;
    const auto at = std::lower_bound(planes_.begin(), planes_.end(), collider);
    const bool known = at != planes_.end() && *at == collider;
    if (plane && !known) planes_.insert(at, collider);
    if (!plane && known) planes_.erase(at);
    if (body == kNoBody || plane) return boxes_.put(collider, {}, Vec3::Zero(), 0);
    const Box3 box = box_of(collider);
    if (!state_.get<BodyStates>().moves(body)) return boxes_.put(collider, box, Vec3::Zero(), 0);
    boxes_.put(collider, box, kWhile * state_.get<Velocities>().linear[body],
               kAround * colliders_.inner_extent[collider]);
}

Pose QueryScene::placed(std::uint32_t collider) const
{
    return state_.get<Poses>().at(colliders_.body[collider]) * colliders_.local[collider];
}

bool QueryScene::is_asked(std::uint32_t collider, std::uint32_t mask) const
{
    return (state_.get<PairFilter>().group[collider] & mask) != 0;
}

// Of equals the smaller body, and the first of its parts.
bool QueryScene::beats(double distance, std::uint32_t collider, const Best& best) const
{
    if (distance != best.distance || best.collider == kNoBody) return distance < best.distance;
    const std::uint32_t a = colliders_.body[collider], b = colliders_.body[best.collider];
    return a < b || (a == b && collider < best.collider);
}

NearestHit QueryScene::hit_of(const PointQuery& query, const Best& best) const
{
    if (best.collider == kNoBody) return {};
    const bool inside = best.distance == 0;
    const auto [body, part] = state_.owner_of(best.collider);
    return {true, body, part, best.distance,
            inside ? query.point : Vec3(placed(best.collider) * best.local)};
}

bool QueryScene::overlaps(const Shapes& shapes,
                          ShapeRef shape,
                          const Pose& pose,
                          std::uint32_t collider) const
{
    const Pose at = placed(collider);
    const Pose in_shape{pose.to_local(at.position), pose.orientation.conjugate() * at.orientation};
    return touching(shapes, shape, shapes_, colliders_.shape[collider], in_shape);
}

void QueryScene::overlap(const ShapeQuery& query,
                         std::span<const std::uint32_t> candidates,
                         Shapes& asked,
                         std::vector<BodyId>& found) const
{
    const ShapeRef shape = set_shape(query.shape, asked);
    const Pose pose{query.pose.position, query.pose.orientation.normalized()};
    const auto try_one = [&](std::uint32_t collider) {
        if (!is_asked(collider, query.mask)) return;
        if (overlaps(asked, shape, pose, collider)) found.push_back(state_.owner_of(collider).body);
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
        boxes_.meet_boxes(regions_, candidates_);
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
    if (!is_asked(collider, query.mask)) return;
    const double limit = std::min(query.max_distance, best.distance);
    const NearestPoint nearest = nearest_point(shapes_, colliders_.shape[collider],
                                               placed(collider).to_local(query.point), limit);
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
        radius[i] = distance_to(boxes_.bounds(), points[i].point) + boxes_.usual_size();
        if (!boxes_.bounds().empty()) open.push_back(i);
    }
    while (!open.empty()) {
        regions_.clear();
        for (const std::uint32_t i : open) {
            radius[i] = std::min({radius[i], points[i].max_distance, best[i].distance});
            regions_.push_back(cube(points[i].point, radius[i]));
        }
        boxes_.meet_boxes(regions_, candidates_);
        for_each_block(open.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t k = begin; k < end; ++k)
                for (const std::uint32_t collider : candidates_.of(k))
                    approach(points[open[k]], collider, best[open[k]]);
        });
        std::erase_if(open, [&](std::uint32_t i) {
            const double known = radius[i];
            radius[i] *= kGrowth;
            return best[i].distance <= known || points[i].max_distance <= known
                || furthest_of(boxes_.bounds(), points[i].point) <= known;
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
