// Threads: a bolt and the nut that runs on it.
#pragma once

#include "scene/catalog/closed_meshes.hpp"

namespace throng {

/// A right-handed thread about z. Its flanks stand at 60 degrees to one another; an eighth of the
/// pitch is flat at the crest and a quarter at the root, 0.541 of the pitch deeper.
///
/// A turn by an angle about z and a way of pitch * angle / 2 pi along z together leave bolt and nut
/// in touch as they were. They are free of one another when their frames are the same.
///
/// Source: ISO 68-1:1998, basic profile.
struct Thread {
    double radius = 0;     // m, of the bolt's crests
    double pitch = 0;      // m
    double clearance = 0;  // m, between the flanks of bolt and nut; twice that at crest and root

    double root_radius() const;  // m, of the bolt
    double section() const;      // m2, of the bolt across z: the same everywhere, but turned
    /// How much further out than the bolt's surface the nut's is, m.
    double nut_offset() const;
};

/// A shaft from z = -shaft, where it is tapered, to z = 0, and a six-sided head above.
///
///   around  columns of vertices, a multiple of 6; vertices lie on the round shape, so that what is
///           between them is within
TriangleSoup bolt_mesh(const Thread& thread, double shaft, std::uint32_t around);

/// Six-sided, from z = 0 to z = height, widened at both ends of its hole. The middles of its
/// triangles lie on the round shape, so that a bolt fits.
TriangleSoup nut_mesh(const Thread& thread, double height, std::uint32_t around);

/// From the axis to the middle of a side of the head and of the nut, and how high the head is, m.
double wrench_radius(const Thread& thread);
double head_height(const Thread& thread);

}  // namespace throng
