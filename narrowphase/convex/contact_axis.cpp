#include "narrowphase/convex/contact_axis.hpp"

#include "kernels/geometry/epa.hpp"
#include "narrowphase/convex/likely_axes.hpp"

#include <cmath>

namespace throng {

namespace {

// Nearer than this, of the size, GJK's direction is rounding noise; faces' normals are not.
constexpr double kTouching = 1e-9;

void keep_further(const ConvexCorePair& pair, const Vec3& normal, ContactAxis& best)
{
    const double separation = separation_along(pair, normal);
    if (!(separation > best.separation)) return;
    best.separation = separation;
    best.normal = normal;
}

// Tries the exact directions that a core offers near the one found: its face normals, an axis, and
// the square side of a cylinder. Whatever separates further is nearer the truth.
void try_directions_of(const ConvexCorePair& pair,
                       const ConvexCore<double>& core,
                       const Mat3& turn,
                       double sign,
                       ContactAxis& best)
{
    const Vec3 local = turn.transpose() * best.normal * sign;
    const SupportFace<double> face = support_face(core, local);
    if (face.flat && face.normal.dot(local) > 0.9) {
        keep_further(pair, turn * face.normal * sign, best);
    }
    const bool has_side = core.kind == ShapeKind::cylinder || core.kind == ShapeKind::capsule;
    if (has_side && std::abs(local.z()) < 0.1) {
        const Vec3 side = unit_or<double>(Vec3(local.x(), local.y(), 0), Vec3::UnitX());
        keep_further(pair, turn * side * sign, best);
    }
}

}  // namespace

bool search_axis(const ConvexCorePair& pair, double limit, ContactAxis& axis)
{
    const Distance distance = gjk(pair, limit);
    if (distance.beyond) return false;
    if (distance.apart && distance.distance > kTouching * pair.size) {
        axis = {distance.normal, distance.distance, distance.on_a, distance.on_b};
    } else {
        const PenetrationDepth depth = epa(pair);
        axis = {depth.normal, -depth.depth, depth.on_a, depth.on_b};
    }
    try_directions_of(pair, pair.a, Mat3::Identity(), 1, axis);
    try_directions_of(pair, pair.b, pair.b_turn, -1, axis);
    return true;
}

bool contact_axis(const ConvexCorePair& pair, double limit, ContactAxis& axis)
{
    switch (likely_axis(pair, limit, axis)) {
    case Likely::found:
        return true;
    case Likely::beyond:
        return false;
    case Likely::unknown:
        break;
    }
    return search_axis(pair, limit, axis);
}

}  // namespace throng
