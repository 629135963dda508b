#include "narrowphase/manifold/edge_on_edge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

// Of two faces, the cosine below which an edge is too sharp for a ball to fit in beside it.
constexpr double kSharp = -0.9;
// Cosine from which two faces lie on one another: a degree.
constexpr double kFlat = 0.99985;

constexpr std::size_t kNone = ~std::size_t{0};

// An edge of a convex shape.
template <class Real>
struct ConvexEdge {
    Vec3T<Real> middle, along, left, right;  // the last two: unit, outward normals of its faces
    Real half_length = 0;                    // m
    std::uint32_t id = 0;                    // its own among those of the shape

    ConvexEdge moved(const Mat3T<Real>& turn, const Vec3T<Real>& shift) const
    {
        return {turn * middle + shift, turn * along, turn * left, turn * right, half_length, id};
    }
};

// Whether a direction, across an edge, lies between the normals of its faces.
template <class Real>
bool looks_away(const ConvexEdge<Real>& edge, const Vec3T<Real>& direction)
{
    const Real cosine = edge.left.dot(edge.right);
    const Real left = direction.dot(edge.left), right = direction.dot(edge.right);
    return left > cosine * right && right > cosine * left;
}

// From an edge to the middle of its rounding, in radii.
template <class Real>
Vec3T<Real> inward(const ConvexEdge<Real>& edge)
{
    return -(edge.left + edge.right) / (1 + edge.left.dot(edge.right));
}

template <class Real>
bool lie_flat(const ConvexEdge<Real>& a, const ConvexEdge<Real>& b)
{
    const Real most = std::max(
        {-a.left.dot(b.left), -a.left.dot(b.right), -a.right.dot(b.left), -a.right.dot(b.right)});
    return most > Real(kFlat);
}

// From one line to the other, square to the first.
template <class Real>
Vec3T<Real> across(const ConvexEdge<Real>& a, const ConvexEdge<Real>& b)
{
    const Vec3T<Real> between = b.middle - a.middle;
    return between - a.along * a.along.dot(between);
}

template <class Real>
struct EdgePair {
    ConvexEdge<Real> a, b;
    Real apart2 = std::numeric_limits<Real>::infinity();

    bool found() const { return apart2 < std::numeric_limits<Real>::infinity(); }
    void keep_nearer(const ConvexEdge<Real>& of_a, const ConvexEdge<Real>& of_b)
    {
        const Real distance2 = across(of_a, of_b).squaredNorm();
        if (!(distance2 < apart2)) return;
        a = of_a, b = of_b, apart2 = distance2;
    }
};

// That of a box along an axis, on those sides of the two others.
template <class Real>
ConvexEdge<Real> box_edge(const Vec3T<Real>& half, int axis, bool u_above, bool v_above)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    ConvexEdge<Real> edge;
    edge.along = Vec3T<Real>::Unit(axis);
    edge.left = (u_above ? Real(1) : Real(-1)) * Vec3T<Real>::Unit(u);
    edge.right = (v_above ? Real(1) : Real(-1)) * Vec3T<Real>::Unit(v);
    edge.middle = half[u] * edge.left + half[v] * edge.right;
    edge.half_length = half[axis];
    edge.id = static_cast<std::uint32_t>(4 * axis + 2 * int{u_above} + int{v_above});
    return edge;
}

template <class Real>
ConvexEdge<Real> box_edge_near(const Vec3T<Real>& half, int axis, const Vec3T<Real>& place)
{
    return box_edge(half, axis, place[(axis + 1) % 3] > 0, place[(axis + 2) % 3] > 0);
}

ConvexEdge<double> edge_of(const PolytopeView& shape, std::size_t index)
{
    const Hull::Edge& edge = shape.edges[index];
    const Vec3 &from = shape.vertices[edge.from], &to = shape.vertices[edge.to];
    const double length = (to - from).norm();
    return {(from + to) / 2,           (to - from) / length, shape.normals[edge.left],
            shape.normals[edge.right], length / 2,           static_cast<std::uint32_t>(index)};
}

bool is_along(const PolytopeView& shape, std::size_t index, const Vec3& direction)
{
    const Hull::Edge& edge = shape.edges[index];
    const Vec3 span = shape.vertices[edge.to] - shape.vertices[edge.from];
    const double part = span.dot(direction);
    return part * part > kEdgesAlong * kEdgesAlong * span.squaredNorm();
}

// The one nearest to a place, of those along a direction; kNone where there is none.
std::size_t nearest_along(const PolytopeView& shape, const Vec3& place, const Vec3& direction)
{
    std::size_t best = kNone;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < shape.edges.size(); ++i) {
        if (!is_along(shape, i, direction)) continue;
        const Vec3 to = place - shape.vertices[shape.edges[i].from];
        const double distance2 = (to - direction * direction.dot(to)).squaredNorm();
        if (!(distance2 < least)) continue;
        least = distance2;
        best = i;
    }
    return best;
}

bool is_beside(const Hull::Edge& edge, std::uint32_t face)
{
    return edge.left == face || edge.right == face;
}

// In the manifold's frame; the radius is above 0.
template <class Real>
void hold_edges(const ConvexEdge<Real>& a,
                const ConvexEdge<Real>& b,
                Real radius,
                Real speculative_margin,
                LocalManifold<Real>& manifold)
{
    if (lie_flat(a, b)) return;
    Vec3T<Real> between = across(a, b) + radius * (inward(b) - inward(a));
    between -= a.along * a.along.dot(between);
    const Real distance = between.norm();
    if (!(distance > radius)) return;
    if (!looks_away(a, between) || !looks_away(b, Vec3T<Real>(-between))) return;
    const Vec3T<Real> normal = between / distance;
    // What of a is beside b.
    const Real b_from_a = a.along.dot(b.middle - a.middle);
    const Real ends[2] = {std::max(-a.half_length, b_from_a - b.half_length),
                          std::min(a.half_length, b_from_a + b.half_length)};
    if (!(ends[0] < ends[1])) return;
    LocalManifold<Real> found;
    found.normal = normal;
    for (std::uint32_t end = 0; end < 2; ++end) {
        const Vec3T<Real> on_a = a.middle + a.along * ends[end];
        const Vec3T<Real> on_b = b.middle + b.along * b.along.dot(on_a - b.middle);
        const Real separation = normal.dot(on_b - on_a);
        if (separation > speculative_margin) return;
        found.add((on_a + on_b) / 2, separation,
                  3u << 30 | (a.id & 0x3fff) << 15 | (b.id & 0x3fff) << 1 | end);
    }
    manifold = found;
}

}  // namespace

template <class Real>
bool is_strip(const LocalManifold<Real>& manifold,
              Real width,
              Vec3T<Real>& middle,
              Vec3T<Real>& along)
{
    const auto& points = manifold.points;
    const auto is_near = [&](std::size_t i, std::size_t k) {
        return (points[i].position - points[k].position).squaredNorm() < width * width;
    };
    // All that are near the first are of its end; the others have to be near one another.
    std::size_t far = kNone, of_first = 1;
    for (std::size_t i = 1; i < static_cast<std::size_t>(manifold.count); ++i) {
        if (is_near(0, i))
            ++of_first;
        else if (far == kNone)
            far = i;
        else if (!is_near(far, i))
            return false;
    }
    if (far == kNone || of_first > 2) return false;
    const Vec3T<Real>&p = points[0].position, &q = points[far].position;
    middle = (p + q) / 2;
    along = (q - p).normalized();
    return true;
}

template <class Real>
void meet_edge_on_edge(const Vec3T<Real>& half_a,
                       const Vec3T<Real>& half_b,
                       const Mat3T<Real>& turn,
                       const Vec3T<Real>& shift,
                       Real speculative_margin,
                       LocalManifold<Real>& manifold)
{
    if (manifold.count == 1) return;
    const Real radius = Real(kRounded) * std::min(half_a.minCoeff(), half_b.minCoeff());
    EdgePair<Real> edges;
    int axis_a = 0, axis_b = 0;
    if (manifold.count > 1) {
        Vec3T<Real> middle, along;
        if (!is_strip(manifold, radius, middle, along)) return;
        if (!(along.cwiseAbs().maxCoeff(&axis_a) > Real(kEdgesAlong))) return;
        if (!((turn.transpose() * along).cwiseAbs().maxCoeff(&axis_b) > Real(kEdgesAlong))) return;
        edges.keep_nearer(box_edge_near(half_a, axis_a, middle),
                          box_edge_near<Real>(half_b, axis_b, turn.transpose() * (middle - shift))
                              .moved(turn, shift));
    } else {
        if (!(turn.cwiseAbs().maxCoeff(&axis_a, &axis_b) > Real(kEdgesAlong))) return;
        for (int of_b = 0; of_b < 4; ++of_b) {
            const auto b = box_edge(half_b, axis_b, of_b > 1, of_b % 2 > 0).moved(turn, shift);
            edges.keep_nearer(box_edge_near(half_a, axis_a, b.middle), b);
        }
    }
    if (edges.found()) hold_edges(edges.a, edges.b, radius, speculative_margin, manifold);
}

void meet_edge_on_edge(const PolytopePair& pair,
                       const LeadingFace& leading,
                       double speculative_margin,
                       LocalManifold<double>& manifold)
{
    if (manifold.count == 1 || pair.a.round || pair.b.round) return;
    const double radius = kRounded * std::min(pair.a.inner_radius, pair.b.inner_radius);
    const Mat3 back = pair.turn.transpose();
    EdgePair<double> edges;
    if (manifold.count > 1) {
        Vec3 middle, along;
        if (!is_strip(manifold, radius, middle, along)) return;
        const std::size_t of_a = nearest_along(pair.a, middle, along);
        if (of_a == kNone) return;
        const std::size_t of_b = nearest_along(pair.b, back * (middle - pair.shift), back * along);
        if (of_b == kNone) return;
        edges.keep_nearer(edge_of(pair.a, of_a),
                          edge_of(pair.b, of_b).moved(pair.turn, pair.shift));
    } else {
        for (std::size_t i = 0; i < pair.a.edges.size(); ++i) {
            if (!leading.of_b && !is_beside(pair.a.edges[i], leading.face)) continue;
            const ConvexEdge<double> of_a = edge_of(pair.a, i);
            const Vec3 along = back * of_a.along;
            for (std::size_t k = 0; k < pair.b.edges.size(); ++k) {
                if (leading.of_b && !is_beside(pair.b.edges[k], leading.face)) continue;
                if (is_along(pair.b, k, along))
                    edges.keep_nearer(of_a, edge_of(pair.b, k).moved(pair.turn, pair.shift));
            }
        }
    }
    if (!edges.found()) return;
    if (edges.a.left.dot(edges.a.right) < kSharp || edges.b.left.dot(edges.b.right) < kSharp)
        return;
    hold_edges(edges.a, edges.b, radius, speculative_margin, manifold);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template bool is_strip(const LocalManifold<Real>&, Real, Vec3T<Real>&, Vec3T<Real>&);          \
    template void meet_edge_on_edge(const Vec3T<Real>&, const Vec3T<Real>&, const Mat3T<Real>&,    \
                                    const Vec3T<Real>&, Real, LocalManifold<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
