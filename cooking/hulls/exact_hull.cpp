#include "cooking/hulls/exact_hull.hpp"

#include "kernels/check.hpp"

#include <cmath>

namespace throng {
namespace {

__extension__ using Int128 = __int128;

constexpr int kGridBits = 40;
constexpr std::uint32_t kNone = 0xffffffffU;

// A triangle of the hull so far, or, once dead, of a hull before.
struct Face {
    std::array<std::uint32_t, 3> corners, adjacent{kNone, kNone, kNone};
    std::array<Int128, 3> normal;   // 2^81 at most
    std::array<double, 3> rounded;  // the normal again
    std::uint32_t outside = kNone;  // first of the points above that wait here, linked by next_
    std::uint32_t visit = 0;        // the addition that last looked at this face
    bool visible = false;           // ... and what it saw
    bool alive = true;
};

struct HorizonEdge {
    std::uint32_t from, to, outer, outer_edge;
};

std::uint32_t edge_from(const Face& face, std::uint32_t corner)
{
    return face.corners[0] == corner ? 0 : face.corners[1] == corner ? 1 : 2;
}

// Quickhull, as in Barber, Dobkin and Huhdanpaa, The quickhull algorithm for convex hulls (1996),
// without their tolerances: a face is visible from a point that is strictly above it.
class Builder {
public:
    Builder(std::span<const GridPoint> points, std::span<const std::uint32_t> chosen)
        : points_(points), next_(points.size(), kNone), face_from_(points.size(), kNone)
    {
        start({chosen[0], chosen[1], chosen[2], chosen[3]});
        for (const std::uint32_t point : chosen.subspan(4)) leave_with(point, 0);
        for (std::uint32_t face = 0; face < faces_.size(); ++face)
            if (faces_[face].alive && faces_[face].outside != kNone)
                add(farthest_above(face), face);
    }

    TriangleHull result() const
    {
        std::vector<std::uint32_t> place(faces_.size(), kNone);
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < faces_.size(); ++i)
            if (faces_[i].alive) place[i] = count++;
        TriangleHull hull;
        for (const Face& face : faces_) {
            if (!face.alive) continue;
            hull.triangles.push_back(face.corners);
            hull.adjacent.push_back(
                {place[face.adjacent[0]], place[face.adjacent[1]], place[face.adjacent[2]]});
        }
        return hull;
    }

private:
    // A measure of the distance from the face's plane, the same for all points; its sign is exact.
    double height(const Face& face, std::uint32_t point) const
    {
        const GridPoint &p = points_[point], &origin = points_[face.corners[0]];
        double sum = 0, size = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double term = face.rounded[k] * static_cast<double>(p[k] - origin[k]);
            sum += term;
            size += std::abs(term);
        }
        // Five roundings of 2^-53 are 6e-16.
        if (std::abs(sum) > 1e-15 * size) return sum;
        Int128 exact = 0;
        for (std::size_t k = 0; k < 3; ++k) exact += face.normal[k] * (p[k] - origin[k]);
        return static_cast<double>(exact);
    }

    std::uint32_t make_face(std::uint32_t a, std::uint32_t b, std::uint32_t c)
    {
        Face face;
        face.corners = {a, b, c};
        std::array<Int128, 3> u, v;
        for (std::size_t k = 0; k < 3; ++k) {
            u[k] = points_[b][k] - points_[a][k];
            v[k] = points_[c][k] - points_[a][k];
        }
        face.normal = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                       u[0] * v[1] - u[1] * v[0]};
        for (std::size_t k = 0; k < 3; ++k) face.rounded[k] = static_cast<double>(face.normal[k]);
        faces_.push_back(face);
        return static_cast<std::uint32_t>(faces_.size() - 1);
    }

    void start(std::array<std::uint32_t, 4> p)
    {
        make_face(p[0], p[1], p[2]);
        const double side = height(faces_[0], p[3]);
        THRONG_CHECK(side != 0, "the first four points must not lie in one plane");
        faces_.clear();
        if (side > 0) std::swap(p[1], p[2]);
        make_face(p[0], p[1], p[2]);
        make_face(p[0], p[3], p[1]);
        make_face(p[1], p[3], p[2]);
        make_face(p[2], p[3], p[0]);
        faces_[0].adjacent = {1, 2, 3};
        faces_[1].adjacent = {3, 2, 0};
        faces_[2].adjacent = {1, 3, 0};
        faces_[3].adjacent = {2, 1, 0};
    }

    // Leaves the point with the first face, from the given one on, that it is above. A point above
    // none of them is inside for good.
    void leave_with(std::uint32_t point, std::size_t first_face)
    {
        for (std::size_t i = first_face; i < faces_.size(); ++i) {
            if (!(height(faces_[i], point) > 0)) continue;
            next_[point] = faces_[i].outside;
            faces_[i].outside = point;
            return;
        }
    }

    std::uint32_t farthest_above(std::uint32_t face) const
    {
        std::uint32_t best = kNone;
        double best_height = 0;
        for (std::uint32_t p = faces_[face].outside; p != kNone; p = next_[p]) {
            const double own = height(faces_[face], p);
            if (own > best_height || (own == best_height && p < best)) {
                best_height = own;
                best = p;
            }
        }
        return best;
    }

    // Replaces the faces that the point sees by a fan from the point to the rim of what it sees.
    void add(std::uint32_t point, std::uint32_t seen_from)
    {
        find_visible(point, seen_from);
        const std::size_t first_new = faces_.size();
        for (const HorizonEdge& edge : horizon_) {
            const std::uint32_t face = make_face(edge.from, edge.to, point);
            faces_[face].adjacent[0] = edge.outer;
            faces_[edge.outer].adjacent[edge.outer_edge] = face;
            face_from_[edge.from] = face;
        }
        for (std::size_t i = first_new; i < faces_.size(); ++i) {
            const std::uint32_t next = face_from_[faces_[i].corners[1]];
            faces_[i].adjacent[1] = next;
            faces_[next].adjacent[2] = static_cast<std::uint32_t>(i);
        }
        // A point that waited at a face now gone is above one of the new ones, or inside.
        for (const std::uint32_t gone : visible_) {
            faces_[gone].alive = false;
            for (std::uint32_t p = faces_[gone].outside; p != kNone;) {
                const std::uint32_t following = next_[p];
                if (p != point) leave_with(p, first_new);
                p = following;
            }
            faces_[gone].outside = kNone;
        }
    }

    void find_visible(std::uint32_t point, std::uint32_t seen_from)
    {
        ++visit_;
        visible_.assign(1, seen_from);
        horizon_.clear();
        faces_[seen_from].visit = visit_;
        faces_[seen_from].visible = true;
        for (std::size_t i = 0; i < visible_.size(); ++i) {
            const std::array corners = faces_[visible_[i]].corners;
            const std::array adjacent = faces_[visible_[i]].adjacent;
            for (std::uint32_t k = 0; k < 3; ++k) {
                Face& other = faces_[adjacent[k]];
                if (other.visit != visit_) {
                    other.visit = visit_;
                    other.visible = height(other, point) > 0;
                    if (other.visible) visible_.push_back(adjacent[k]);
                }
                const std::uint32_t to = corners[(k + 1) % 3];
                if (!other.visible)
                    horizon_.push_back({corners[k], to, adjacent[k], edge_from(other, to)});
            }
        }
    }

    std::span<const GridPoint> points_;
    std::vector<Face> faces_;
    std::vector<std::uint32_t> next_;       // [points] links the points that wait at one face
    std::vector<std::uint32_t> face_from_;  // [points] the new face whose rim edge starts there
    std::vector<std::uint32_t> visible_;
    std::vector<HorizonEdge> horizon_;
    std::uint32_t visit_ = 0;
};

}  // namespace

std::vector<GridPoint> to_grid(std::span<const Vec3> points)
{
    std::vector<GridPoint> grid(points.size());
    for (int axis = 0; axis < 3; ++axis) {
        double lower = points[0][axis], upper = lower;
        for (const Vec3& point : points) {
            lower = std::min(lower, point[axis]);
            upper = std::max(upper, point[axis]);
        }
        // A power of two, so that points given in few bits stay exactly where they are.
        int exponent = 0;
        std::frexp(upper - lower, &exponent);
        for (std::size_t i = 0; i < points.size(); ++i)
            grid[i][static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(
                std::nearbyint(std::ldexp(points[i][axis] - lower, kGridBits - exponent)));
    }
    return grid;
}

TriangleHull exact_hull(std::span<const GridPoint> points, std::span<const std::uint32_t> chosen)
{
    THRONG_CHECK(chosen.size() >= 4, "a hull needs four points");
    return Builder(points, chosen).result();
}

}  // namespace throng
