// Volume truth: shared_volume() of pair_truth.hpp.
#include "kernels/geometry/flat_faces.hpp"
#include "perf/narrowphase/pair_truth.hpp"

#include <algorithm>
#include <cmath>

namespace throng::perf {
namespace {

using Long = long double;
using LongVec = Vec3T<Long>;

struct LongFace {
    std::array<LongVec, 3> corners;
    LongVec normal;  // unit, outward
    Vec3 rough_normal;
    double rough_offset;
};

std::vector<LongFace> long_faces(const PolytopeView& shape, const Pose* pose)
{
    std::vector<LongFace> faces;
    std::vector<FaceTriangle> triangles;
    const QuatT<Long> turn =
        pose != nullptr ? pose->orientation.cast<Long>().normalized() : QuatT<Long>::Identity();
    const LongVec shift = pose != nullptr ? LongVec(pose->position.cast<Long>()) : LongVec::Zero();
    for (std::size_t face = 0; face < shape.normals.size(); ++face) {
        const auto corners = shape.face(face);
        collect_triangles(shape, face, triangles);
        for (const FaceTriangle& triangle : triangles) {
            LongFace made;
            std::size_t to = 0;
            for (const std::size_t i : {triangle.first, triangle.middle, triangle.last})
                made.corners[to++] = turn * shape.vertices[corners[i]].cast<Long>() + shift;
            const auto& [p, q, r] = made.corners;
            made.normal = (q - p).cross(r - p);
            const Long length = std::sqrt(made.normal.squaredNorm());
            if (!(length > 0)) continue;
            made.normal /= length;
            made.rough_normal = made.normal.cast<double>();
            made.rough_offset = static_cast<double>(made.normal.dot(p));
            faces.push_back(made);
        }
    }
    return faces;
}

// Keeps what of a polygon is beneath a plane.
//
// Source: Sutherland, Hodgman, Reentrant Polygon Clipping (1974).
void clip(const LongFace& plane, std::vector<LongVec>& polygon)
{
    std::vector<LongVec> kept;
    const auto height = [&](const LongVec& point) {
        return plane.normal.dot(point - plane.corners[0]);
    };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const LongVec &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
        const Long low = height(from), high = height(to);
        if (low <= 0) kept.push_back(from);
        if ((low <= 0) != (high <= 0)) kept.emplace_back(from + (to - from) * (low / (low - high)));
    }
    polygon = std::move(kept);
}

// Three times the volume between a point and those parts of some faces that are inside the other.
Long volume_beneath(const std::vector<LongFace>& faces,
                    const std::vector<LongFace>& planes,
                    const LongVec& middle,
                    double inner,
                    double outer,
                    const LongVec& from)
{
    const double noise = 1e-9 * outer;
    Long sum = 0;
    std::vector<LongVec> polygon;
    for (const LongFace& face : faces) {
        std::array<Vec3, 3> rough;
        for (std::size_t i = 0; i < 3; ++i) rough[i] = face.corners[i].cast<double>();
        double furthest = 0;
        for (const LongVec& corner : face.corners)
            furthest = std::max(furthest, static_cast<double>((corner - middle).norm()));
        polygon.assign(face.corners.begin(), face.corners.end());
        // Whoever is within the ball inside the other is not cut by any plane of it.
        for (std::size_t i = 0; furthest > inner - noise && i < planes.size(); ++i) {
            if (polygon.size() < 3) break;
            double highest = -std::numeric_limits<double>::infinity();
            for (const Vec3& corner : rough)
                highest = std::max(highest, planes[i].rough_normal.dot(corner));
            if (highest > planes[i].rough_offset - noise) clip(planes[i], polygon);
        }
        for (std::size_t i = 2; i < polygon.size(); ++i)
            sum +=
                (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]).dot(polygon[0] - from)
                / 2;
    }
    return sum;
}

}  // namespace

double shared_volume(const PolytopePair& pair, const Pose& b_in_a)
{
    const std::vector<LongFace> a = long_faces(pair.a, nullptr), b = long_faces(pair.b, &b_in_a);
    const LongVec from = (pair.a.center + pair.offset / 2).cast<Long>();
    const LongVec middle_a = pair.a.center.cast<Long>();
    const LongVec middle_b = (pair.a.center + pair.offset).cast<Long>();
    const Long sum = volume_beneath(a, b, middle_b, pair.b.inner_radius, pair.b.outer_radius, from)
        + volume_beneath(b, a, middle_a, pair.a.inner_radius, pair.a.outer_radius, from);
    return static_cast<double>(sum / 3);
}

}  // namespace throng::perf
