#include "cooking/hulls/hull_faces.hpp"

#include "cooking/hulls/hull_rings.hpp"

#include <algorithm>
#include <numeric>

namespace throng {
namespace {

constexpr std::uint32_t kNone = 0xffffffffU;
// A region that is no convex polygon is tried again with a tolerance this much smaller.
constexpr double kStricter = 0.125;
constexpr int kTries = 4;
// What rounding to the grid may hide, above and below: twice what it moves two points by.
constexpr double kGrid = 1e-11;

struct Candidate {
    Vec3 normal = Vec3::Zero();
    std::uint32_t highest = 0;
    std::vector<std::uint32_t> triangles;
};

class Merger {
public:
    Merger(std::span<const Vec3> points, const TriangleHull& hull, double tolerance)
        : points_(points), hull_(hull), tolerance_(tolerance), rings_(points, hull),
          next_(points.size(), kNone), seen_(points.size(), 0), taken_(hull.triangles.size(), 0),
          visit_(hull.triangles.size(), 0)
    {
        for (const auto& [a, b, c] : hull.triangles)
            areas_.push_back((points[b] - points[a]).cross(points[c] - points[a]));
    }

    std::vector<HullFace> merge()
    {
        std::vector<std::uint32_t> seeds(areas_.size());
        std::iota(seeds.begin(), seeds.end(), 0U);
        std::stable_sort(seeds.begin(), seeds.end(), [&](std::uint32_t a, std::uint32_t b) {
            return areas_[a].squaredNorm() > areas_[b].squaredNorm();
        });
        std::vector<HullFace> faces;
        for (const std::uint32_t seed : seeds)
            if (!taken_[seed]) faces.push_back(face_round(seed));
        return faces;
    }

private:
    HullFace face_round(std::uint32_t seed)
    {
        double tolerance = tolerance_;
        for (int i = 0; i < kTries && tolerance > 0; ++i, tolerance *= kStricter) {
            const Candidate candidate = best_region(seed, tolerance);
            if (candidate.triangles.size() < 2) {
                taken_[seed] = 1;
                return triangle_face(seed, candidate.highest);
            }
            std::vector<std::uint32_t> corners = rim(candidate.triangles);
            if (corners.empty() || !is_convex(corners, candidate.normal, tolerance)) continue;
            for (const std::uint32_t triangle : candidate.triangles) taken_[triangle] = 1;
            return {std::move(corners), candidate.normal, candidate.highest};
        }
        taken_[seed] = 1;
        return triangle_face(seed, highest(areas_[seed].normalized(), hull_.triangles[seed][0]));
    }

    HullFace triangle_face(std::uint32_t triangle, std::uint32_t top) const
    {
        const auto& [a, b, c] = hull_.triangles[triangle];
        return {{a, b, c}, areas_[triangle].normalized(), top};
    }

    // The region in the seed's plane, then in the plane that fits that region best, while it grows.
    Candidate best_region(std::uint32_t seed, double tolerance)
    {
        Candidate best = region(seed, areas_[seed].normalized(), tolerance);
        for (int i = 0; i < 3 && best.triangles.size() > 1; ++i) {
            Vec3 sum = Vec3::Zero();
            for (const std::uint32_t triangle : best.triangles) sum += areas_[triangle];
            Candidate fitted = region(seed, sum.normalized(), tolerance);
            const bool grown = fitted.triangles.size() > best.triangles.size();
            if (fitted.triangles.size() >= best.triangles.size()) best = std::move(fitted);
            if (!grown) break;
        }
        return best;
    }

    // The triangles that hang together with the seed and lie in the plane across the normal.
    Candidate region(std::uint32_t seed, const Vec3& normal, double tolerance)
    {
        Candidate found{normal, highest(normal, hull_.triangles[seed][0]), {}};
        ++visits_;
        const auto take = [&](std::uint32_t triangle) {
            if (visit_[triangle] == visits_ || taken_[triangle]) return;
            if (!lies_in_plane(triangle, found, tolerance)) return;
            visit_[triangle] = visits_;
            found.triangles.push_back(triangle);
        };
        take(seed);
        for (std::size_t i = 0; i < found.triangles.size(); ++i)
            for (const std::uint32_t beyond : hull_.adjacent[found.triangles[i]]) take(beyond);
        return found;
    }

    bool lies_in_plane(std::uint32_t triangle, const Candidate& plane, double tolerance) const
    {
        double longest = 0;
        const auto& corners = hull_.triangles[triangle];
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& corner = points_[corners[k]];
            if (plane.normal.dot(points_[plane.highest] - corner) > tolerance) return false;
            longest = std::max(longest, (points_[corners[(k + 1) % 3]] - corner).squaredNorm());
        }
        // Facing the other way is for slivers alone, whose normal means nothing.
        const double facing = plane.normal.dot(areas_[triangle]);
        return facing >= 0 || facing * facing <= tolerance * tolerance * longest;
    }

    // The corner of the hull farthest along the direction: uphill from corner to corner, which on
    // a convex hull leads to the top, or, as points were rounded to a grid before they had a hull,
    // to corners nearly as high that hang together with it.
    std::uint32_t highest(const Vec3& direction, std::uint32_t start)
    {
        const auto height = [&](std::uint32_t corner) { return direction.dot(points_[corner]); };
        std::uint32_t best = start;
        double top = height(best);
        const auto take = [&](std::uint32_t corner, double own) {
            if (own > top) best = corner, top = own;
        };
        for (std::uint32_t from = kNone; from != best;) {
            from = best;
            rings_.visit_high(from, direction, top,
                              [&](std::uint32_t other) { take(other, height(other)); });
        }
        const double level = top - kGrid;
        ++climbs_;
        seen_[best] = climbs_;
        high_.assign(1, best);
        for (std::size_t i = 0; i < high_.size(); ++i)
            rings_.visit_high(high_[i], direction, level, [&](std::uint32_t other) {
                const double own = height(other);
                if (seen_[other] == climbs_ || own < level) return;
                seen_[other] = climbs_;
                high_.push_back(other);
                take(other, own);
            });
        return best;
    }

    // The corners round the region last found, or none where it is not one piece without holes.
    std::vector<std::uint32_t> rim(const std::vector<std::uint32_t>& triangles)
    {
        std::vector<std::uint32_t> starts;
        bool simple = true;
        for (const std::uint32_t triangle : triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                if (visit_[hull_.adjacent[triangle][k]] == visits_) continue;
                const std::uint32_t from = hull_.triangles[triangle][k];
                simple = simple && next_[from] == kNone;
                next_[from] = hull_.triangles[triangle][(k + 1) % 3];
                starts.push_back(from);
            }
        std::vector<std::uint32_t> corners;
        for (std::uint32_t at = starts.front(); simple && corners.size() < starts.size();) {
            corners.push_back(at);
            at = next_[at];
            if (at == starts.front()) break;
        }
        simple = simple && corners.size() == starts.size();
        for (const std::uint32_t from : starts) next_[from] = kNone;
        if (!simple) corners.clear();
        return corners;
    }

    bool
    is_convex(const std::vector<std::uint32_t>& corners, const Vec3& normal, double tolerance) const
    {
        const std::size_t count = corners.size();
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3& from = points_[corners[i]];
            const Vec3 chord = points_[corners[(i + 2) % count]] - from;
            const Vec3 arm = points_[corners[(i + 1) % count]] - from;
            const double inside = normal.cross(chord).dot(arm);
            if (inside > 0 && inside * inside > tolerance * tolerance * chord.squaredNorm())
                return false;
        }
        return true;
    }

    std::span<const Vec3> points_;
    const TriangleHull& hull_;
    double tolerance_;
    HullRings rings_;
    std::vector<Vec3> areas_;           // [triangles] normal, twice the area long
    std::vector<std::uint32_t> next_;   // [points] along the rim at hand
    std::vector<std::uint32_t> seen_;   // [points] the last climb it was high in
    std::vector<std::uint32_t> high_;   // corners as high as the last climb's, about
    std::vector<std::uint8_t> taken_;   // [triangles] by a face already
    std::vector<std::uint32_t> visit_;  // [triangles] the last region it was in
    std::uint32_t visits_ = 0;
    std::uint32_t climbs_ = 0;
};

}  // namespace

std::vector<HullFace>
merge_faces(std::span<const Vec3> points, const TriangleHull& hull, double tolerance)
{
    return Merger(points, hull, tolerance).merge();
}

}  // namespace throng
