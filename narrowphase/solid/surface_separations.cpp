#include "narrowphase/solid/surface_separations.hpp"

#include "kernels/geometry/closest_points.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "narrowphase/manifold/places_between.hpp"
#include "narrowphase/mesh/triangle_contacts.hpp"
#include "narrowphase/solid/solid_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

using Manifold = LocalManifold<double>;

// What is so near the rim of a face, as a part of a triangle's size, is over it: rounding alone
// says which of two triangles a place on their seam is over.
constexpr double kSeam = 1e-9;
// An edge goes through a triangle that it passes so near, likewise: what is more would take two
// that are hardly apart for crossed.
constexpr double kRounding = 1e-13;
// Places this near one another, as a part of the speculative margin, with normals as near, are the
// same, told of two triangles.
constexpr double kSame = 1e-3;
// The least depth that is looked for first, as a part of what two solids are off by.
constexpr double kNarrow = 1.0 / 16;
// Sine of the angle between edges that are level with one another.
constexpr double kLevel = 1e-6;

// A triangle of one mesh in the frame of another.
struct Placed {
    const MeshTriangle& triangle;
    const Mat3& turn;  // of its own axes
    std::array<Vec3, 3> corners;
    Vec3 normal;

    Placed(const MeshTriangle& of, const Mat3& by, const Vec3& at)
        : triangle(of), turn(by), normal(by * of.normal)
    {
        for (std::size_t i = 0; i < 3; ++i) corners[i] = by * of.corners[i] + at;
    }

    double size() const { return (corners[1] - corners[0]).cwiseAbs().maxCoeff(); }
    Vec3 seen(const Vec3& direction) const { return turn.transpose() * direction; }
    bool corner_out(std::size_t corner, const Vec3& direction, double slack) const
    {
        return corner_sticks_out(triangle, corner, seen(direction), slack);
    }
    bool edge_out(std::size_t edge, const Vec3& direction, double slack) const
    {
        return edge_sticks_out(triangle, edge, seen(direction), slack);
    }
    // Each edge is told of by one of its two triangles.
    bool owns(std::size_t edge) const
    {
        return triangle.mesh.adjacent[triangle.index][edge]
            < static_cast<std::int32_t>(triangle.index);
    }
    // What an edge turns outward, of any length.
    Vec3 outward_of_edge(std::size_t edge) const
    {
        const Mesh& mesh = triangle.mesh;
        const std::int32_t beyond = mesh.adjacent[triangle.index][edge];
        if (beyond < 0) return normal;
        return normal + turn * mesh.normals[static_cast<std::size_t>(beyond)];
    }
    Segment<double> edge(std::size_t i) const { return {corners[i], corners[(i + 1) % 3]}; }
};

// Whether an edge of the one goes through the other.
bool pierces(const Placed& one, const Placed& other)
{
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 &from = one.corners[i], &to = one.corners[(i + 1) % 3];
        const double begin = other.normal.dot(from - other.corners[0]);
        const double end = other.normal.dot(to - other.corners[0]);
        if (!(begin * end < 0)) continue;
        const Vec3 place = from + (to - from) * (begin / (begin - end));
        const auto& c = other.corners;
        const auto nearest = closest_on_triangle<double>(place, c[0], c[1], c[2]);
        if ((nearest.point - place).norm() <= kRounding * other.size()) return true;
    }
    return false;
}

// `below` m: how far a place of the one may lie behind the other and is told of, if surfaces that
// cross are to be told of at all. `closed` says whether b has an inside, as a has.
class TwoSurfaces {
public:
    TwoSurfaces(const Mesh& a,
                const Mesh& b,
                const Pose& b_in_a,
                double speculative_margin,
                double below = 0,
                bool closed = false)
        : a_(a), b_(b), closed_(closed), turn_(b_in_a.orientation.toRotationMatrix()),
          spread_(turn_.cwiseAbs()), shift_(b_in_a.position),
          speculative_margin_(speculative_margin), below_(below),
          wide_(std::max(speculative_margin, below))
    { }

    /// Whether the two cross; unless that is to be told of, what was found is not all then.
    bool look()
    {
        visit_triangle_pairs(
            a_, b_,
            [&](const Box3& p, const Box3& q) { return !(cross_ && below_ == 0) && near(p, q); },
            [&](std::uint32_t p, std::uint32_t q) { process(p, q); });
        return cross_;
    }

    const std::vector<Manifold>& found() const { return found_; }
    /// Pairs of triangles that were held against one another.
    std::size_t looked_at() const { return looked_at_; }

private:
    bool near(const Box3& p, const Box3& q) const
    {
        const Vec3 middle = turn_ * (0.5 * (q.lower + q.upper)) + shift_;
        const Vec3 half = spread_ * (0.5 * (q.upper - q.lower)) + Vec3::Constant(wide_);
        return p.overlaps({middle - half, middle + half});
    }

    void process(std::uint32_t p, std::uint32_t q)
    {
        static const Mat3 kUnturned = Mat3::Identity();
        ++looked_at_;
        const MeshTriangle own(a_, p), others(b_, q);
        const Placed a(own, kUnturned, Vec3::Zero()), b(others, turn_, shift_);
        if (beside_plane(a.normal, a.corners, b.corners, wide_)
            || beside_plane(b.normal, b.corners, a.corners, wide_))
            return;
        cross_ = cross_ || pierces(a, b) || pierces(b, a);
        if (cross_ && below_ == 0) return;
        for (std::size_t i = 0; i < 3; ++i) {
            look_at_corner(a, i, b, 1);
            look_at_corner(b, i, a, -1);
            for (std::size_t k = 0; k < 3; ++k)
                if (a.owns(i) && b.owns(k)) look_at_edges(a, i, b, k);
        }
    }

    // A corner of one and the nearest place of the other. `sign` is of a normal from the one to the
    // other, as a to b.
    void look_at_corner(const Placed& one, std::size_t corner, const Placed& other, double sign)
    {
        const Vec3& place = one.corners[corner];
        const double height = other.normal.dot(place - other.corners[0]);
        if (!(height <= speculative_margin_) || !(height > -below_)) return;
        const auto& c = other.corners;
        const auto nearest = closest_on_triangle<double>(place, c[0], c[1], c[2]);
        const Vec3 apart = place - nearest.point;
        const Vec3 past = apart - other.normal * height;
        Vec3 outward = other.normal;  // of the other
        double distance = height, slack = speculative_margin_;
        if (past.norm() > kSeam * other.size()) {
            distance = apart.norm();
            if (!(distance <= speculative_margin_) || !(height > 0)) return;
            outward = apart / distance;
            const auto region = static_cast<std::size_t>(nearest.region);
            if (region > 3 ? !other.corner_out(region - 4, outward, 0)
                           : region > 0 && !other.edge_out(region - 1, outward, 0))
                return;
            slack = 0;
        }
        if (!one.corner_out(corner, -outward, slack)) return;
        add(place - outward * (distance / 2), outward * -sign, distance);
    }

    void look_at_edges(const Placed& a, std::size_t i, const Placed& b, std::size_t k)
    {
        const auto nearest = closest_points<double>(a.edge(i), b.edge(k));
        const bool inner =
            nearest.at_a > 0 && nearest.at_a < 1 && nearest.at_b > 0 && nearest.at_b < 1;
        const Vec3 apart = nearest.on_b - nearest.on_a;
        if (!inner || !(apart.norm() <= wide_)) return;
        const Vec3 across = along(a, i).cross(along(b, k));
        if (!(across.norm() > kLevel)) return;  // corners tell of edges side by side
        Vec3 normal = across.normalized();
        if (normal.dot(a.outward_of_edge(i) - b.outward_of_edge(k)) < 0) normal = -normal;
        const double separation = normal.dot(apart);
        if (!(separation <= speculative_margin_) || !(separation > -below_)) return;
        if (!a.edge_out(i, normal, speculative_margin_)
            || !b.edge_out(k, -normal, speculative_margin_))
            return;
        add((nearest.on_a + nearest.on_b) / 2, normal, separation);
    }

    static Vec3 along(const Placed& one, std::size_t edge)
    {
        return (one.corners[(edge + 1) % 3] - one.corners[edge]).normalized();
    }

    // What is behind the far side of the other need not be in it: what lies between the two is in
    // both.
    bool overlap_at(const Vec3& place) const
    {
        const double slack = kSame * wide_;
        return signed_distance(a_, place) <= slack
            && (!closed_ || signed_distance(b_, turn_.transpose() * (place - shift_)) <= slack);
    }

    void add(const Vec3& place, const Vec3& normal, double separation)
    {
        if (separation < 0 && !overlap_at(place)) return;
        for (const Manifold& other : found_)
            if ((other.points[0].position - place).norm() <= kSame * wide_
                && (other.normal - normal).norm() <= kSame)
                return;
        Manifold manifold;
        manifold.normal = normal;
        manifold.add(place, separation, 0);
        found_.push_back(manifold);
    }

    const Mesh &a_, &b_;
    bool closed_;
    Mat3 turn_, spread_;
    Vec3 shift_;
    double speculative_margin_, below_, wide_;
    bool cross_ = false;
    std::size_t looked_at_ = 0;
    std::vector<Manifold> found_;
};

// The corners of a mesh that are within the margin of a plane.
std::vector<Manifold>
corners_over(const Plane& plane, const Pose& pose, const Mesh& mesh, double speculative_margin)
{
    const Vec3 normal = pose.orientation * plane.normal;
    const double offset = plane.offset + normal.dot(pose.position);
    std::vector<Manifold> found;
    visit_nodes(
        mesh,
        [&](const Mesh::Node& node) {
            const Vec3 middle = 0.5 * (node.lower + node.upper);
            const double half = normal.cwiseAbs().dot(0.5 * (node.upper - node.lower));
            return normal.dot(middle) - half - offset <= speculative_margin;
        },
        [&](std::uint32_t triangle) {
            for (const std::uint32_t corner : mesh.triangles[triangle]) {
                const Vec3& place = mesh.vertices[corner];
                const double height = normal.dot(place) - offset;
                if (!(height <= speculative_margin)) continue;
                Manifold manifold;
                manifold.normal = -normal;
                manifold.add(place - normal * (height / 2), height, corner);
                found.push_back(manifold);
            }
        });
    const auto feature = [](const Manifold& one) { return one.points[0].feature; };
    std::sort(found.begin(), found.end(),
              [&](const Manifold& p, const Manifold& q) { return feature(p) < feature(q); });
    found.erase(
        std::unique(found.begin(), found.end(),
                    [&](const Manifold& p, const Manifold& q) { return feature(p) == feature(q); }),
        found.end());
    return found;
}

void append_spread(const std::vector<Manifold>& found, std::vector<Manifold>& out)
{
    if (found.size() <= kMostSurfaceSeparations) {
        out.insert(out.end(), found.begin(), found.end());
        return;
    }
    std::vector<Manifold::Point> places;
    places.reserve(found.size());
    for (const Manifold& one : found) places.push_back(one.points[0]);
    std::vector<std::size_t> taken;
    take_between(places, 0, 0, kMostSurfaceSeparations, taken);
    for (const std::size_t at : taken) out.push_back(found[at]);
}

double least_of(const std::vector<Manifold>& found)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Manifold& one : found)
        for (int k = 0; k < one.count; ++k)
            least = std::min(least, one.points[static_cast<std::size_t>(k)].separation);
    return least;
}

// m, how deep the deepest corner of the one lies within the other; not above 0 where none does.
// What is deeper than `enough` is told as any that is.
double deepest_corner(const Mesh& one, const Mesh& other, const Pose& one_in_other, double enough)
{
    double deepest = 0;
    if (other.tree.empty()) return deepest;
    const Mat3 turn = one_in_other.orientation.toRotationMatrix();
    const Box3 whole{other.tree.front().lower, other.tree.front().upper};
    for (const Vec3& corner : one.vertices) {
        const Vec3 place = turn * corner + one_in_other.position;
        if (!whole.overlaps({place, place})) continue;
        deepest = std::max(deepest, -signed_distance(other, place));
        if (deepest > enough) break;
    }
    return deepest;
}

// m, by how much two surfaces that cross have come into one another, as their corners tell. Images
// and fields of two that just touch beside one another tell of all between their far sides.
double depth_by_corners(const PairInput<double>& in, double enough)
{
    if (in.b.kind != ShapeKind::solid)  // who has no inside has no depth
        return std::numeric_limits<double>::infinity();
    const Mesh &mesh = *mesh_of(in.shapes, in.a), &other = *mesh_of(in.shapes, in.b);
    return std::max(deepest_corner(other, mesh, in.b_in_a, enough),
                    deepest_corner(mesh, other, in.b_in_a.inverse(), enough));
}

// What contacts that let bodies overlap have of the two, where they overlap by more than `most`.
bool append_deep(const PairInput<double>& in, double most, std::vector<Manifold>& out)
{
    const auto& [shapes, solid, other, other_in_solid, speculative_margin] = in;
    std::vector<PartManifold> patches;
    collide_solid({shapes, solid, other, other_in_solid, speculative_margin}, patches);
    std::vector<Manifold> found;
    found.reserve(patches.size());
    for (const PartManifold& patch : patches) found.push_back(patch.manifold);
    if (!(least_of(found) < -most)) return false;
    out.insert(out.end(), found.begin(), found.end());
    return true;
}

}  // namespace

std::size_t find_surface_separations(const PairInput<double>& in,
                                     std::vector<LocalManifold<double>>& out)
{
    const auto& [shapes, solid, other, other_in_solid, speculative_margin] = in;
    const Mesh& mesh = *mesh_of(shapes, solid);
    if (other.kind == ShapeKind::plane) {
        const auto found =
            corners_over(shapes.planes[other.index], other_in_solid, mesh, speculative_margin);
        append_spread(found, out);
        return found.size();
    }
    TwoSurfaces surfaces(mesh, *mesh_of(shapes, other), other_in_solid, speculative_margin);
    if (!surfaces.look()) {
        append_spread(surfaces.found(), out);
        return surfaces.looked_at();
    }
    const double seen = shape_error(shapes, solid) + shape_error(shapes, other);
    const double depth = depth_by_corners(in, 2 * seen);
    const bool deep = depth > 2 * seen;
    if (deep && append_deep(in, 2 * seen, out)) return surfaces.looked_at();
    std::size_t looked_at = surfaces.looked_at();
    // What is told of is sought no further behind than it can be: of all else there is much.
    for (const double below : {std::max(2 * depth, kNarrow * seen), 4 * seen}) {
        if (below > 4 * seen) continue;
        TwoSurfaces shallow(mesh, *mesh_of(shapes, other), other_in_solid, speculative_margin,
                            below, other.kind == ShapeKind::solid);
        shallow.look();
        looked_at += shallow.looked_at();
        if (!(least_of(shallow.found()) <= 0)) continue;
        append_spread(shallow.found(), out);
        return looked_at;
    }
    // An edge may lie deep across another with no corner within.
    if (!deep && append_deep(in, 2 * seen, out)) return looked_at;
    // By less than anything tells.
    Manifold none;
    const double length = other_in_solid.position.norm();
    none.normal = length > 0 ? Vec3(other_in_solid.position / length) : Vec3(Vec3::UnitZ());
    none.add(0.5 * other_in_solid.position, 0, 0);
    out.push_back(none);
    return looked_at;
}

}  // namespace throng
