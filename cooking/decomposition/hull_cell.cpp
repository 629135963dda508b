#include "cooking/decomposition/hull_cell.hpp"

#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace throng {
namespace {

// Of the error: how far beyond its edge a plane is, so that neighbors whose planes all but agree do
// not cut one another short, and how near to a plane an edge is let be.
constexpr double kBeyond = 0.25, kOnPlane = 0.5;
// What is covered already counts so much of what is not.
constexpr double kCovered = 0.05;
// A cell of a round shape has some dozens.
constexpr std::size_t kMostPlanes = 256;
// Looks between two points of a mesh for air between them.
constexpr int kLooksBetween = 32;
// A face turned further away from a plane than this runs along it.
constexpr double kAway = -0.95;

// Whether a plane along an inward edge leaves what is solid beside the edge in one, and does not
// run along a face from beyond it: the strip between would be of the cell.
bool resolves(const InwardEdge& edge, const Vec3& along, const Vec3& normal)
{
    // Along both faces away from the edge. With both below the plane the air between them is.
    const bool parts =
        normal.dot(edge.normal.cross(along)) < -1e-6 && normal.dot(along.cross(edge.other)) < -1e-6;
    return !parts && normal.dot(edge.normal) >= kAway && normal.dot(edge.other) >= kAway;
}

// Sets of points that edges join.
class Joined {
public:
    explicit Joined(const MeshPiece& piece) : above_(piece.points.size())
    {
        std::iota(above_.begin(), above_.end(), 0u);
        for (const auto& [a, b, c] : piece.surface) {
            const std::uint32_t least = std::min({root(a), root(b), root(c)});
            for (const std::uint32_t i : {a, b, c}) above_[root(i)] = least;
        }
    }

    std::uint32_t root(std::uint32_t i)
    {
        while (above_[i] != i) i = above_[i] = above_[above_[i]];
        return i;
    }
    bool is_one()
    {
        for (std::uint32_t i = 0; i < above_.size(); ++i)
            if (root(i) != 0) return false;
        return true;
    }

private:
    std::vector<std::uint32_t> above_;
};

}  // namespace

HullCell::HullCell(const PartSearch& search, const std::vector<HullPlace>& places)
    : search_(search), places_(places), spans_(search.edges.size()), within_(places.size())
{
    std::iota(within_.begin(), within_.end(), std::size_t{0});
}

bool HullCell::close(const HullPlace& place)
{
    while (true) {
        const Nearest nearest = nearest_edge(place.center);
        if (!nearest.found) return true;
        Plane plane;
        if (planes_.size() == kMostPlanes || !choose(place, nearest, plane)) return false;
        add(plane);
    }
}

HullCell::Nearest HullCell::nearest_edge(const Vec3& center) const
{
    Nearest best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < spans_.size(); ++i) {
        if (!(spans_[i].from < spans_[i].to)) continue;
        const InwardEdge& edge = search_.edges[i];
        const Vec3 along = edge.to - edge.from;
        const double foot = along.dot(center - edge.from) / along.squaredNorm();
        const Vec3 point = edge.from + std::clamp(foot, spans_[i].from, spans_[i].to) * along;
        const double distance = (point - center).squaredNorm();
        if (!(distance < least)) continue;
        least = distance;
        best = {i, point, true};
    }
    return best;
}

// Of planes along both faces, square to them, between them and square to the way there, that which
// leaves most within.
bool HullCell::choose(const HullPlace& place, const Nearest& nearest, Plane& plane) const
{
    const InwardEdge& edge = search_.edges[nearest.edge];
    const Vec3 along = (edge.to - edge.from).normalized();
    const Vec3 away = nearest.point - place.center;
    const std::array<Vec3, 6> ways = {edge.normal,
                                      edge.other,
                                      along.cross(edge.normal),
                                      along.cross(edge.other),
                                      edge.normal - edge.other,
                                      away - along.dot(away) * along};
    const double beyond = kBeyond * search_.error;
    double best = -1;
    for (const Vec3& way : ways) {
        const double length = way.norm();
        if (!(length > 0)) continue;
        const Vec3 normal = (way.dot(away) < 0 ? -1 : 1) / length * way;
        if (!resolves(edge, along, normal)) continue;
        const Plane made{normal, normal.dot(nearest.point) + beyond};
        if (normal.dot(place.point) > made.offset - beyond / 2) continue;
        if (normal.dot(place.center) > made.offset - beyond) continue;
        const double left = worth(made);
        if (!(left > best)) continue;
        best = left;
        plane = made;
    }
    return best >= 0;
}

double HullCell::worth(const Plane& plane) const
{
    double sum = 0;
    for (const std::size_t i : within_)
        if (plane.normal.dot(places_[i].point) <= plane.offset)
            sum += places_[i].covered ? kCovered : 1;
    return sum;
}

void HullCell::add(const Plane& plane)
{
    planes_.push_back(plane);
    for (std::size_t i = 0; i < spans_.size(); ++i) {
        Span& span = spans_[i];
        const InwardEdge& edge = search_.edges[i];
        const double near = plane.offset - kOnPlane * search_.error;
        const double from = plane.normal.dot(edge.from) - near;
        const double to = plane.normal.dot(edge.to) - near;
        if (from >= 0 && to >= 0)
            span.to = span.from;
        else if (from > 0)
            span.from = std::max(span.from, from / (from - to));
        else if (to > 0)
            span.to = std::min(span.to, from / (from - to));
    }
    std::erase_if(within_,
                  [&](std::size_t i) { return plane.normal.dot(places_[i].point) > plane.offset; });
}

std::vector<Vec3> HullCell::corners(const HullPlace& place) const
{
    MeshPiece piece = whole_piece(search_.mesh);
    for (const Plane& plane : planes_) {
        const bool cuts = std::any_of(piece.points.begin(), piece.points.end(), [&](const Vec3& p) {
            return plane.normal.dot(p) - plane.offset > search_.slack();
        });
        if (cuts) piece = std::move(cut_piece(search_.mesh, piece, plane, search_.slack())[0]);
    }
    Joined joined(piece);
    if (joined.is_one()) {
        piece.points.insert(piece.points.end(), piece.corners.begin(), piece.corners.end());
        return std::move(piece.points);
    }
    // What is seen from the place is one with it: the rest is behind air.
    std::vector<Vec3> points;
    std::vector<char> known(piece.points.size(), '?');
    for (std::uint32_t i = 0; i < piece.points.size(); ++i) {
        char& seen = known[joined.root(i)];
        if (seen == '?') seen = is_seen(place.center, piece.points[i]) ? 'y' : 'n';
        if (seen == 'y') points.push_back(piece.points[i]);
    }
    for (const Vec3& corner : piece.corners)
        if (is_seen(place.center, corner)) points.push_back(corner);
    return points;
}

bool HullCell::is_seen(const Vec3& from, const Vec3& point) const
{
    for (int i = 1; i <= kLooksBetween; ++i) {
        const Vec3 between = point + (from - point) * (i / (kLooksBetween + 1.0));
        if (signed_distance(search_.mesh, between) > kOnPlane * search_.error) return false;
    }
    return true;
}

}  // namespace throng
