// Polytope contacts: what two polytopes show to one another along a separating axis, and the points
// that come of it.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "kernels/geometry/polytope.hpp"

namespace throng {

/// Two polytopes, b placed in a's frame.
struct PolytopePair {
    PolytopePair(const PolytopeView& shape_a, const PolytopeView& shape_b, const Pose& b_in_a);

    PolytopeView a, b;
    Mat3 turn;    // b's axes into a's
    Vec3 shift;   // b's origin in a's frame
    Vec3 offset;  // from a's center to b's, in a's frame

    PolytopePair mirrored() const;
    /// Rounding errors of separations stay well below this.
    double noise() const;

private:
    PolytopePair() = default;
};

/// The face of a that leaves b furthest outside.
struct FaceAxis {
    double separation = 0;     // of b's vertex from the face's plane
    std::uint16_t face = 0;    // of a
    std::uint16_t vertex = 0;  // of b, the furthest against the face's normal
};

/// The edges of a and b whose common normal leaves b furthest outside a.
struct EdgeAxis {
    double separation = 0;
    Vec3 normal = Vec3::Zero();  // unit, from a to b, in a's frame; zero where there is none
    std::uint16_t edge_a = 0, edge_b = 0;
};

FaceAxis face_axis(const PolytopePair& pair, std::uint16_t face, std::uint16_t start = 0);

/// The face of a that the ball inside b lies furthest beyond: a good first guess.
FaceAxis likely_face_axis(const PolytopePair& pair);

/// The best face axis of a, if any reaches `floor`; else any. Ties go to the lower index, and faces
/// that the ball inside b shows to be worse are not looked at.
FaceAxis best_face_axis(const PolytopePair& pair, const FaceAxis& guess, double floor);

/// The best edge axis whose separation is above `to_beat`; normal zero where there is none. Looks
/// only at edges that meet on the Gauss map: no other is a face of the Minkowski difference. The
/// separation is of every vertex and not of the two edges alone: corners of a hull's face may lie a
/// little off its plane, and then stick out beyond an edge.
EdgeAxis best_edge_axis(const PolytopePair& pair, double to_beat);

/// The best face axis among the faces of a at one of its corners, sought from a vertex of b. Ties
/// go to the lower index.
FaceAxis best_face_axis_at(const PolytopePair& pair, std::uint16_t corner, std::uint16_t vertex);

/// As best_edge_axis(), among the edges at a corner of a and those at a corner of b.
EdgeAxis best_edge_axis_at(const PolytopePair& pair,
                           std::uint16_t corner_a,
                           std::uint16_t corner_b,
                           double to_beat);

/// Candidate points, in a's frame until they are turned round.
struct PolytopePoints {
    std::array<LocalManifold<double>::Point, 64> points;
    std::size_t count = 0;
    double least = 0;  // separation of the deepest; 0 while there is none
};

/// Clips the face of b that looks most against a's face (of those at the axis' vertex) by the sides
/// of a's face; points no further than the speculative margin, midway between the two.
void clip_faces(const PolytopePair& pair,
                const FaceAxis& axis,
                double speculative_margin,
                double slack,
                PolytopePoints& out);

/// The same with a face of b that is known.
void clip_faces(const PolytopePair& pair,
                const FaceAxis& axis,
                std::uint16_t against,
                double speculative_margin,
                double slack,
                PolytopePoints& out);

/// The point midway between two edges. None where edges that are apart pass one another by further
/// than `limit`.
void cross_edges(const PolytopePair& pair,
                 const EdgeAxis& axis,
                 double limit,
                 LocalManifold<double>& out);

/// Puts a manifold that was found for the mirrored pair into a's frame.
void turn_round(const PolytopePair& pair, LocalManifold<double>& out);

}  // namespace throng
