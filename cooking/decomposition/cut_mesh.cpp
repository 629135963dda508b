#include "cooking/decomposition/cut_mesh.hpp"

#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <map>

namespace throng {
namespace {

double height_of(const Vec3& point, const Plane& plane, double slack)
{
    const double height = plane.normal.dot(point) - plane.offset;
    return std::abs(height) <= slack ? 0.0 : height;
}

// Where an edge passes through the plane: the same bits from either end.
Vec3 crossing(const Vec3& a, double height_a, const Vec3& b, double height_b)
{
    if (height_a == 0) return a;
    if (height_b == 0) return b;
    return height_a < height_b ? Vec3(a + (b - a) * (height_a / (height_a - height_b)))
                               : Vec3(b + (a - b) * (height_b / (height_b - height_a)));
}

// How a triangle lies to a plane. What touches it from one side alone is on that side; what lies in
// it has `flat` set.
//
//   lone   the corner that is alone on `side`, where the plane passes through; the others and the
//          crossings follow in turn
struct Lying {
    bool flat = false, through = false;
    std::size_t side = 0, lone = 0;
};

Lying lying(const std::array<double, 3>& heights)
{
    const auto above = [&](std::size_t k) { return heights[k] > 0; };
    const auto below = [&](std::size_t k) { return heights[k] < 0; };
    Lying answer;
    int up = 0, down = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        up += above(k);
        down += below(k);
    }
    answer.flat = up + down == 0;
    answer.through = up > 0 && down > 0;
    answer.side = up > 0 ? 1 : 0;
    if (!answer.through) return answer;
    // A corner on the plane counts as below, as for all the triangles that share it.
    answer.side = up == 1 ? 1 : 0;
    while (above(answer.lone) != (up == 1)) ++answer.lone;
    return answer;
}

// Corners that the cell's planes, two and two, make with another, inside the mesh.
std::vector<Vec3>
inner_corners(const Mesh& mesh, const std::vector<Plane>& cell, const Plane& plane, double slack)
{
    std::vector<Vec3> corners;
    for (std::size_t i = 0; i < cell.size(); ++i)
        for (std::size_t j = i + 1; j < cell.size(); ++j) {
            const Vec3 line = cell[i].normal.cross(cell[j].normal);
            const double aslant = line.dot(plane.normal);
            // Near-parallel planes meet nowhere that matters.
            if (std::abs(aslant) < 1e-6) continue;
            const Vec3 at =
                (plane.offset * line + cell[i].offset * cell[j].normal.cross(plane.normal)
                 + cell[j].offset * plane.normal.cross(cell[i].normal))
                / aslant;
            const bool within = std::all_of(cell.begin(), cell.end(), [&](const Plane& other) {
                return other.normal.dot(at) - other.offset <= slack;
            });
            if (within && signed_distance(mesh, at) < 0) corners.push_back(at);
        }
    return corners;
}

// Corners of the piece go to the side they are on, those in the plane and new ones to both.
Sides<std::vector<Vec3>>
share_corners(const Mesh& mesh, const MeshPiece& piece, const Plane& plane, double slack)
{
    Sides<std::vector<Vec3>> sides;
    for (const Vec3& corner : piece.corners) {
        const double height = height_of(corner, plane, slack);
        if (height <= 0) sides[0].push_back(corner);
        if (height >= 0) sides[1].push_back(corner);
    }
    for (const Vec3& corner : inner_corners(mesh, piece.cell, plane, slack))
        for (auto& side : sides) side.push_back(corner);
    return sides;
}

std::array<double, 3> pick(const std::vector<double>& heights,
                           const std::array<std::uint32_t, 3>& triangle)
{
    return {heights[triangle[0]], heights[triangle[1]], heights[triangle[2]]};
}

std::vector<double> heights_of(const MeshPiece& piece, const Plane& plane, double slack)
{
    std::vector<double> heights;
    heights.reserve(piece.points.size());
    for (const Vec3& point : piece.points) heights.push_back(height_of(point, plane, slack));
    return heights;
}

// A side under construction, whose points are those of the piece in use and crossings of edges.
class Half {
public:
    explicit Half(const MeshPiece& piece) : from_(piece), place_(piece.points.size(), -1) { }

    std::uint32_t corner(std::uint32_t i)
    {
        if (place_[i] < 0) place_[i] = static_cast<std::int64_t>(add(from_.points[i]));
        return static_cast<std::uint32_t>(place_[i]);
    }
    std::uint32_t between(std::uint32_t a, double height_a, std::uint32_t b, double height_b)
    {
        if (height_a == 0) return corner(a);
        if (height_b == 0) return corner(b);
        const auto [at, fresh] = crossings_.try_emplace({std::min(a, b), std::max(a, b)}, 0);
        if (fresh) at->second = add(crossing(from_.points[a], height_a, from_.points[b], height_b));
        return at->second;
    }
    void keep(std::uint32_t a, std::uint32_t b, std::uint32_t c)
    {
        if (a != b && b != c && c != a) made.surface.push_back({a, b, c});
    }

    MeshPiece made;

private:
    std::uint32_t add(const Vec3& point)
    {
        made.points.push_back(point);
        return static_cast<std::uint32_t>(made.points.size() - 1);
    }

    const MeshPiece& from_;
    std::vector<std::int64_t> place_;
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> crossings_;
};

void cut_surface(const MeshPiece& piece, const std::vector<double>& heights, Sides<Half*> halves)
{
    for (const auto& triangle : piece.surface) {
        const std::array<double, 3> at = pick(heights, triangle);
        const Lying how = lying(at);
        if (how.flat) continue;
        if (!how.through) {
            Half& half = *halves[how.side];
            half.keep(half.corner(triangle[0]), half.corner(triangle[1]), half.corner(triangle[2]));
            continue;
        }
        const std::size_t k = how.lone, l = (k + 1) % 3, m = (k + 2) % 3;
        const auto cross = [&](Half& half, std::size_t other) {
            return half.between(triangle[k], at[k], triangle[other], at[other]);
        };
        Half &one = *halves[how.side], &two = *halves[1 - how.side];
        one.keep(one.corner(triangle[k]), cross(one, l), cross(one, m));
        two.keep(cross(two, l), two.corner(triangle[l]), two.corner(triangle[m]));
        two.keep(cross(two, l), two.corner(triangle[m]), cross(two, m));
    }
}

// Bit s: a corner of this height, of a triangle that lies so, is a corner of what lies on side s.
unsigned sides_of(double height, const Lying& how)
{
    if (height < 0) return 1;
    if (height > 0) return 2;
    return how.through ? 3 : 1u << how.side;
}

}  // namespace

MeshPiece whole_piece(const Mesh& mesh) { return {mesh.vertices, mesh.triangles, {}, {}}; }

Sides<std::vector<Vec3>>
look_at_cut(const Mesh& mesh, const MeshPiece& piece, const Plane& plane, double slack)
{
    Sides<std::vector<Vec3>> sides = share_corners(mesh, piece, plane, slack);
    const std::vector<double> heights = heights_of(piece, plane, slack);
    std::vector<std::uint8_t> touches(heights.size(), 0);  // bit s: corner of a triangle on side s
    for (const auto& triangle : piece.surface) {
        const std::array<double, 3> at = pick(heights, triangle);
        const Lying how = lying(at);
        if (how.flat) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            touches[triangle[k]] =
                static_cast<std::uint8_t>(touches[triangle[k]] | sides_of(at[k], how));
            const std::size_t next = (k + 1) % 3;
            if (at[k] * at[next] >= 0) continue;
            const Vec3 point =
                crossing(piece.points[triangle[k]], at[k], piece.points[triangle[next]], at[next]);
            for (auto& side : sides) side.push_back(point);
        }
    }
    for (std::size_t i = 0; i < heights.size(); ++i)
        for (std::size_t side = 0; side < 2; ++side)
            if ((touches[i] >> side & 1) != 0) sides[side].push_back(piece.points[i]);
    return sides;
}

Sides<MeshPiece>
cut_piece(const Mesh& mesh, const MeshPiece& piece, const Plane& plane, double slack)
{
    Half lower(piece), upper(piece);
    cut_surface(piece, heights_of(piece, plane, slack), {&lower, &upper});
    Sides<MeshPiece> sides{std::move(lower.made), std::move(upper.made)};
    Sides<std::vector<Vec3>> corners = share_corners(mesh, piece, plane, slack);
    for (std::size_t side = 0; side < 2; ++side) {
        sides[side].corners = std::move(corners[side]);
        sides[side].cell = piece.cell;
    }
    sides[0].cell.push_back(plane);
    sides[1].cell.push_back({-plane.normal, -plane.offset});
    return sides;
}

}  // namespace throng
