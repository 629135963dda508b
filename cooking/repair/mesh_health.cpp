#include "cooking/repair/mesh_health.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "cooking/repair/mesh_holes.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace throng {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
// Pairs of triangles looked at for crossings, for each triangle: a sound mesh has about a dozen.
constexpr std::size_t kPairsEach = 200;
// Triangles seen in working out which piece lies in which, at most: about a second.
constexpr std::size_t kMostSeen = 20'000'000;

std::size_t drop_duplicates(std::vector<Triangle>& triangles)
{
    struct Named {
        Triangle corners;
        std::size_t at;
    };
    std::vector<Named> named;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        named.push_back({triangles[i], i});
        std::sort(named.back().corners.begin(), named.back().corners.end());
    }
    std::sort(named.begin(), named.end(), [](const Named& a, const Named& b) {
        return a.corners != b.corners ? a.corners < b.corners : a.at < b.at;
    });
    std::vector<std::uint8_t> dropped(triangles.size(), 0);
    for (std::size_t i = 1; i < named.size(); ++i)
        if (named[i].corners == named[i - 1].corners) dropped[named[i].at] = 1;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i)
        if (dropped[i] == 0) triangles[kept++] = triangles[i];
    const std::size_t count = triangles.size() - kept;
    triangles.resize(kept);
    return count;
}

// Two triangles over an edge, and whether they run along it the same way, which is wrong.
struct Joint {
    std::uint32_t other;
    bool against;
};

// For each triangle its neighbors over edges that exactly two share.
std::vector<std::vector<Joint>> find_joints(const std::vector<Triangle>& triangles,
                                            MeshHealth& health)
{
    struct HalfEdge {
        std::uint32_t low, high, triangle;
        bool rising;
    };
    std::vector<HalfEdge> edges;
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::size_t e = 0; e < 3; ++e) {
            const std::uint32_t from = triangles[t][e], to = triangles[t][(e + 1) % 3];
            edges.push_back({std::min(from, to), std::max(from, to), t, from < to});
        }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::array{a.low, a.high, a.triangle} < std::array{b.low, b.high, b.triangle};
    });
    std::vector<std::vector<Joint>> joints(triangles.size());
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        const HalfEdge& a = edges[begin];
        while (end < edges.size() && edges[end].low == a.low && edges[end].high == a.high) ++end;
        if (end - begin == 1) ++health.open_edges;
        if (end - begin > 2) ++health.crowded_edges;
        if (end - begin != 2) continue;
        const HalfEdge& b = edges[begin + 1];
        joints[a.triangle].push_back({b.triangle, a.rising == b.rising});
        joints[b.triangle].push_back({a.triangle, a.rising == b.rising});
    }
    return joints;
}

struct Piece {
    std::vector<std::uint32_t> triangles;  // in the order in which the flood came to them
    bool closed = true;
    bool one_sided = false;
    std::size_t turned = 0;
    double volume = 0;
    Box3 box;
};

// Floods from each triangle that is left over its edges; turned[t] comes to say whether t has to be
// turned over to agree with the first of its piece.
std::vector<Piece> find_pieces(const std::vector<std::vector<Joint>>& joints,
                               std::vector<std::uint8_t>& turned)
{
    std::vector<Piece> pieces;
    std::vector<std::uint8_t> seen(joints.size(), 0);
    for (std::uint32_t first = 0; first < joints.size(); ++first) {
        if (seen[first] != 0) continue;
        Piece piece;
        piece.triangles.push_back(first);
        seen[first] = 1;
        for (std::size_t at = 0; at < piece.triangles.size(); ++at) {
            const std::uint32_t from = piece.triangles[at];
            piece.closed &= joints[from].size() == 3;
            for (const Joint& joint : joints[from]) {
                const auto wanted =
                    static_cast<std::uint8_t>(turned[from] ^ (joint.against ? 1 : 0));
                if (seen[joint.other] == 0) {
                    seen[joint.other] = 1;
                    turned[joint.other] = wanted;
                    piece.turned += wanted;
                    piece.triangles.push_back(joint.other);
                } else if (turned[joint.other] != wanted) {
                    piece.one_sided = true;
                }
            }
        }
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

void turn_over(Triangle& triangle) { std::swap(triangle[1], triangle[2]); }

// The windings within a piece: as most of its triangles have it.
void agree(Piece& piece, const std::vector<std::uint8_t>& turned, std::vector<Triangle>& triangles)
{
    if (piece.one_sided) {
        piece.turned = 0;
        return;
    }
    const bool others = 2 * piece.turned > piece.triangles.size();
    for (const std::uint32_t t : piece.triangles)
        if ((turned[t] != 0) != others) turn_over(triangles[t]);
    if (others) piece.turned = piece.triangles.size() - piece.turned;
}

// The pieces, their windings made to agree. Counts of edges are those of these triangles; what was
// turned before stays counted.
std::vector<Piece> find_agreeing_pieces(std::vector<Triangle>& triangles, MeshHealth& health)
{
    health.open_edges = health.crowded_edges = health.one_sided = 0;
    const auto joints = find_joints(triangles, health);
    std::vector<std::uint8_t> turned(triangles.size(), 0);
    std::vector<Piece> pieces = find_pieces(joints, turned);
    for (Piece& piece : pieces) {
        agree(piece, turned, triangles);
        health.turned += piece.turned;
        health.one_sided += piece.one_sided ? 1 : 0;
    }
    return pieces;
}

void measure(Piece& piece,
             const std::vector<Vec3>& vertices,
             const std::vector<Triangle>& triangles)
{
    for (const std::uint32_t t : piece.triangles)
        for (const std::uint32_t v : triangles[t])
            piece.box = joined(piece.box, {vertices[v], vertices[v]});
    // About its own middle, so that nothing is lost far from the origin.
    const Vec3 middle = 0.5 * (piece.box.lower + piece.box.upper);
    for (const std::uint32_t t : piece.triangles) {
        const auto& [a, b, c] = triangles[t];
        piece.volume +=
            (vertices[a] - middle).dot((vertices[b] - middle).cross(vertices[c] - middle)) / 6;
    }
}

// Whether a point is inside of a piece, either way round: the solid angle that it takes is a whole
// turn then, else none.
//
// Source: Van Oosterom and Strackee, The solid angle of a plane triangle (1983).
bool is_within(const Vec3& point,
               const Piece& piece,
               const std::vector<Vec3>& vertices,
               const std::vector<Triangle>& triangles)
{
    double angle = 0;
    for (const std::uint32_t t : piece.triangles) {
        const Vec3 a = vertices[triangles[t][0]] - point, b = vertices[triangles[t][1]] - point,
                   c = vertices[triangles[t][2]] - point;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        angle += 2
            * std::atan2(a.dot(b.cross(c)),
                         la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return std::abs(angle) > 2 * std::numbers::pi;
}

// Turns closed pieces outward, but for those within an odd number of others, which may be hollows.
void turn_outward(std::vector<Piece>& pieces,
                  const std::vector<Vec3>& vertices,
                  std::vector<Triangle>& triangles,
                  MeshHealth& health)
{
    std::size_t seen = 0;
    for (const Piece& piece : pieces) {
        if (!piece.closed || piece.one_sided) continue;
        const Vec3& corner = vertices[triangles[piece.triangles.front()][0]];
        bool nested = false;
        for (const Piece& other : pieces) {
            if (&other == &piece || !other.closed || other.one_sided) continue;
            if (!other.box.contains(piece.box) || seen > kMostSeen) continue;
            seen += other.triangles.size();
            nested ^= is_within(corner, other, vertices, triangles);
        }
        if (piece.volume >= 0) {
            health.buried += nested ? 1 : 0;
        } else if (nested) {
            ++health.hollows;
        } else {
            ++health.inside_out;
            for (const std::uint32_t t : piece.triangles) turn_over(triangles[t]);
        }
    }
}

// Whether a segment passes through a triangle's inside or touches it; not where it lies in its
// plane.
bool pierces(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& t)
{
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const double above = normal.dot(from - t[0]), below = normal.dot(to - t[0]);
    if (!((above > 0 && below < 0) || (above < 0 && below > 0))) return false;
    const Vec3 along = to - from;
    double least = 0, most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double side = along.dot((t[k] - from).cross(t[(k + 1) % 3] - from));
        least = std::min(least, side);
        most = std::max(most, side);
    }
    return !(least < 0 && most > 0);
}

bool cross(const Mesh& mesh, const Triangle& a, const Triangle& b)
{
    for (const std::uint32_t i : a)
        for (const std::uint32_t j : b)
            if (i == j) return false;
    std::array<Vec3, 3> ta, tb;
    for (std::size_t k = 0; k < 3; ++k) {
        ta[k] = mesh.vertices[a[k]];
        tb[k] = mesh.vertices[b[k]];
    }
    for (std::size_t k = 0; k < 3; ++k)
        if (pierces(ta[k], ta[(k + 1) % 3], tb) || pierces(tb[k], tb[(k + 1) % 3], ta)) return true;
    return false;
}

// "3 triangles were ...", "1 triangle was ..."
std::string counted(std::size_t count, const char* one, const char* many)
{
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::vector<std::string> warnings_on(const MeshHealth& health)
{
    std::vector<std::string> said;
    const auto say = [&](std::size_t count, const char* one, const char* many) {
        if (count > 0) said.push_back(counted(count, one, many));
    };
    say(health.duplicates, "triangle is given more than once: dropped",
        "triangles are given more than once: dropped");
    say(health.turned, "triangle is wound against its neighbors: turned over",
        "triangles are wound against their neighbors: turned over");
    say(health.inside_out, "piece is inside out: turned over",
        "pieces are inside out: turned over");
    say(health.hollows, "piece is turned inward within another: kept as a hollow",
        "pieces are turned inward within others: kept as hollows");
    say(health.buried, "piece lies within another: taken as one with it",
        "pieces lie within others: taken as one with them");
    if (health.holes > 0)
        said.push_back("closed " + counted(health.holes, "hole", "holes") + ", the longest round "
                       + std::to_string(health.longest_hole) + " edges");
    say(health.open_edges, "edge is open: what cannot be reached from afar is taken for inside",
        "edges are open: what cannot be reached from afar is taken for inside");
    say(health.crowded_edges,
        "edge has more than two triangles: outside is what is reached from afar",
        "edges have more than two triangles: outside is what is reached from afar");
    say(health.one_sided, "piece has one side only: outside is what is reached from afar",
        "pieces have one side only: outside is what is reached from afar");
    say(health.cuts,
        "pair of triangles crosses: taken as one solid, outside is what is reached "
        "from afar",
        "pairs of triangles cross: taken as one solid, outside is what is reached from afar");
    if (health.cuts_cut_short)
        said.emplace_back(
            "too many triangles lie upon one another to look at all pairs: outside is "
            "what is reached from afar");
    if (health.pieces > 1) said.push_back(std::to_string(health.pieces) + " pieces");
    return said;
}

}  // namespace

std::size_t count_cuts(const Mesh& mesh, std::size_t most_pairs, bool& cut_short)
{
    std::size_t cuts = 0, pairs = 0;
    for (std::uint32_t t = 0; t < mesh.triangles.size() && pairs < most_pairs; ++t) {
        visit_triangles(mesh, triangle_box(mesh, t), [&](std::uint32_t other) {
            if (other <= t || pairs >= most_pairs) return;
            ++pairs;
            cuts += cross(mesh, mesh.triangles[t], mesh.triangles[other]) ? 1 : 0;
        });
    }
    cut_short = pairs >= most_pairs;
    return cuts;
}

RepairedMesh mend_still(const std::vector<Vec3>& vertices, std::vector<Triangle> triangles)
{
    RepairedMesh result;
    MeshResult welded = build_mesh(vertices, std::move(triangles));
    result.trouble = welded.trouble;
    if (!result.trouble.empty()) return result;
    MeshHealth& health = result.health;
    std::vector<Triangle> kept = welded.mesh.triangles;
    health.duplicates = drop_duplicates(kept);
    std::vector<Piece> pieces = find_agreeing_pieces(kept, health);
    for (Piece& piece : pieces) measure(piece, welded.mesh.vertices, kept);
    turn_outward(pieces, welded.mesh.vertices, kept, health);
    MeshHealth told;
    told.duplicates = health.duplicates;
    told.turned = health.turned;
    result.warnings = warnings_on(told);
    if (health.inside_out > 0)
        result.warnings.push_back(
            counted(health.inside_out,
                    "piece is closed and inside out: turned over, so that it is "
                    "solid; for a room leave it open somewhere, or put it "
                    "within a shell",
                    "pieces are closed and inside out: turned over, so that they are solid; for a "
                    "room leave them open somewhere, or put them within a shell"));
    result.mesh = std::move(welded.mesh);
    if (kept != result.mesh.triangles)
        result.mesh = build_mesh(result.mesh.vertices, std::move(kept)).mesh;
    return result;
}

RepairedMesh repair(const std::vector<Vec3>& vertices, std::vector<Triangle> triangles)
{
    RepairedMesh result;
    // Built twice: the first time for its welding, which tells what is shared.
    MeshResult welded = build_mesh(vertices, std::move(triangles));
    result.trouble = welded.trouble;
    if (!result.trouble.empty()) return result;
    MeshHealth& health = result.health;
    std::vector<Triangle> kept = std::move(welded.mesh.triangles);
    health.duplicates = drop_duplicates(kept);

    std::vector<Piece> pieces = find_agreeing_pieces(kept, health);
    const ClosedHoles closed = close_holes(welded.mesh.vertices, kept);
    health.holes = closed.count;
    health.longest_hole = closed.longest;
    if (closed.count > 0) pieces = find_agreeing_pieces(kept, health);
    for (Piece& piece : pieces) measure(piece, welded.mesh.vertices, kept);
    health.pieces = pieces.size();
    turn_outward(pieces, welded.mesh.vertices, kept, health);

    result.mesh = build_mesh(welded.mesh.vertices, std::move(kept)).mesh;
    find_vertex_normals(result.mesh);
    health.cuts =
        count_cuts(result.mesh, kPairsEach * result.mesh.triangles.size(), health.cuts_cut_short);
    result.warnings = warnings_on(health);
    return result;
}

}  // namespace throng
