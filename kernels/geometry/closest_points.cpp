#include "kernels/geometry/closest_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

// Below this sine two directions are taken as parallel: some digits above rounding, so that what
// is computed from their cross product still has a meaning.
template <class Real>
constexpr Real kParallel = 64 * std::numeric_limits<Real>::epsilon();

// The direction of a segment without its size, so that no square or fourth power of a length
// overflows or vanishes. Zero for a segment of no length.
template <class Real>
struct Span {
    Vec3T<Real> unit;
    Real length;

    explicit Span(const Vec3T<Real>& v)
    {
        const Real size = v.cwiseAbs().maxCoeff();
        if (size < std::numeric_limits<Real>::min()) {
            unit.setZero();
            length = 0;
            return;
        }
        const Vec3T<Real> scaled = v / size;
        const Real norm = scaled.norm();
        unit = scaled / norm;
        length = norm * size;
    }
    // Where along the segment, from 0 to 1, the given way from its start leads.
    Real clamped(Real way) const
    {
        return length > 0 ? std::clamp(way / length, Real(0), Real(1)) : Real(0);
    }
};

// Ends come out exactly, so that a region can be told by comparing.
template <class Real>
Vec3T<Real> point_at(const Segment<Real>& segment, Real at)
{
    return at == 1 ? segment.to : Vec3T<Real>(segment.from + at * (segment.to - segment.from));
}

template <class Real>
ClosestPoints<Real> points_at(const Segment<Real>& a, const Segment<Real>& b, Real at_a, Real at_b)
{
    return {point_at(a, at_a), point_at(b, at_b), at_a, at_b};
}

template <class Real>
TrianglePoint<Real> on_edge(int edge, const SegmentPoint<Real>& nearest)
{
    const int next = (edge + 1) % 3;
    TrianglePoint<Real> result{nearest.point, Vec3T<Real>::Zero(), TriangleRegion::face};
    result.weights[edge] = 1 - nearest.at;
    result.weights[next] = nearest.at;
    int region = static_cast<int>(TriangleRegion::edge0) + edge;
    if (nearest.at == 0) region = static_cast<int>(TriangleRegion::vertex0) + edge;
    if (nearest.at == 1) region = static_cast<int>(TriangleRegion::vertex0) + next;
    result.region = static_cast<TriangleRegion>(region);
    return result;
}

}  // namespace

template <class Real>
SegmentPoint<Real> closest_on_segment(const Vec3T<Real>& point, const Segment<Real>& segment)
{
    const Span<Real> span(segment.to - segment.from);
    const Real at = span.clamped(span.unit.dot(point - segment.from));
    return {point_at(segment, at), at};
}

template <class Real>
TrianglePoint<Real> closest_on_triangle(const Vec3T<Real>& point,
                                        const Vec3T<Real>& v0,
                                        const Vec3T<Real>& v1,
                                        const Vec3T<Real>& v2)
{
    const std::array<Vec3T<Real>, 3> corners{v0, v1, v2};
    const Real size = std::max((v1 - v0).cwiseAbs().maxCoeff(), (v2 - v0).cwiseAbs().maxCoeff());
    const Real scale = size < std::numeric_limits<Real>::min() ? Real(0) : 1 / size;
    const Vec3T<Real> e1 = (v1 - v0) * scale, e2 = (v2 - v0) * scale;
    const Vec3T<Real> normal = e1.cross(e2);
    const Real area = normal.squaredNorm();
    const bool flat = !(area > kParallel<Real> * kParallel<Real>);

    // Weight of each corner: the area that the point spans with the edge across from it.
    Vec3T<Real> weights = Vec3T<Real>::Constant(-1);
    if (!flat) {
        const Vec3T<Real> to_point = (point - v0) * scale;
        weights[1] = normal.dot(to_point.cross(e2)) / area;
        weights[2] = normal.dot(e1.cross(to_point)) / area;
        weights[0] = 1 - weights[1] - weights[2];
        if (weights.minCoeff() >= 0)
            return {v0 + weights[1] * (v1 - v0) + weights[2] * (v2 - v0), weights,
                    TriangleRegion::face};
    }

    // Outside: the nearest point lies on an edge that the point is beyond.
    TrianglePoint<Real> best{v0, {1, 0, 0}, TriangleRegion::vertex0};
    Real best_distance = std::numeric_limits<Real>::infinity();
    for (int edge = 0; edge < 3; ++edge) {
        if (!(weights[(edge + 2) % 3] < 0)) continue;
        const auto from = static_cast<std::size_t>(edge),
                   to = static_cast<std::size_t>((edge + 1) % 3);
        const auto nearest = closest_on_segment<Real>(point, {corners[from], corners[to]});
        const Real distance = ((nearest.point - point) * (scale > 0 ? scale : 1)).squaredNorm();
        if (distance < best_distance) {
            best_distance = distance;
            best = on_edge(edge, nearest);
        }
    }
    return best;
}

template <class Real>
ClosestPoints<Real> closest_points(const Segment<Real>& a, const Segment<Real>& b)
{
    const Span<Real> along_a(a.to - a.from), along_b(b.to - b.from);
    const Vec3T<Real> between = b.from - a.from;
    const Vec3T<Real> normal = along_a.unit.cross(along_b.unit);
    const Real sine_squared = normal.squaredNorm();

    if (!(sine_squared > kParallel<Real> * kParallel<Real>)) {
        // Parallel, or a point: the part of a that lies beside b, from its near end on.
        const Real start = along_a.unit.dot(between);
        const Real end = along_a.unit.dot(b.to - a.from);
        const Real at_a = along_a.clamped(std::min(start, end));
        const Real at_b = closest_on_segment(point_at(a, at_a), b).at;
        return points_at(a, b, at_a, at_b);
    }

    // Where the two lines come closest, clamped to a; then the answer of b, clamped, asks a again.
    const Real at_line = along_a.clamped(between.cross(along_b.unit).dot(normal) / sine_squared);
    const Real way_b = along_b.unit.dot(point_at(a, at_line) - b.from);
    const Real at_b = along_b.clamped(way_b);
    if (way_b >= 0 && way_b <= along_b.length) return points_at(a, b, at_line, at_b);
    return points_at(a, b, closest_on_segment(point_at(b, at_b), a).at, at_b);
}

// The two number types that the callers use.
template SegmentPoint<float> closest_on_segment(const Vec3T<float>&, const Segment<float>&);
template SegmentPoint<double> closest_on_segment(const Vec3T<double>&, const Segment<double>&);
template TrianglePoint<float> closest_on_triangle(const Vec3T<float>&,
                                                  const Vec3T<float>&,
                                                  const Vec3T<float>&,
                                                  const Vec3T<float>&);
template TrianglePoint<double> closest_on_triangle(const Vec3T<double>&,
                                                   const Vec3T<double>&,
                                                   const Vec3T<double>&,
                                                   const Vec3T<double>&);
template ClosestPoints<float> closest_points(const Segment<float>&, const Segment<float>&);
template ClosestPoints<double> closest_points(const Segment<double>&, const Segment<double>&);

}  // namespace throng
