#include "perf/narrowphase/pair_truth.hpp"

#include "cost/hard_cases/quad_truth.hpp"
#include "kernels/geometry/flat_faces.hpp"

#include <algorithm>
#include <cmath>

namespace throng::perf {
namespace {

// ---------------------------------------------------------------------------------------- depth

// Contenders within this of the best, of the size, are told apart in four times the digits.
constexpr double kClose = 1e-9;
// rad, by how much the normals at the edges of a face that is not quite flat may lean from its own.
constexpr double kLean = 0.05;
// Of the nearest corners of each, so many are tried; a face and what is round it, and some to
// spare.
constexpr std::size_t kNearest = 8;

struct Line {
    std::uint16_t from, to;
};

// Direction from the middle of a to that of b, and how far from it a better axis may be.
struct Cone {
    Vec3 offset;
    double inner;  // m, radii of the balls inside both

    double inner_distance(double best) const { return best + inner; }
    bool holds(const Vec3& unit, double best) const
    {
        return offset.dot(unit) >= inner_distance(best);
    }
    // The same for an arc of normals about a middle one, rad to either side.
    bool may_hold(const Vec3& middle, double half, double best) const
    {
        const double far = offset.norm();
        if (inner_distance(best) <= 0 || !(far > 0)) return true;
        const double widest = std::acos(std::min(1.0, inner_distance(best) / far)) + half;
        return offset.dot(middle) >= far * std::cos(std::min(widest, 3.1));
    }
};

struct Contender {
    double separation;
    std::array<std::uint16_t, 3> a, b;  // corners of a face, or of an edge of each
    enum { face_a, face_b, edges } kind;
};

class AxisSearch {
public:
    explicit AxisSearch(const PolytopePair& pair)
        : pair_(pair), cone_{pair.offset, pair.a.inner_radius + pair.b.inner_radius},
          slack_(kClose * (pair.a.outer_radius + pair.b.outer_radius))
    {
        const double far = pair.offset.norm();
        if (far > 0) offer_center(pair.offset / far);
    }

    /// The best axis there is, to rounding.
    const Vec3& normal() const { return normal_; }

    std::vector<Contender> contenders()
    {
        try_faces(pair_.a, false);
        try_faces(pair_.b, true);
        const std::vector<Line> of_a = lines(pair_.a, false), of_b = lines(pair_.b, true);
        for (const Line& a : of_a) {
            const Vec3 along_a = pair_.a.vertices[a.to] - pair_.a.vertices[a.from];
            for (const Line& b : of_b) {
                const Vec3 along_b =
                    pair_.turn * (pair_.b.vertices[b.to] - pair_.b.vertices[b.from]);
                const Vec3 across = along_a.cross(along_b);
                const double sine = across.norm();
                if (!(sine > 1e-9 * along_a.norm() * along_b.norm())) continue;
                const Contender made{0, {a.from, a.to, 0}, {b.from, b.to, 0}, Contender::edges};
                for (const double sign : {1.0, -1.0}) offer(across * (sign / sine), made);
            }
        }
        std::erase_if(found_,
                      [&](const Contender& one) { return one.separation < best_ - slack_; });
        return std::move(found_);
    }

private:
    double measure(const Vec3& unit) const
    {
        const Vec3 back = -(pair_.turn.transpose() * unit);
        at_a_ = support_vertex(pair_.a, unit, at_a_);
        at_b_ = support_vertex(pair_.b, back, at_b_);
        return unit.dot(pair_.turn * pair_.b.vertices[at_b_] + pair_.shift
                        - pair_.a.vertices[at_a_]);
    }

    void offer_center(const Vec3& unit)
    {
        normal_ = unit;
        best_ = measure(unit) - slack_;
    }

    void offer(const Vec3& unit, Contender made)
    {
        if (!cone_.holds(unit, best_ - slack_)) return;
        made.separation = measure(unit);
        if (made.separation < best_ - slack_) return;
        if (made.separation > best_) {
            best_ = made.separation;
            normal_ = unit;
        }
        found_.push_back(made);
    }

    // Of a face that is not flat, every three corners are one.
    void try_faces(const PolytopeView& shape, bool is_b)
    {
        for (std::size_t face = 0; face < shape.normals.size(); ++face) {
            Vec3 normal = shape.normals[face];
            if (is_b) normal = -(pair_.turn * normal);
            if (!cone_.may_hold(normal, kLean, best_ - slack_)) continue;
            const auto corners = shape.face(face);
            for (std::size_t i = 0; i < corners.size(); ++i)
                for (std::size_t j = 0; j < i; ++j)
                    for (std::size_t k = 0; k < j; ++k)
                        try_corners(shape, {corners[i], corners[j], corners[k]}, normal, is_b);
        }
    }

    void try_corners(const PolytopeView& shape,
                     const std::array<std::uint16_t, 3>& corners,
                     const Vec3& normal,
                     bool is_b)
    {
        const Vec3& first = shape.vertices[corners[0]];
        Vec3 across =
            (shape.vertices[corners[1]] - first).cross(shape.vertices[corners[2]] - first);
        const double length = across.norm();
        if (!(length > 0)) return;
        if (is_b) across = pair_.turn * across;
        across *= (across.dot(normal) < 0 ? -1 : 1) / length;
        offer(across, {0, corners, corners, is_b ? Contender::face_b : Contender::face_a});
    }

    // Edges with a normal in the cone; of a face that is not flat, every two corners.
    std::vector<Line> lines(const PolytopeView& shape, bool is_b) const
    {
        const auto placed = [&](const Vec3& normal) {
            return is_b ? Vec3(-(pair_.turn * normal)) : normal;
        };
        std::vector<Line> kept;
        for (const Hull::Edge& edge : shape.edges) {
            const Vec3 &left = shape.normals[edge.left], &right = shape.normals[edge.right];
            const Vec3 middle = (left + right).normalized();
            const double half = std::acos(std::clamp(middle.dot(left), -1.0, 1.0)) + kLean;
            if (cone_.may_hold(placed(middle), half, best_ - slack_))
                kept.push_back({edge.from, edge.to});
        }
        for (std::size_t face = 0; face < shape.normals.size(); ++face) {
            const auto corners = shape.face(face);
            if (corners.size() < 4 || is_flat(shape, face, 0)
                || !cone_.may_hold(placed(shape.normals[face]), kLean, best_ - slack_))
                continue;
            for (std::size_t i = 0; i < corners.size(); ++i)
                for (std::size_t j = 0; j < i; ++j) kept.push_back({corners[i], corners[j]});
        }
        return kept;
    }

    const PolytopePair& pair_;
    Cone cone_;
    double slack_;
    double best_ = -std::numeric_limits<double>::infinity();
    Vec3 normal_ = Vec3::UnitZ();
    mutable std::uint16_t at_a_ = 0, at_b_ = 0;
    std::vector<Contender> found_;
};

// All corners, and of the contenders what their axes are made of.
QuadSolid quad_corners(const PolytopeView& shape, const QuadPose& pose)
{
    QuadSolid solid;
    solid.corners.reserve(shape.vertices.size());
    for (const Vec3& vertex : shape.vertices)
        solid.corners.push_back(quad_cloud({&vertex, 1}, pose).corners[0]);
    return solid;
}

void add(const PolytopeView& shape,
         const std::array<std::uint16_t, 3>& corners,
         std::size_t count,
         const QuadPose& pose,
         QuadSolid& solid)
{
    std::array<Vec3, 3> points;
    for (std::size_t i = 0; i < count; ++i) points[i] = shape.vertices[corners[i]];
    const QuadSolid made = quad_cloud({points.data(), count}, pose);
    if (count == 3)
        solid.normals.push_back(made.normals[0]);
    else
        solid.directions.push_back(made.directions[0]);
}

// -------------------------------------------------------------------------------------- distance

QuadSolid nearest_corners(const PolytopeView& shape, const Vec3& direction, const QuadPose& pose)
{
    std::vector<Vec3> corners(shape.vertices.begin(), shape.vertices.end());
    const std::size_t count = std::min(kNearest, corners.size());
    std::partial_sort(
        corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(count), corners.end(),
        [&](const Vec3& x, const Vec3& y) { return direction.dot(x) > direction.dot(y); });
    return quad_cloud({corners.data(), count}, pose);
}

// Nothing of a is further along the normal than its nearest corners tell, and so with b: from that
// follows what the distance is at least; from corners that exist, what it is at most.
PairTruth distance_truth(const PolytopePair& pair,
                         const QuadSolid& all_a,
                         const QuadSolid& all_b,
                         const QuadPose& at_a,
                         const QuadPose& at_b,
                         Vec3 normal)
{
    PairTruth best;
    best.unproved = std::numeric_limits<double>::infinity();
    // A direction that is a little off may name the wrong corners; the next names better ones.
    for (int i = 0; i < 20 && best.unproved > 1e-14; ++i) {
        const Vec3 back = -(pair.turn.transpose() * normal);
        const QuadTruth truth =
            quad_truth(nearest_corners(pair.a, normal, at_a), nearest_corners(pair.b, back, at_b));
        const double proved = quad_separation_along(all_a, all_b, truth.normal);
        const double clearance = std::abs(truth.separation - proved);
        if (clearance < best.unproved) best = {truth.separation, clearance};
        normal = truth.normal;
    }
    return best;
}

}  // namespace

PairTruth pair_truth(const PolytopePair& pair, const Pose& b_in_a)
{
    const QuadPose at_a{Pose{}}, at_b(b_in_a);
    const QuadSolid all_a = quad_corners(pair.a, at_a), all_b = quad_corners(pair.b, at_b);
    QuadSolid a = all_a, b = all_b;
    AxisSearch search(pair);
    for (const Contender& one : search.contenders()) {
        if (one.kind == Contender::face_a) add(pair.a, one.a, 3, at_a, a);
        if (one.kind == Contender::face_b) add(pair.b, one.b, 3, at_b, b);
        if (one.kind != Contender::edges) continue;
        add(pair.a, one.a, 2, at_a, a);
        add(pair.b, one.b, 2, at_b, b);
    }
    const QuadTruth truth = quad_truth(a, b);
    const bool known = !a.normals.empty() || !b.normals.empty() || !a.directions.empty();
    if (known && truth.separation <= 0) return {truth.separation, 0};
    return distance_truth(pair, all_a, all_b, at_a, at_b, search.normal());
}

}  // namespace throng::perf
