// Cut polyhedron: a convex polyhedron as vertices, edges and loops of edges, cut by planes.
//
// What a cut leaves is closed whatever rounding says of its vertices: each edge that loses one end
// gets one new vertex, which the faces on both sides share, and within each face a new edge joins
// the vertices where its loop leaves the plane and comes back. Seen from their other side, those
// edges are the loops of the new face. No position is asked for that, only who is kept.
//
// Source: Sutherland, Hodgman, Reentrant Polygon Clipping (1974), and for polyhedra as graphs
//         Powell, Abel, An exact general remeshing scheme applied to physically conservative
//         voxelization (2015), section 3.
#pragma once

#include "kernels/geometry/flat_faces.hpp"

#include <vector>

namespace throng {

/// What a polyhedron encloses.
///
///   volume   m3, at least 0
///   surface  m2, area of all faces; of what is flat, of both its sides
///   center   of the volume; of the surface where there is no volume to speak of
///   own      m2, the areas of those faces that the polyhedron began with, each along its outward
///            normal, added up; minus that is the sum of the faces that cuts made. A face in a
///            plane that it was cut by, and facing the same way, counts half for either
struct Enclosed {
    double volume = 0, surface = 0;
    Vec3 center = Vec3::Zero();
    Vec3 own = Vec3::Zero();
};

/// Allocates until it has held the largest polyhedron it is given; meant to be kept.
class CutPolyhedron {
public:
    enum class Cut : std::uint8_t { missed, done, gone };

    /// Becomes the shape, in the shape's frame moved to its center. Faces that are not flat become
    /// triangles, as for collect_planes().
    ///
    ///   slack   m, vertices up to slack beyond a plane stay as they are, so that what merely
    ///           touches is kept: a few times the rounding of the coordinates
    ///   planes  by how many it may be cut before it is cut_short()
    void start(const PolytopeView& shape, double slack, std::size_t planes);

    /// Keeps what is on the inner side of the plane, in the frame of start(). `gone` where that is
    /// nothing; the polyhedron is then as it was.
    Cut cut(const CutPlane& plane);

    /// Whether the box round the polyhedron lies on the inner side of the plane, and cut() would
    /// change nothing.
    bool spared_by(const CutPlane& plane) const;

    /// No volume is less than `slack` thick.
    Enclosed enclosed();

    /// Whether visit(from, to) is true of some edge, in the frame of start().
    template <class Visitor>
    bool any_edge(Visitor visit) const
    {
        for (std::uint32_t half = 0; half < half_edges_.size(); half += 2) {
            if (origin(half) == kNone) continue;
            if (visit(vertex(origin(half)), vertex(target(half)))) return true;
        }
        return false;
    }

    /// More edges than those planes can make: rounding has torn it, and a cut was left out.
    bool cut_short() const { return cut_short_; }

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;
    enum class Surface : std::uint8_t { own, cut, both };

    // Two halves make an edge, 2 i and 2 i + 1; each belongs to the face on its left.
    struct HalfEdge {
        std::uint32_t origin = 0, next = 0;
        Surface surface = Surface::own;
    };
    // An edge that loses one end: the half that leaves the end that stays, and the new half that
    // follows it in its face.
    struct CutEdge {
        std::uint32_t half = 0, followed_by = 0;
    };
    // The half in a triangle that runs from its last corner to its first.
    struct LongSide {
        std::size_t first, last;
        std::uint32_t half;
    };

    void link_faces(const PolytopeView& shape);
    void split_face(const PolytopeView& shape, std::size_t face);
    void find_bounds();
    void mark_flush(const Vec3& normal);
    void find_cuts();
    bool join_cuts();
    void free_removed();
    void close_gaps();
    std::uint32_t new_vertex(const Vec3& position);
    std::uint32_t new_edge();
    template <class Visitor>
    void visit_loops(Visitor visit);
    Vec3 area_of(std::uint32_t loop) const;
    Vec3 center_of_vertices() const;
    Vec3 center_of_surface();

    Vec3 vertex(std::uint32_t i) const { return {x_[i], y_[i], z_[i]}; }
    std::uint32_t origin(std::uint32_t half) const { return half_edges_[half].origin; }
    std::uint32_t target(std::uint32_t half) const { return half_edges_[half ^ 1U].origin; }
    bool is_removed(std::uint32_t vertex) const { return beyond_[vertex] > slack_; }
    std::size_t vertex_count() const { return x_.size() - free_vertices_.size(); }
    std::size_t edge_count() const { return half_edges_.size() / 2 - free_edges_.size(); }

    double slack_ = 0;
    std::size_t most_edges_ = 0;
    bool cut_short_ = false;
    // A vertex that is free is not a number, and so on neither side of any plane; an edge that is
    // free has no origins.
    std::vector<double> x_, y_, z_;
    std::vector<std::uint32_t> leaving_;  // [vertices] some half that leaves it
    std::vector<HalfEdge> half_edges_;
    std::vector<std::uint32_t> free_vertices_, free_edges_;
    Vec3 lower_ = Vec3::Zero(), upper_ = Vec3::Zero();

    // Room for work; nothing in it outlives a call.
    std::vector<double> beyond_;                    // [vertices] m, the plane at hand
    std::vector<std::uint32_t> removed_, dropped_;  // vertices beyond it; edges wholly beyond it
    std::vector<CutEdge> cuts_;
    std::vector<std::uint32_t> new_vertex_;  // [edges] where the edge was cut
    std::vector<std::uint32_t> led_to_by_;   // [edges] the new half that ends there
    std::vector<std::uint32_t> place_;       // where things move to, or are
    std::vector<std::uint32_t> halves_;      // [corners of faces] of the shape at the start
    std::vector<FaceTriangle> triangles_;    // of a face at the start
    std::vector<LongSide> long_sides_;       // of those
    std::vector<std::uint8_t> visited_;      // [half edges]
};

}  // namespace throng
