#include "narrowphase/manifold/edge_over_face.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Of both half extents, or balls inside: how exactly an end has to come out as deep as the point
// where the edges cross. Else it is not this face that they border.
constexpr double kSame = 1e-3;

// What of an edge is over a face, seen along a direction from the one to the other.
template <class Real>
class OverFace {
public:
    using Vec = Vec3T<Real>;

    OverFace(
        const Vec& from, const Vec& to, const Vec& towards, const Vec& face, const Vec& on_face)
        : from_(from), along_(to - from), towards_(towards)
    {
        const Real slope = face.dot(towards);
        separation_ = face.dot(on_face - from) / slope;
        change_ = -face.dot(along_) / slope;
    }

    // Beyond a side of the face there is nothing.
    void cut(const Vec& side, const Vec& on_side)
    {
        const Real first = side.dot(from_ + towards_ * separation_ - on_side);
        const Real slope = side.dot(along_ + towards_ * change_);
        if (slope == 0)
            last_ = first > 0 ? Real(-1) : last_;
        else if (slope > 0)
            last_ = std::min(last_, -first / slope);
        else
            first_ = std::max(first_, -first / slope);
    }

    // Both ends; none where they are not of the point that the manifold has.
    void lay(Real speculative_margin, Real same, std::uint32_t name, LocalManifold<Real>& manifold)
    {
        if (!(first_ < last_)) return;
        const Real ends[2] = {separation_ + first_ * change_, separation_ + last_ * change_};
        if (std::max(ends[0], ends[1]) > speculative_margin) return;
        if (!(std::abs(std::min(ends[0], ends[1]) - manifold.points[0].separation) <= same)) return;
        manifold.count = 0;
        for (std::uint32_t end = 0; end < 2; ++end)
            manifold.add(from_ + along_ * (end == 0 ? first_ : last_) + towards_ * (ends[end] / 2),
                         ends[end], 5u << 29 | (name & 0xfffffff) << 1 | end);
    }

private:
    Vec from_, along_, towards_;
    Real separation_, change_;   // m, at the start, and by how much it is more at the end
    Real first_ = 0, last_ = 1;  // of the edge
};

// Of a box at rest the edge that looks along a direction, square to one of its axes.
template <class Real>
std::uint32_t
find_edge(const Vec3T<Real>& half, const Vec3T<Real>& direction, Vec3T<Real>& from, Vec3T<Real>& to)
{
    int axis = 0;
    direction.cwiseAbs().minCoeff(&axis);
    auto name = static_cast<std::uint32_t>(axis);
    for (int k = 0; k < 3; ++k) {
        from[k] = k == axis || direction[k] < 0 ? -half[k] : half[k];
        if (k != axis) name = 2 * name + (direction[k] < 0 ? 1 : 0);
    }
    to = from;
    to[axis] = half[axis];
    return name;
}

// The edge of a box at rest over the face of another that looks most against a direction.
template <class Real>
void lay_over_box(const Vec3T<Real>& edge_half,
                  const Vec3T<Real>& face_half,
                  const Mat3T<Real>& turn,
                  const Vec3T<Real>& center,
                  const Vec3T<Real>& direction,
                  Real speculative_margin,
                  LocalManifold<Real>& manifold)
{
    Vec3T<Real> from, to;
    const std::uint32_t edge = find_edge(edge_half, direction, from, to);
    const Vec3T<Real> seen = turn.transpose() * direction;
    int face = 0;
    seen.cwiseAbs().maxCoeff(&face);
    const bool above = seen[face] < 0;
    const auto side = [&](int axis, bool up) -> Vec3T<Real> {
        return (up ? Real(1) : Real(-1)) * turn.col(axis);
    };
    const auto on_side = [&](int axis, bool up) -> Vec3T<Real> {
        return center + face_half[axis] * side(axis, up);
    };
    OverFace<Real> over(from, to, direction, side(face, above), on_side(face, above));
    for (int k = 0; k < 3; ++k)
        if (k != face)
            for (const bool up : {false, true}) over.cut(side(k, up), on_side(k, up));
    over.lay(speculative_margin, Real(kSame) * (edge_half.minCoeff() + face_half.minCoeff()),
             8 * edge + 2 * static_cast<std::uint32_t>(face) + (above ? 1 : 0), manifold);
}

// A face of a, which borders one of the two edges, and the edge of b over it.
void lay_over_polytope(const PolytopePair& pair,
                       std::uint16_t face,
                       std::uint16_t edge,
                       double speculative_margin,
                       LocalManifold<double>& manifold)
{
    const Hull::Edge& ends = pair.b.edges[edge];
    const auto placed = [&](std::uint16_t vertex) {
        return Vec3(pair.turn * pair.b.vertices[vertex] + pair.shift);
    };
    const Vec3& normal = pair.a.normals[face];
    const auto corners = pair.a.face(face);
    OverFace<double> over(placed(ends.from), placed(ends.to), -manifold.normal, normal,
                          pair.a.vertices[corners[0]]);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3& from = pair.a.vertices[corners[i]];
        const Vec3& to = pair.a.vertices[corners[i + 1 == corners.size() ? 0 : i + 1]];
        over.cut((to - from).cross(normal), from);
    }
    over.lay(speculative_margin, kSame * (pair.a.inner_radius + pair.b.inner_radius),
             std::uint32_t{face} * 32749u + edge, manifold);
}

}  // namespace

std::uint16_t
face_beside(const PolytopeView& shape, std::uint16_t edge, const Vec3& direction, double& cosine)
{
    std::uint16_t best = 0;
    cosine = -2;
    for (const std::uint16_t face : {shape.edges[edge].left, shape.edges[edge].right}) {
        const bool flat = shape.face(face).size() > 2 && !shape.is_round_side(face);
        const double along = shape.normals[face].dot(direction);
        if (!flat || !(along > cosine)) continue;
        cosine = along;
        best = face;
    }
    return best;
}

template <class Real>
void lay_edge_over_face(const Vec3T<Real>& half_a,
                        const Vec3T<Real>& half_b,
                        const Mat3T<Real>& turn,
                        const Vec3T<Real>& shift,
                        Real speculative_margin,
                        LocalManifold<Real>& manifold)
{
    if (manifold.count != 1) return;
    const Vec3T<Real> normal = manifold.normal, of_b = turn.transpose() * normal;
    const Real cosine_a = normal.cwiseAbs().maxCoeff(), cosine_b = of_b.cwiseAbs().maxCoeff();
    if (!(std::max(cosine_a, cosine_b) > Real(kAllButFace))) return;
    if (cosine_b >= cosine_a)
        return lay_over_box(half_a, half_b, turn, shift, normal, speculative_margin, manifold);
    const Mat3T<Real> back = turn.transpose();
    lay_over_box<Real>(half_b, half_a, back, -(back * shift), -of_b, speculative_margin, manifold);
    if (manifold.count == 1) return;
    for (int i = 0; i < manifold.count; ++i) {
        auto& point = manifold.points[static_cast<std::size_t>(i)];
        point.position = turn * point.position + shift;
        point.feature |= 1u << 28;
    }
}

void lay_edge_over_face(const PolytopePair& pair,
                        std::uint16_t edge_a,
                        std::uint16_t edge_b,
                        double speculative_margin,
                        LocalManifold<double>& manifold)
{
    if (manifold.count != 1) return;
    const Vec3 normal = manifold.normal;
    double cosine_a = 0, cosine_b = 0;
    const std::uint16_t face_a = face_beside(pair.a, edge_a, normal, cosine_a);
    const std::uint16_t face_b =
        face_beside(pair.b, edge_b, -(pair.turn.transpose() * normal), cosine_b);
    if (!(std::max(cosine_a, cosine_b) > kAllButFace)) return;
    if (cosine_a > cosine_b)
        return lay_over_polytope(pair, face_a, edge_b, speculative_margin, manifold);
    const PolytopePair turned = pair.mirrored();
    turn_round(turned, manifold);
    lay_over_polytope(turned, face_b, edge_a, speculative_margin, manifold);
    turn_round(pair, manifold);
    manifold.normal = normal;
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void lay_edge_over_face(const Vec3T<Real>&, const Vec3T<Real>&, const Mat3T<Real>&,   \
                                     const Vec3T<Real>&, Real, LocalManifold<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
