#include "cooking/hulls/hull.hpp"

#include "cooking/hulls/hull_cloud.hpp"
#include "cooking/hulls/hull_faces.hpp"
#include "cooking/hulls/hull_guide.hpp"
#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/wide_hull.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace throng {
namespace {

// How far a face may stray from its plane, against the extent: some hundred times the rounding of
// single precision, a tenth of what contact lets shapes overlap. Ten times more would merge the
// faces of finely rounded edges.
constexpr double kTolerance = 1e-5;
// The same against the thickness, so that the two sides of a plate never meet.
constexpr double kToleranceOfThickness = 1e-3;
// What did not come out sound is built again with a tolerance this much smaller, then without.
constexpr double kStricter = 1.0 / 16;
constexpr int kTries = 5;
constexpr std::size_t kMostIndices = 65535;

// Corners by how often each is named: those that are named `least` times or more, in order.
class CornerCount {
public:
    void add(std::span<const std::uint32_t> corners)
    {
        for (const std::uint32_t corner : corners) {
            if (corner >= times_.size()) times_.resize(corner + std::size_t{1}, 0);
            ++times_[corner];
        }
    }
    std::vector<std::uint32_t> named(std::uint32_t least) const
    {
        std::vector<std::uint32_t> corners;
        for (std::uint32_t i = 0; i < times_.size(); ++i)
            if (times_[i] >= least) corners.push_back(i);
        return corners;
    }

private:
    std::vector<std::uint32_t> times_;
};

std::vector<std::uint32_t> corners_of(const TriangleHull& hull)
{
    CornerCount count;
    for (const auto& triangle : hull.triangles) count.add(triangle);
    return count.named(1);
}

// The corners that three faces or more share, in order.
std::vector<std::uint32_t> true_corners(const std::vector<HullFace>& faces)
{
    CornerCount count;
    for (const HullFace& face : faces) count.add(face.corners);
    return count.named(3);
}

// Four of the chosen that enclose a volume go first, for exact_hull() to start from.
bool start_first(const HullCloud& cloud, std::vector<std::uint32_t>& chosen)
{
    HullCloud part;
    for (const std::uint32_t i : chosen) part.points.push_back(cloud.points[i]);
    find_start(part);
    if (!part.trouble.empty()) return false;
    std::vector<std::uint32_t> ordered;
    for (const std::uint32_t i : part.start) ordered.push_back(chosen[i]);
    for (const std::uint32_t i : chosen)
        if (std::find(ordered.begin(), ordered.begin() + 4, i) == ordered.begin() + 4)
            ordered.push_back(i);
    chosen = std::move(ordered);
    return true;
}

// Merges faces, drops corners that this leaves inside a face or on an edge, and builds the hull of
// the others, until none is dropped. Empty where the tolerance does not suit the points.
std::vector<HullFace> simplify(const HullCloud& cloud,
                               std::span<const GridPoint> grid,
                               TriangleHull hull,
                               double tolerance)
{
    std::vector<std::uint32_t> corners = corners_of(hull);
    while (true) {
        std::vector<HullFace> faces = merge_faces(cloud.points, hull, tolerance);
        std::vector<std::uint32_t> kept = true_corners(faces);
        if (kept.size() == corners.size()) return faces;
        if (kept.size() < 4 || !start_first(cloud, kept)) return {};
        hull = exact_hull(grid, kept);
        corners = corners_of(hull);
    }
}

// One side of a face, seen from its lesser corner.
struct Side {
    std::uint32_t low, high, face;
    bool rising;
};

// Whether every edge has two faces, two faces have one edge at most, and Euler's formula holds.
bool closes(const std::vector<HullFace>& faces)
{
    std::vector<Side> sides;
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        for (std::size_t i = 0; i < faces[f].corners.size(); ++i) {
            const std::uint32_t from = faces[f].corners[i];
            const std::uint32_t to = faces[f].corners[(i + 1) % faces[f].corners.size()];
            sides.push_back({std::min(from, to), std::max(from, to), f, from < to});
        }
    if (faces.size() < 4 || sides.size() % 2 != 0) return false;
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::array{a.low, a.high, a.face} < std::array{b.low, b.high, b.face};
    });

    std::vector<std::array<std::uint32_t, 2>> shared_edges;
    for (std::size_t i = 0; i < sides.size(); i += 2) {
        const Side &a = sides[i], &b = sides[i + 1];
        if (a.low != b.low || a.high != b.high || a.rising == b.rising) return false;
        shared_edges.push_back({a.face, b.face});
    }
    std::sort(shared_edges.begin(), shared_edges.end());
    return std::adjacent_find(shared_edges.begin(), shared_edges.end()) == shared_edges.end()
        && true_corners(faces).size() + faces.size() == shared_edges.size() + 2;
}

// Whether faces keep to their planes.
bool are_flat(const HullCloud& cloud, const std::vector<HullFace>& faces, double tolerance)
{
    return std::all_of(faces.begin(), faces.end(), [&](const HullFace& face) {
        const double top = face.normal.dot(cloud.points[face.highest]);
        return std::abs(face.normal.squaredNorm() - 1) < 1e-9
            && std::all_of(face.corners.begin(), face.corners.end(), [&](std::uint32_t corner) {
                   return top - face.normal.dot(cloud.points[corner]) <= 2 * tolerance + 1e-12;
               });
    });
}

// Whether the corners that were dropped are outside by little.
bool covers(const HullCloud& cloud,
            const std::vector<HullFace>& faces,
            const std::vector<std::uint32_t>& corners,
            double tolerance)
{
    const std::vector<std::uint32_t> kept = true_corners(faces);
    return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t corner) {
        if (std::binary_search(kept.begin(), kept.end(), corner)) return true;
        return std::all_of(faces.begin(), faces.end(), [&](const HullFace& face) {
            const Vec3 out = cloud.points[corner] - cloud.points[face.highest];
            return face.normal.dot(out) <= 4 * tolerance;
        });
    });
}

std::vector<HullFace> find_faces(const HullCloud& cloud)
{
    const std::vector<GridPoint> grid = round_to_grid(cloud);
    std::vector<std::uint32_t> chosen(cloud.start.begin(), cloud.start.end());
    for (std::uint32_t i = 0; i < cloud.points.size(); ++i)
        if (std::find(cloud.start.begin(), cloud.start.end(), i) == cloud.start.end())
            chosen.push_back(i);
    const TriangleHull hull = exact_hull(grid, chosen);
    const std::vector<std::uint32_t> corners = corners_of(hull);

    double tolerance = std::min(kTolerance * cloud.extent, kToleranceOfThickness * cloud.thickness);
    for (int i = 0; i < kTries; ++i, tolerance *= kStricter) {
        std::vector<HullFace> faces = simplify(cloud, grid, hull, tolerance);
        if (closes(faces) && are_flat(cloud, faces, tolerance)
            && covers(cloud, faces, corners, tolerance))
            return faces;
    }
    return merge_faces(cloud.points, hull, 0);
}

// Each face begins with its first corner, and faces follow one another by their corners.
void put_in_order(std::vector<HullFace>& faces)
{
    for (HullFace& face : faces)
        std::rotate(face.corners.begin(),
                    std::min_element(face.corners.begin(), face.corners.end()), face.corners.end());
    std::sort(faces.begin(), faces.end(),
              [](const HullFace& a, const HullFace& b) { return a.corners < b.corners; });
}

void fill_faces(std::span<const Vec3> points, const std::vector<HullFace>& faces, Hull& hull)
{
    const std::vector<std::uint32_t> corners = true_corners(faces);
    for (const std::uint32_t corner : corners) hull.vertices.push_back(points[corner]);
    hull.face_begin.push_back(0);
    for (const HullFace& face : faces) {
        // Adding zero turns -0 into 0.
        hull.normals.emplace_back(face.normal + Vec3::Zero());
        hull.offsets.push_back(hull.normals.back().dot(points[face.highest]));
        for (const std::uint32_t corner : face.corners) {
            const auto at = std::lower_bound(corners.begin(), corners.end(), corner);
            hull.face_vertices.push_back(static_cast<std::uint16_t>(at - corners.begin()));
        }
        hull.face_begin.push_back(static_cast<std::uint32_t>(hull.face_vertices.size()));
    }
}

// Calls visit(from, to, face) for each side of each face.
template <class Visitor>
void visit_sides(const Hull& hull, Visitor visit)
{
    for (std::size_t face = 0; face < hull.normals.size(); ++face) {
        const std::size_t begin = hull.face_begin[face], end = hull.face_begin[face + 1];
        for (std::size_t i = begin; i < end; ++i)
            visit(hull.face_vertices[i], hull.face_vertices[i + 1 < end ? i + 1 : begin],
                  static_cast<std::uint16_t>(face));
    }
}

void fill_edges(Hull& hull)
{
    using Edge = Hull::Edge;
    std::vector<Edge> back;
    visit_sides(hull, [&](std::uint16_t from, std::uint16_t to, std::uint16_t face) {
        if (from < to) hull.edges.push_back({from, to, face, face});
        if (from > to) back.push_back({to, from, face, face});
    });
    const auto before = [](const Edge& a, const Edge& b) {
        return a.from != b.from ? a.from < b.from : a.to < b.to;
    };
    std::sort(hull.edges.begin(), hull.edges.end(), before);
    std::sort(back.begin(), back.end(), before);
    for (std::size_t i = 0; i < back.size(); ++i) hull.edges[i].right = back[i].left;

    std::vector<std::array<std::uint16_t, 2>> joins;
    for (const Edge& edge : hull.edges) {
        joins.push_back({edge.from, edge.to});
        joins.push_back({edge.to, edge.from});
    }
    std::sort(joins.begin(), joins.end());
    hull.neighbor_begin.assign(hull.vertices.size() + 1, 0);
    for (const auto& [vertex, neighbor] : joins) {
        hull.neighbors.push_back(neighbor);
        ++hull.neighbor_begin[vertex + std::size_t{1}];
    }
    std::partial_sum(hull.neighbor_begin.begin(), hull.neighbor_begin.end(),
                     hull.neighbor_begin.begin());
}

void fill_balls(Hull& hull)
{
    hull.center = mass_of(hull).center;
    hull.inner_radius = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hull.normals.size(); ++i)
        hull.inner_radius =
            std::min(hull.inner_radius, hull.offsets[i] - hull.normals[i].dot(hull.center));
    for (const Vec3& vertex : hull.vertices)
        hull.outer_radius = std::max(hull.outer_radius, (vertex - hull.center).norm());
}

}  // namespace

HullResult build_hull(std::span<const Vec3> points)
{
    HullResult result;
    const HullCloud cloud = hull_cloud(points);
    result.trouble = cloud.trouble;
    if (!result.trouble.empty()) return result;

    std::vector<HullFace> faces = find_faces(cloud);
    const std::size_t most = std::max(faces.size(), true_corners(faces).size());
    if (most > kMostIndices) {
        result.trouble = "needs " + std::to_string(most) + " vertices or faces, more than the "
            + std::to_string(kMostIndices) + " that a hull may have; give fewer points";
        return result;
    }
    put_in_order(faces);
    fill_faces(points, faces, result.hull);
    fill_edges(result.hull);
    fill_balls(result.hull);
    widen(result.hull);
    make_guide(result.hull);
    return result;
}

}  // namespace throng
