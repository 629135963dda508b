// Hull cell: the part of a mesh about a place that planes along inward edges leave convex.
#pragma once

#include "cooking/decomposition/part_search.hpp"

namespace throng {

/// A place that a hull has to cover.
///
///   point    m, on the surface of the mesh or within it
///   center   m, of the largest ball in the mesh that touches the surface there, or the point
///   radius   m, of that ball, or how far the surface is
///   covered  by some hull
struct HullPlace {
    Vec3 point = Vec3::Zero(), center = Vec3::Zero();
    double radius = 0;
    bool covered = false;
};

/// Half spaces that close about a place, one after the other.
class HullCell {
public:
    /// Both are kept by reference.
    HullCell(const PartSearch& search, const std::vector<HullPlace>& places);

    /// Adds planes along inward edges, that nearest to the place first, until none is within.
    /// Edges closer to a plane than half of the search's error count as outside. False where an
    /// edge has no plane that leaves the place within.
    bool close(const HullPlace& place);

    /// The corners of what of the mesh is within, and connected with the place.
    std::vector<Vec3> corners(const HullPlace& place) const;

private:
    // What of an inward edge is within: from and to as parts of it.
    struct Span {
        double from = 0, to = 1;
    };
    struct Nearest {
        std::size_t edge = 0;
        Vec3 point = Vec3::Zero();
        bool found = false;
    };

    Nearest nearest_edge(const Vec3& center) const;
    bool choose(const HullPlace& place, const Nearest& nearest, Plane& plane) const;
    double worth(const Plane& plane) const;
    void add(const Plane& plane);
    bool is_seen(const Vec3& from, const Vec3& point) const;

    const PartSearch& search_;
    const std::vector<HullPlace>& places_;
    std::vector<Plane> planes_;
    std::vector<Span> spans_;
    std::vector<std::size_t> within_;
};

}  // namespace throng
