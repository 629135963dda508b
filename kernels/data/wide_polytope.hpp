// Wide polytope: a convex polyhedron in float about its center, as wide arithmetic wants it.
//
// Plain numbers only: this goes to sources that are compiled once for each instruction set.
#pragma once

#include <cstdint>

namespace throng {

/// Vertices and faces are laid out in whole groups of as many.
inline constexpr int kWideGroup = 16;

/// What may be wide: more goes by the plain arithmetic of double.
inline constexpr int kWideVertices = 128, kWideFaces = 256, kWideEdges = 256, kWideCorners = 32;

/// An edge: its unit direction, its ends, and the faces to its left and right seen from outside.
struct WideEdge {
    float along[3];
    std::uint16_t from, to, left, right;
};

/// A polytope whose numbers somebody else owns.
///
/// Rows of vertices and faces are as long as whole groups: behind the last vertex come copies of
/// vertex 0, behind the last face some that nothing is beyond.
struct WidePolytope {
    const float* numbers = nullptr;  // rows x, y, z, then nx, ny, nz, offset, lean
    const WideEdge* edges = nullptr;
    const std::uint16_t* indices = nullptr;
    int vertices = 0, faces = 0, edge_count = 0;
    float inner = 0, outer = 0;  // radii of balls about the center, inside and round

    static constexpr int whole(int count)
    {
        return (count + kWideGroup - 1) / kWideGroup * kWideGroup;
    }
    static constexpr int count_of_numbers(int vertices, int faces)
    {
        return 3 * whole(vertices) + 5 * whole(faces);
    }

    // Of a vertex, from the center.
    const float* x() const { return numbers; }
    const float* y() const { return numbers + whole(vertices); }
    const float* z() const { return numbers + 2 * whole(vertices); }
    // Of a face: unit normal outward, normal . x of its plane, and the least cosine of half the
    // angle to a neighbor's normal.
    const float* of_faces() const { return numbers + 3 * whole(vertices); }
    const float* nx() const { return of_faces(); }
    const float* ny() const { return of_faces() + whole(faces); }
    const float* nz() const { return of_faces() + 2 * whole(faces); }
    const float* offset() const { return of_faces() + 3 * whole(faces); }
    const float* lean() const { return of_faces() + 4 * whole(faces); }
    // Where a face's corners begin, and one more; then the corners of all faces, counter-clockwise
    // seen from outside, and the sides from each to the next.
    const std::uint16_t* face_begin() const { return indices; }
    const std::uint16_t* corners() const { return indices + faces + 1; }
    const std::uint16_t* sides() const { return corners() + 2 * edge_count; }
    // Where the faces round a vertex begin, and one more; then the faces round all vertices.
    const std::uint16_t* vertex_begin() const { return sides() + 2 * edge_count; }
    const std::uint16_t* around() const { return vertex_begin() + vertices + 1; }
};

}  // namespace throng
