// Support contacts: the points that two convex shapes share, once the direction of least separation
// is known: the faces they show to one another, one clipped by the other.
#pragma once

#include "kernels/data/manifolds.hpp"
#include "kernels/geometry/closest_points.hpp"
#include "narrowphase/convex/contact_axis.hpp"

namespace throng {

/// Fills the points of a manifold whose axis is known; rounding included.
///
/// A face meets a face in up to four points, a face or a line meets a line in two, and whatever
/// meets a corner, or crosses, in one.
void fill_points(const ConvexCorePair& pair,
                 const ContactAxis& axis,
                 double speculative_margin,
                 LocalManifold<double>& out);

/// Where the stretch that two lines share begins or ends.
struct SharedEnd {
    Vec3 on_a = Vec3::Zero();
    double separation = 0;      // m, of the lines along the normal
    std::uint32_t feature = 0;  // which end it is, and whose
};

/// Two lines side by side: both ends of the stretch they share. False where they share none, or
/// cross at such an angle that they meet in one place alone.
///
///   round   m, radius of what the lines stand for, both added: how far lines may pass beside one
///           another and still count as side by side; 0 for sharp edges
bool share_line(const Segment<double>& a,
                const Segment<double>& b,
                const Vec3& normal,
                double round,
                std::array<SharedEnd, 2>& ends);

}  // namespace throng
