// Containment: two polytopes touch where a vertex of one lies inside the other, or an edge of one
// goes through a face of the other: what the first textbooks test for.
//
// No more is needed: what two convex polyhedra share is one too, and each of its corners is a
// vertex of one inside the other or a crossing of an edge with a face, also where one lies wholly
// inside the other or only edges cross. What is inside by no more than rounding is measured against
// the faces themselves: their planes alone say little near an edge between two sides of a plate.
#pragma once

#include "narrowphase/alternatives/convex_methods.hpp"

namespace throng {

/// Whether two polytopes touch; within PolytopePair::noise() of just touching they do.
///
/// A face is its plane: where corners of a hull's face stray beneath that (build_hull() allows for
/// 1e-5 of its extent), shapes as near as that may be said to touch by one start and not by
/// another.
///
/// Plain looks at every vertex and edge of each against every face of the other. Otherwise balls
/// round and inside the two answer for what is far apart or deep inside. Next, beginning with the
/// face nearest the other's center, one goes from face to the vertex furthest beneath it, and from
/// vertex to the face furthest beneath that: it ends at a face with the whole of the other outside,
/// at a vertex inside, or at neither. Of those faces the one that most of the other lies outside of
/// says which edges may meet: those with an end beneath it, gathered from the lowest vertex
/// outwards, each cut by all faces for as long as something is left of it.
///
/// The normal is that of a face, or the line between two balls, where either parts the two; else no
/// more than a direction.
///
/// Remembered: the faces last looked at, and the vertex or edge found; these are asked first.
/// `rounds` counts looks: a vertex or an edge against a face or a ball, or a step of a climb.
///
/// Allocates scratch that the thread keeps.
///
/// Source: Moore, Wilhelms, Collision Detection and Response for Computer Animation (1988).
MethodAnswer query_containment(const ConvexPair& pair,
                               double speculative_margin,
                               MethodStart start,
                               MethodMemory& memory);

/// The corners of what two polytopes share, in a's frame, as long as there is room.
struct ContainmentPoints {
    enum class Kind : std::uint8_t { vertex, edge };

    /// A vertex inside the other, or the crossing of an edge with the surface of the other.
    ///
    ///   of_b      the vertex or edge is b's and the face is a's; else the other way round
    ///   from, to  the vertex, twice; or the ends of the edge, the lower index first
    ///   face      that the edge crosses, or that the vertex lies least far beneath
    ///   depth     m, of a vertex beneath that face; 0 at a crossing
    struct Point {
        Vec3 position = Vec3::Zero();
        Kind kind = Kind::vertex;
        bool of_b = false;
        std::uint16_t from = 0, to = 0, face = 0;
        double depth = 0;
    };

    static constexpr std::size_t kCapacity = 128;
    std::array<Point, kCapacity> points;
    std::size_t count = 0;
    std::size_t dropped = 0;  // found when there was no room left
};

/// Finds them; none where the two are apart. Where an edge meets an edge or a vertex a face edge,
/// the same place may be given more than once. Allocates as query_containment() does.
void containment_points(const PolytopePair& pair, ContainmentPoints& out);

}  // namespace throng
