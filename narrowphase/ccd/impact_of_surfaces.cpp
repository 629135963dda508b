#include "narrowphase/ccd/impact_of_surfaces.hpp"

#include "narrowphase/ccd/moving_balls.hpp"
#include "narrowphase/ccd/moving_cores.hpp"
#include "narrowphase/solid/surface_separations.hpp"

namespace throng {
namespace {

Vec3 middle_of(const Box3& box) { return 0.5 * (box.lower + box.upper); }
double extent_of(const Box3& box) { return 0.5 * (box.upper - box.lower).norm(); }

std::array<Vec3, 3> corners_of(const Mesh& mesh, std::uint32_t triangle)
{
    const auto& [u, v, w] = mesh.triangles[triangle];
    return {mesh.vertices[u], mesh.vertices[v], mesh.vertices[w]};
}

// Whether b's triangle stays to one side of the plane of a's, as seen from there.
bool keeps_beside(const MovingBalls& ways,
                  const Vec3& normal,
                  const std::array<Vec3, 3>& of_a,
                  const std::array<Vec3, 3>& of_b,
                  double close,
                  double time)
{
    const Vec3 middle = (of_b[0] + of_b[1] + of_b[2]) / 3;
    double radius = 0;
    std::array<Vec3, 3> seen;
    for (std::size_t i = 0; i < 3; ++i) {
        radius = std::max(radius, (of_b[i] - middle).norm());
        seen[i] = ways.from_b(of_b[i]);
    }
    return beside_plane(normal, of_a, seen, close + ways.drift(middle, radius, time));
}

}  // namespace

Impact impact_of_surfaces(const Mesh& on_a,
                          const MovingShape& a,
                          const Mesh& on_b,
                          const MovingShape& b,
                          double begin,
                          double end,
                          const ImpactRule& rule)
{
    const MovingBalls ways(a, b, begin);
    Impact first;
    first.time = end;
    int evaluations = 0;
    visit_triangle_pairs(
        on_a, on_b,
        [&](const Box3& p, const Box3& q) {
            const double wide = extent_of(p) + extent_of(q) + rule.close;
            const double left = first.time - begin;
            return ways.may_meet(middle_of(p), middle_of(q), wide, left)
                && ways.may_meet(p, q, rule.close, left);
        },
        [&](std::uint32_t p, std::uint32_t q) {
            const auto corners_a = corners_of(on_a, p), corners_b = corners_of(on_b, q);
            const double left = first.time - begin;
            if (keeps_beside(ways, on_a.normals[p], corners_a, corners_b, rule.close, left)) return;
            const MovingCores cores(convex_core_of_points(std::span<const Vec3>(corners_a)), a,
                                    convex_core_of_points(std::span<const Vec3>(corners_b)), b);
            const Impact impact = impact_of_cores(cores, begin, first.time, rule);
            evaluations += impact.evaluations;
            if (impact.state != ToiState::hit) return;
            if (first.state == ToiState::hit && !(impact.time < first.time)) return;
            first = impact;
        });
    first.evaluations = evaluations;
    return first;
}

}  // namespace throng
