// Queries: what a ray meets, what overlaps a shape, what is nearest to a point.
//
// All of them see every body that has a shape, asleep and static ones included, whose group has a
// bit in the question's mask. Solids include their surface; a plane is solid below; a mesh is its
// triangles, with nothing inside. Where two bodies answer alike, the one with the smaller id does.
#pragma once

#include "throng/world.hpp"

#include <limits>
#include <variant>

namespace throng {

struct RayQuery {
    Vec3 origin = Vec3::Zero();
    Vec3 direction = Vec3::UnitZ();                                 // of any length but 0
    double max_distance = std::numeric_limits<double>::infinity();  // m
    std::uint32_t mask = ~0u;
};

/// The first point of a body that a ray meets.
///
///   part      which of the body's shapes: 0 but for compounds, whose parts count from 0
///   distance  m, from the origin
///   normal    unit, out of the body; of a mesh, of the side that the ray comes from
///
/// A ray that begins inside a solid (or at its surface, on the way out) meets it at distance 0,
/// with the normal opposite to its direction.
struct RayHit {
    bool hit = false;
    BodyId body;
    std::uint32_t part = 0;
    double distance = std::numeric_limits<double>::infinity();
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
};

/// Sizes may be 0: a sphere of no radius is a point.
using QueryShape = std::variant<SphereShape, CapsuleShape, CylinderShape, BoxShape>;

struct ShapeQuery {
    QueryShape shape;
    Pose pose;
    std::uint32_t mask = ~0u;
};

struct PointQuery {
    Vec3 point = Vec3::Zero();
    double max_distance = std::numeric_limits<double>::infinity();  // m
    std::uint32_t mask = ~0u;
};

/// The point of a body nearest to another. distance: m; 0 inside a solid, where the point asked
/// about is its own nearest.
struct NearestHit {
    bool found = false;
    BodyId body;
    std::uint32_t part = 0;
    double distance = std::numeric_limits<double>::infinity();
    Vec3 point = Vec3::Zero();
};

/// Answers for a world as it is when it is asked. The first question of all takes about as long as
/// a broad phase; the first after a step, or after bodies were added, removed or moved, looks at
/// those that moved alone. Ask in batches, which run on the world's threads. Answers are the same
/// bits for any number of them.
///
/// The world must outlive its queries. One thread at a time, whatever number of Queries a world
/// has, and none while it is stepped or changed, which throws std::logic_error. Questions that are
/// not numbers, or a direction of length 0, throw std::invalid_argument, naming the question, and
/// so do spans of different lengths.
class Queries {
public:
    explicit Queries(const World& world);
    ~Queries();
    Queries(Queries&&) noexcept;
    Queries& operator=(Queries&&) noexcept;

    /// The nearest hit of each ray.
    void cast_rays(std::span<const RayQuery> rays, std::span<RayHit> hits);
    RayHit cast_ray(const RayQuery& ray);

    /// 1 for each ray that meets anything, else 0: for lines of sight, in less time.
    void find_blocked(std::span<const RayQuery> rays, std::span<std::uint8_t> blocked);
    bool blocked(const RayQuery& ray);

    /// For each shape the bodies that share a point with it, ascending by index, each once.
    std::vector<std::vector<BodyId>> find_overlaps(std::span<const ShapeQuery> shapes);
    std::vector<BodyId> find_overlaps(const ShapeQuery& shape);

    /// For each point the body nearest to it.
    void find_nearest(std::span<const PointQuery> points, std::span<NearestHit> nearest);
    NearestHit find_nearest(const PointQuery& point);

private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

}  // namespace throng
