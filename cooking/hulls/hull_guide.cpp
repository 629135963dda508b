#include "cooking/hulls/hull_guide.hpp"

#include <array>

namespace throng {
namespace {

// A cell for each vertex, about: climbing then takes a step or two. Beyond the greatest side the
// table would drive the vertices themselves from the cache.
constexpr double kGreatestSide = 24;

// From how many corners a face's rim is long to walk.
constexpr std::uint32_t kManyCorners = 12;

// Of the extent: twice what rounding to the grid that hulls are built on moves a vertex, and more.
constexpr double kGrid = 1e-11;

// How far below the plane of its face a corner lies at most.
double unevenness(const Hull& hull)
{
    double most = 0;
    for (std::size_t face = 0; face < hull.normals.size(); ++face)
        for (std::size_t i = hull.face_begin[face]; i < hull.face_begin[face + 1]; ++i)
            most = std::max(most,
                            hull.offsets[face]
                                - hull.normals[face].dot(hull.vertices[hull.face_vertices[i]]));
    return most;
}

// Across a face of many corners, links to those a quarter of the rim away, a sixteenth, and so on.
void link_far_corners(Hull& hull)
{
    using Link = std::array<std::uint16_t, 2>;
    std::vector<Link> far;
    for (std::size_t face = 0; face < hull.normals.size(); ++face) {
        const std::uint32_t begin = hull.face_begin[face];
        const std::uint32_t corners = hull.face_begin[face + 1] - begin;
        if (corners < kManyCorners) continue;
        for (std::uint32_t step = corners / 4; step > 1; step /= 4)
            for (std::uint32_t i = 0; i < corners; ++i) {
                const std::uint16_t from = hull.face_vertices[begin + i];
                const std::uint16_t to = hull.face_vertices[begin + (i + step) % corners];
                far.push_back({from, to});
                far.push_back({to, from});
            }
    }
    if (far.empty()) return;
    std::sort(far.begin(), far.end());
    auto next = far.begin();
    for (std::size_t vertex = 0; vertex < hull.vertices.size(); ++vertex) {
        hull.guide.begin.push_back(static_cast<std::uint32_t>(hull.guide.links.size()));
        for (std::size_t i = hull.neighbor_begin[vertex]; i < hull.neighbor_begin[vertex + 1]; ++i)
            hull.guide.links.push_back(hull.neighbors[i]);
        for (; next != far.end() && (*next)[0] == vertex; ++next)
            hull.guide.links.push_back((*next)[1]);
    }
    hull.guide.begin.push_back(static_cast<std::uint32_t>(hull.guide.links.size()));
}

// The vertex that climbing ends on: good enough to begin with.
std::uint16_t climb(const Hull& hull, const Vec3& direction, std::uint16_t start)
{
    std::uint16_t best = start;
    double most = direction.dot(hull.vertices[best]);
    for (bool climbed = true; climbed;) {
        climbed = false;
        const std::size_t here = best;
        for (std::size_t i = hull.neighbor_begin[here]; i < hull.neighbor_begin[here + 1]; ++i) {
            const double height = direction.dot(hull.vertices[hull.neighbors[i]]);
            if (!(height > most)) continue;
            most = height;
            best = hull.neighbors[i];
            climbed = true;
        }
    }
    return best;
}

void fill_table(Hull& hull)
{
    HullGuide& guide = hull.guide;
    const double wanted = std::sqrt(static_cast<double>(hull.vertices.size()) / 6);
    guide.side = static_cast<std::uint32_t>(std::clamp(std::ceil(wanted), 2.0, kGreatestSide));
    guide.toward.resize(std::size_t{6} * guide.side * guide.side);
    const auto middle = [&](std::uint32_t i) { return (2.0 * i + 1) / guide.side - 1; };
    std::uint16_t last = 0;
    for (int face = 0; face < 6; ++face)
        for (std::uint32_t row = 0; row < guide.side; ++row)
            for (std::uint32_t i = 0; i < guide.side; ++i) {
                // To and fro, so that each cell lies beside the one before.
                const std::uint32_t column = row % 2 == 0 ? i : guide.side - 1 - i;
                Vec3 direction;
                direction[face / 2] = face % 2 == 0 ? -1 : 1;
                direction[(face / 2 + 1) % 3] = middle(row);
                direction[(face / 2 + 2) % 3] = middle(column);
                last = climb(hull, direction, last);
                guide.toward[guide.cell(direction)] = last;
            }
}

}  // namespace

void make_guide(Hull& hull)
{
    hull.guide = {};
    hull.guide.slack =
        2 * unevenness(hull) + kGrid * hull.outer_radius + 1e-15 * hull.center.norm();
    link_far_corners(hull);
    fill_table(hull);
}

}  // namespace throng
