// Polytope side: of two polytopes, one seen as planes and the other as vertices and edges.
//
// Two of these, each body taking either part, find all that two polytopes do to one another's
// surface. Distances are heights over the planes, in m.
#pragma once

#include "kernels/geometry/polytope_contacts.hpp"

#include <limits>
#include <vector>

namespace throng {

/// The body with the planes is the pair's a. Counts the looks taken at it.
struct PolytopeSide {
    const PolytopePair& pair;
    double noise;  // heights up to it count as beneath
    int& rounds;
    FaceAxis best{};  // of the faces looked at, that with most of the other outside

    /// A vertex of b in a's frame.
    Vec3 place(std::size_t vertex) const
    {
        return pair.turn * pair.b.vertices[vertex] + pair.shift;
    }
    double over(std::size_t face, const Vec3& point) const
    {
        return pair.a.normals[face].dot(point) - pair.a.offsets[face];
    }
    /// The same as a look.
    double height(std::size_t face, const Vec3& point) const
    {
        ++rounds;
        return over(face, point);
    }
};

/// What is left of an edge, from 0 at one end to 1 at the other, and the faces that cut it.
struct EdgePart {
    double from = 0, to = 1;
    std::size_t enters = 0, leaves = 0;
};

/// Cuts an edge by the half-space of a face; false where nothing is left.
///
/// Source: Cyrus, Beck, Generalized Two- and Three-Dimensional Clipping (1978).
bool cut(
    const PolytopeSide& side, std::size_t face, const Vec3& from, const Vec3& to, EdgePart& part);

/// Whether what all faces have left of an edge is inside: well beneath all planes somewhere, or
/// near the surface. Planes that meet at a sharp angle, put out by the noise, meet far beyond the
/// edge between their faces; what lies there is not inside.
bool is_inside(const PolytopeSide& side, const Vec3& from, const Vec3& to, const EdgePart& part);

/// Whether something of an edge is inside, and what.
///
///   part   in: faces likely to leave nothing, as those that ended the last edge; out: what is
///          left, or the faces that ended this one
bool meets(const PolytopeSide& side, const Vec3& from, const Vec3& to, EdgePart& part);

/// The face that a point is furthest beyond, or least far beneath.
struct NearestFace {
    std::uint16_t face = 0;
    double height = -std::numeric_limits<double>::max();
};
NearestFace nearest_face(const PolytopeSide& side, const Vec3& point);

/// Whether a point is inside, or near the surface.
///
///   nearest   its nearest_face()
bool has_inside(const PolytopeSide& side, const Vec3& point, const NearestFace& nearest);

/// The vertex least high over a face; by climbing from `start`.
FaceAxis lowest_vertex(const PolytopeSide& side, std::uint16_t face, std::uint16_t start);

enum class WalkEnd : std::uint8_t {
    open,
    parted,  // all vertices are outside the face of side.best
    inside,  // the vertex of side.best is inside
};

/// From the face to the vertex lowest beneath it, from there to the face furthest beneath that, and
/// on until that leads nowhere new. Fills side.best.
WalkEnd walk(PolytopeSide& side, std::uint16_t face, std::uint16_t start);

/// What any_below() keeps from use to use; allocates as it grows.
struct BelowScratch {
    enum class Below : std::uint8_t { unknown, yes, no };
    std::vector<Below> below;  // [vertices] all unknown between uses
    std::vector<std::uint16_t> looked, open;

    static BelowScratch& of_thread();
};

/// Shows the vertices that lie beneath the plane of side.best, and the edges with an end there: all
/// others are outside. They hang together, and the lowest is among them; up to the slack of the
/// guide above the plane is beneath it too, so that they do so for faces whose corners stray. Ends
/// once shown enough.
///
///   on_vertex   (vertex), true for enough
///   on_edge     (from, to), true for enough; neither may call any_below()
template <class OnVertex, class OnEdge>
bool any_below(const PolytopeSide& side, OnVertex&& on_vertex, OnEdge&& on_edge)
{
    using Below = BelowScratch::Below;
    BelowScratch& scratch = BelowScratch::of_thread();
    const PolytopeView& shape = side.pair.b;
    const double level = 2 * side.noise + (shape.guide ? shape.guide->slack : 0);
    std::vector<Below>& below = scratch.below;
    std::vector<std::uint16_t>&looked = scratch.looked, &open = scratch.open;
    if (below.size() < shape.vertices.size()) below.resize(shape.vertices.size(), Below::unknown);
    const auto is_below = [&](std::uint16_t vertex) {
        if (below[vertex] == Below::unknown) {
            const bool yes = side.height(side.best.face, side.place(vertex)) <= level;
            below[vertex] = yes ? Below::yes : Below::no;
            looked.push_back(vertex);
            if (yes) open.push_back(vertex);
        }
        return below[vertex] == Below::yes;
    };
    bool enough = false;
    is_below(side.best.vertex);
    while (!enough && !open.empty()) {
        const std::uint16_t vertex = open.back();
        open.pop_back();
        enough = on_vertex(vertex);
        const std::uint32_t end = shape.neighbor_begin[vertex + 1u];
        for (std::uint32_t i = shape.neighbor_begin[vertex]; !enough && i < end; ++i) {
            const std::uint16_t next = shape.neighbors[i];
            // An edge with both ends beneath is seen from both: once is enough.
            if (is_below(next) && next < vertex) continue;
            enough = on_edge(vertex, next);
        }
    }
    for (const std::uint16_t vertex : looked) below[vertex] = Below::unknown;
    looked.clear();
    open.clear();
    return enough;
}

}  // namespace throng
