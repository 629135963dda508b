#include "kernels/geometry/separating_axes.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace throng {
namespace {

// A polytope with its arrays in one common frame.
struct Placed {
    std::vector<Vec3> vertices, normals;
    std::span<const Hull::Edge> edges;

    Placed(const PolytopeView& shape, const Pose& pose) : edges(shape.edges)
    {
        const Mat3 turn = pose.orientation.normalized().toRotationMatrix();
        for (const Vec3& vertex : shape.vertices)
            vertices.emplace_back(turn * vertex + pose.position);
        for (const Vec3& normal : shape.normals) normals.emplace_back(turn * normal);
    }
    Vec3 along(const Hull::Edge& edge) const { return vertices[edge.to] - vertices[edge.from]; }
};

struct Best {
    double separation = -std::numeric_limits<double>::max();
    Vec3 normal = Vec3::UnitZ();

    void offer(double candidate, const Vec3& along)
    {
        if (candidate > separation) {
            separation = candidate;
            normal = along;
        }
    }
};

double furthest(const std::vector<Vec3>& vertices, const Vec3& direction)
{
    double most = -std::numeric_limits<double>::max();
    for (const Vec3& vertex : vertices) most = std::max(most, direction.dot(vertex));
    return most;
}

double separation_along(const Placed& a, const Placed& b, const Vec3& normal)
{
    return -furthest(b.vertices, -normal) - furthest(a.vertices, normal);
}

// Whether an edge of a and an edge of b make a face of the Minkowski difference: the arc between
// the normals beside the one crosses the arc between the negated normals beside the other.
bool make_a_face(const Placed& a,
                 const Hull::Edge& edge_a,
                 const Placed& b,
                 const Hull::Edge& edge_b)
{
    const Vec3 along_a = a.along(edge_a), along_b = b.along(edge_b);
    const double left_b = -b.normals[edge_b.left].dot(along_a);
    const double right_b = -b.normals[edge_b.right].dot(along_a);
    const double left_a = a.normals[edge_a.left].dot(along_b);
    const double right_a = a.normals[edge_a.right].dot(along_b);
    return left_b * right_b < 0 && left_a * right_a < 0 && left_b * right_a > 0;
}

void offer_edges(const Placed& a, const Placed& b, Best& best)
{
    for (const Hull::Edge& edge_a : a.edges) {
        for (const Hull::Edge& edge_b : b.edges) {
            if (!make_a_face(a, edge_a, b, edge_b)) continue;
            const Vec3 cross = a.along(edge_a).cross(b.along(edge_b));
            const double length = cross.norm();
            if (!(length > 0)) continue;
            // The arcs lie outward of a; rounding of near-parallel edges costs nothing, for every
            // vertex is asked how far it reaches along the normal that came out.
            Vec3 normal = cross / length;
            if (normal.dot(a.normals[edge_a.left] + a.normals[edge_a.right]) < 0) normal = -normal;
            best.offer(separation_along(a, b, normal), normal);
        }
    }
}

}  // namespace

double
polytope_separation(const PolytopeView& a, const PolytopeView& b, const Pose& b_in_a, Vec3* normal)
{
    const Placed placed_a(a, Pose{}), placed_b(b, b_in_a);
    Best best;
    for (const Vec3& face : placed_a.normals) {
        best.offer(separation_along(placed_a, placed_b, face), face);
    }
    for (const Vec3& face : placed_b.normals) {
        best.offer(separation_along(placed_a, placed_b, -face), -face);
    }
    offer_edges(placed_a, placed_b, best);
    if (normal) *normal = best.normal;
    return best.separation;
}

}  // namespace throng
