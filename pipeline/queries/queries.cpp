#include "throng/queries.hpp"

#include "pipeline/queries/query_scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace throng {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

[[noreturn]] void refuse(const char* caller, std::size_t at, const char* why)
{
    throw std::invalid_argument(std::string(caller) + ": question " + std::to_string(at) + ": "
                                + why);
}

void check(const char* caller, std::span<const RayQuery> rays)
{
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const RayQuery& ray = rays[i];
        if (!ray.origin.allFinite()) refuse(caller, i, "origin is not finite; give a point in m");
        if (!ray.direction.allFinite() || ray.direction.isZero(0))
            refuse(caller, i, "direction has no length or is not finite; give one that leads on");
        if (!(ray.max_distance >= 0))
            refuse(caller, i, "max_distance is below 0 or no number; give a distance in m");
    }
}

void check(const char* caller, std::span<const PointQuery> points)
{
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!points[i].point.allFinite())
            refuse(caller, i, "point is not finite; give a point in m");
        if (!(points[i].max_distance >= 0))
            refuse(caller, i, "max_distance is below 0 or no number; give a distance in m");
    }
}

void check_lengths(const char* caller, std::size_t questions, std::size_t answers)
{
    if (questions != answers)
        throw std::invalid_argument(std::string(caller) + ": " + std::to_string(questions)
                                    + " questions and room for " + std::to_string(answers)
                                    + " answers; give as many");
}

bool has_size(const QueryShape& shape)
{
    const auto good = [](double size) { return size >= 0 && size < kInfinity; };
    struct Asker {
        const decltype(good)& is_good;
        bool operator()(const SphereShape& s) const { return is_good(s.radius); }
        bool operator()(const CapsuleShape& s) const
        {
            return is_good(s.radius) && is_good(s.half_length);
        }
        bool operator()(const CylinderShape& s) const
        {
            return is_good(s.radius) && is_good(s.half_length);
        }
        bool operator()(const BoxShape& s) const
        {
            return is_good(s.half_extents.minCoeff()) && s.half_extents.allFinite();
        }
    };
    return std::visit(Asker{good}, shape);
}

void check(const char* caller, std::span<const ShapeQuery> queries)
{
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const Pose& pose = queries[i].pose;
        if (!has_size(queries[i].shape)) refuse(caller, i, "give sizes of at least 0 m, finite");
        if (!pose.position.allFinite() || !(std::abs(pose.orientation.coeffs().norm() - 1) < 1e-6))
            refuse(caller, i, "give a finite position and a unit quaternion");
    }
}

}  // namespace

struct Queries::Inside {
    // Asking changes nothing that a step would notice.
    explicit Inside(const WorldState& world)
        : state(const_cast<WorldState&>(world))  // NOLINT: what questions go by is no part of it
    {
        if (state.queries == nullptr) state.queries = std::make_shared<QueryScene>(state);
    }
    QueryScene& now() const
    {
        state.queries->refresh();
        return *state.queries;
    }
    WorldState& state;
};

Queries::Queries(const World& world) : inside_(std::make_unique<Inside>(state_of(world))) { }
Queries::~Queries() = default;
Queries::Queries(Queries&&) noexcept = default;
Queries& Queries::operator=(Queries&&) noexcept = default;

void Queries::cast_rays(std::span<const RayQuery> rays, std::span<RayHit> hits)
{
    check_lengths("cast_rays", rays.size(), hits.size());
    check("cast_rays", rays);
    const Door::Entry entry(inside_->state.door, "cast_rays", Door::Use::looks);
    inside_->now().cast_rays(rays, hits);
}

RayHit Queries::cast_ray(const RayQuery& ray)
{
    RayHit hit;
    cast_rays({&ray, 1}, {&hit, 1});
    return hit;
}

void Queries::find_blocked(std::span<const RayQuery> rays, std::span<std::uint8_t> blocked)
{
    check_lengths("find_blocked", rays.size(), blocked.size());
    check("find_blocked", rays);
    const Door::Entry entry(inside_->state.door, "find_blocked", Door::Use::looks);
    inside_->now().find_blocked(rays, blocked);
}

bool Queries::blocked(const RayQuery& ray)
{
    std::uint8_t answer = 0;
    find_blocked({&ray, 1}, {&answer, 1});
    return answer != 0;
}

std::vector<std::vector<BodyId>> Queries::find_overlaps(std::span<const ShapeQuery> shapes)
{
    check("find_overlaps", shapes);
    std::vector<std::vector<BodyId>> found(shapes.size());
    const Door::Entry entry(inside_->state.door, "find_overlaps", Door::Use::looks);
    inside_->now().find_overlaps(shapes, found);
    return found;
}

std::vector<BodyId> Queries::find_overlaps(const ShapeQuery& shape)
{
    return std::move(find_overlaps(std::span(&shape, 1)).front());
}

void Queries::find_nearest(std::span<const PointQuery> points, std::span<NearestHit> nearest)
{
    check_lengths("find_nearest", points.size(), nearest.size());
    check("find_nearest", points);
    const Door::Entry entry(inside_->state.door, "find_nearest", Door::Use::looks);
    inside_->now().find_nearest(points, nearest);
}

NearestHit Queries::find_nearest(const PointQuery& point)
{
    NearestHit nearest;
    find_nearest({&point, 1}, {&nearest, 1});
    return nearest;
}

}  // namespace throng
