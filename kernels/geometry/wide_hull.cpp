#include "kernels/geometry/wide_hull.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace throng {
namespace {

// Squares and their products stay well inside float's range between these sizes, m.
constexpr double kSmallest = 1e-9, kGreatest = 1e9;
// Rounding is some 1e-6 of the size: a plate thinner than this part of it would be lost in that.
constexpr double kThinnest = 1e-3;

bool is_suited(const Hull& hull)
{
    const auto fits = [](std::size_t count, int most) {
        return count <= static_cast<std::size_t>(most);
    };
    bool suited = fits(hull.vertices.size(), kWideVertices) && fits(hull.normals.size(), kWideFaces)
        && fits(hull.edges.size(), kWideEdges);
    suited = suited && is_wide(hull.inner_radius, hull.outer_radius);
    for (std::size_t i = 0; suited && i < hull.normals.size(); ++i)
        suited = fits(hull.face_begin[i + 1] - hull.face_begin[i], kWideCorners);
    return suited;
}

// The edge between two corners, as it is told by the face to its left or to its right.
std::uint16_t edge_between(const Hull& hull, std::uint16_t from, std::uint16_t to)
{
    const auto found =
        std::find_if(hull.edges.begin(), hull.edges.end(), [&](const Hull::Edge& edge) {
            return (edge.from == from && edge.to == to) || (edge.from == to && edge.to == from);
        });
    return static_cast<std::uint16_t>(found - hull.edges.begin());
}

void fill_indices(const Hull& hull, std::vector<std::uint16_t>& indices)
{
    indices.assign(hull.face_begin.begin(), hull.face_begin.end());
    indices.insert(indices.end(), hull.face_vertices.begin(), hull.face_vertices.end());
    for (std::size_t face = 0; face < hull.normals.size(); ++face) {
        const std::size_t begin = hull.face_begin[face], end = hull.face_begin[face + 1];
        for (std::size_t i = begin; i < end; ++i)
            indices.push_back(edge_between(hull, hull.face_vertices[i],
                                           hull.face_vertices[i + 1 < end ? i + 1 : begin]));
    }
    std::vector<std::uint16_t> begins = {0}, around;
    for (std::size_t vertex = 0; vertex < hull.vertices.size(); ++vertex) {
        for (std::size_t face = 0; face < hull.normals.size(); ++face) {
            const auto begin = hull.face_vertices.begin() + hull.face_begin[face];
            const auto end = hull.face_vertices.begin() + hull.face_begin[face + 1];
            if (std::find(begin, end, vertex) != end)
                around.push_back(static_cast<std::uint16_t>(face));
        }
        begins.push_back(static_cast<std::uint16_t>(around.size()));
    }
    indices.insert(indices.end(), begins.begin(), begins.end());
    indices.insert(indices.end(), around.begin(), around.end());
}

// Of each face the cosine of half the widest angle to a neighbor, a little less of it.
std::vector<double> leans_of(const Hull& hull)
{
    std::vector<double> lean(hull.normals.size(), 1);
    for (const Hull::Edge& edge : hull.edges) {
        const double cosine = hull.normals[edge.left].dot(hull.normals[edge.right]);
        const double half = std::sqrt(std::max(0.0, (1 + cosine) / 2)) * (1 - 1e-5);
        lean[edge.left] = std::min(lean[edge.left], half);
        lean[edge.right] = std::min(lean[edge.right], half);
    }
    return lean;
}

// Number k of a face: its normal, how far it is from the center, and its lean; of what only fills
// up a group what never leads.
double number_of_face(const Hull& hull, std::span<const double> leans, std::size_t face, int k)
{
    if (face >= hull.normals.size())
        return k == 3 ? std::numeric_limits<float>::max() : k == 4 ? 1 : 0;
    if (k < 3) return hull.normals[face][k];
    return k == 3 ? hull.offsets[face] - hull.normals[face].dot(hull.center) : leans[face];
}

void fill_numbers(const Hull& hull, WideHull& wide)
{
    wide.numbers.resize(static_cast<std::size_t>(
        WidePolytope::count_of_numbers(wide.vertices, wide.faces) / kWideGroup));
    float* at = wide.numbers.data()->at;
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < WidePolytope::whole(wide.vertices); ++i) {
            const int vertex = i < wide.vertices ? i : 0;
            const Vec3 from_center = hull.vertices[static_cast<std::size_t>(vertex)] - hull.center;
            *at++ = static_cast<float>(from_center[k]);
        }
    const std::vector<double> leans = leans_of(hull);
    for (int k = 0; k < 5; ++k)
        for (int i = 0; i < WidePolytope::whole(wide.faces); ++i)
            *at++ = static_cast<float>(number_of_face(hull, leans, static_cast<std::size_t>(i), k));
}

}  // namespace

bool is_wide(double inner_radius, double outer_radius)
{
    return outer_radius > kSmallest && outer_radius < kGreatest
        && inner_radius > kThinnest * outer_radius;
}

void widen(Hull& hull)
{
    WideHull& wide = hull.wide;
    wide = {};
    if (!is_suited(hull)) return;
    wide.vertices = static_cast<int>(hull.vertices.size());
    wide.faces = static_cast<int>(hull.normals.size());
    wide.inner = static_cast<float>(hull.inner_radius);
    wide.outer = static_cast<float>(hull.outer_radius);
    for (const Hull::Edge& edge : hull.edges) {
        const Vec3 along = (hull.vertices[edge.to] - hull.vertices[edge.from]).normalized();
        wide.edges.push_back({{static_cast<float>(along.x()), static_cast<float>(along.y()),
                               static_cast<float>(along.z())},
                              edge.from,
                              edge.to,
                              edge.left,
                              edge.right});
    }
    fill_indices(hull, wide.indices);
    fill_numbers(hull, wide);
}

}  // namespace throng
