// Capsule on box: in closed form, one point, or two where the capsule lies along a face or an edge.
//
// The box sees the capsule's axis as center + t along. How fast the distance to the box grows along
// it is a broken line in t that never falls, so its root is the nearest point. An axis inside the
// box leaves by the least of six ways: the box and the axis added make a solid of six pairs of
// faces.
#include "kernels/geometry/support.hpp"
#include "narrowphase/convex/capsule_contacts.hpp"
#include "narrowphase/convex/pair_functions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

template <class Real>
struct Seen {
    CapsuleSegment<Real> segment;
    Vec3T<Real> box;  // half extents
    Real noise;       // rounding errors of coordinates stay below this
};

template <class Real>
Seen<Real> seen_from_box(const Capsule& capsule,
                         const Box& box,
                         const Mat3T<Real>& turn,
                         const Vec3T<Real>& position)
{
    Seen<Real> seen;
    seen.segment.center = -(turn.transpose() * position);
    seen.segment.along = turn.row(2).transpose();
    seen.segment.half = static_cast<Real>(capsule.half_length);
    seen.segment.radius = static_cast<Real>(capsule.radius);
    seen.segment.convex_radius = seen.segment.radius;
    seen.box = box.half_extents.cast<Real>();
    const Real greatest = seen.segment.center.cwiseAbs().maxCoeff() + seen.segment.half;
    seen.noise = 4 * std::numeric_limits<Real>::epsilon() * greatest;
    return seen;
}

// How far the whole axis is above each pair of faces, on the side that its middle is on.
template <class Real>
Vec3T<Real> above_faces(const Seen<Real>& seen)
{
    return seen.segment.center.cwiseAbs() - seen.box
        - seen.segment.half * seen.segment.along.cwiseAbs();
}

template <class Real>
int greatest_of(const Vec3T<Real>& v)
{
    int best = v[1] > v[0] ? 1 : 0;
    if (v[2] > v[best]) best = 2;
    return best;
}

// Straight out of a face, from the end of the axis that is lowest over it.
template <class Real>
CapsuleAxis<Real> over_face(const Seen<Real>& seen, int face, Real above)
{
    const Real side = seen.segment.center[face] >= 0 ? Real(1) : Real(-1);
    CapsuleAxis<Real> axis;
    axis.outward.setZero();
    axis.outward[face] = side;
    axis.at = seen.segment.along[face] * side > 0 ? -seen.segment.half : seen.segment.half;
    axis.separation = above;
    return axis;
}

// A face that the lowest end looks straight down on is the nearest there is.
template <class Real>
bool stands_on(const Seen<Real>& seen, int face, Real at)
{
    const Vec3T<Real> end = seen.segment.at(at);
    const int u = face == 0 ? 1 : 0, v = face == 2 ? 1 : 2;
    return std::abs(end[u]) <= seen.box[u] && std::abs(end[v]) <= seen.box[v];
}

// Where the axis is between the planes of a pair of faces, and how fast it leaves them.
template <class Real>
struct Slabs {
    std::array<Real, 3> low, high, speed2;

    // Half of how fast the squared distance grows. Never falls, rounding and all.
    Real slope(Real t) const
    {
        Real sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
            sum += speed2[i] * (t - std::min(high[i], std::max(low[i], t)));
        return sum;
    }
};

template <class Real>
Slabs<Real> slabs_of(const Seen<Real>& seen)
{
    Slabs<Real> slabs;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<int>(i);
        const Real along = seen.segment.along[axis], center = seen.segment.center[axis];
        const Real square = along * along;
        // An axis this square to others leaves no planes within its length.
        const bool leaves = square > Real(1e-30);
        const Real inverse = leaves ? 1 / along : Real(0), middle = -center * inverse;
        const Real span = std::abs(seen.box[axis] * inverse);
        slabs.low[i] = leaves ? middle - span : -seen.segment.half;
        slabs.high[i] = leaves ? middle + span : seen.segment.half;
        slabs.speed2[i] = square;
    }
    return slabs;
}

// Where along the axis the box is nearest. The broken line bends at the planes of the faces and is
// looked at there and at both ends; in between it is straight.
template <class Real>
Real nearest_at(const Seen<Real>& seen)
{
    const Real half = seen.segment.half;
    const Slabs<Real> slabs = slabs_of(seen);
    Real low = -half, high = half;
    const auto look = [&](Real at) {
        at = std::min(half, std::max(-half, at));
        const Real slope = slabs.slope(at);
        low = std::max(low, slope <= 0 ? at : -half);
        high = std::min(high, slope >= 0 ? at : half);
    };
    for (std::size_t i = 0; i < 3; ++i) {
        look(slabs.low[i]);
        look(slabs.high[i]);
    }
    const Real falls = -slabs.slope(low), rises = slabs.slope(high);
    if (falls < 0) return low;
    if (rises < 0) return high;
    if (!(falls + rises > 0)) return (low + high) / 2;
    return low + (high - low) * (falls / (falls + rises));
}

// From the nearest point of the box, at the nearest place. Between the ends it stands square on the
// axis, as seen along the edge below if there is one; rounding would tilt it where the gap is much
// narrower than the axis is long.
template <class Real>
Vec3T<Real> nearest_offset(const Seen<Real>& seen, Real at)
{
    const Vec3T<Real> point = seen.segment.at(at);
    const Vec3T<Real> offset = point - point.cwiseMax(-seen.box).cwiseMin(seen.box);
    if (std::abs(at) == seen.segment.half) return offset;
    Vec3T<Real> along = seen.segment.along;
    for (int i = 0; i < 3; ++i)
        along[i] = std::abs(point[i]) > seen.box[i] - seen.noise ? along[i] : Real(0);
    const Real square = along.squaredNorm();
    const Real tilt = along.dot(offset), most = 4 * seen.noise;
    // More is no rounding: an axis that lies along the face or edge below it.
    if (!(tilt * tilt <= most * most * square) || !(square > 0)) return offset;
    return offset - along * (tilt / square);
}

// The way out across the axis and the box's edges along `edge`.
template <class Real>
void try_across(const Seen<Real>& seen, int edge, CapsuleAxis<Real>& best)
{
    const int u = edge == 0 ? 1 : 0, v = edge == 2 ? 1 : 2;
    const CapsuleSegment<Real>& segment = seen.segment;
    const Real square = segment.along[u] * segment.along[u] + segment.along[v] * segment.along[v];
    if (!(square > std::numeric_limits<Real>::min())) return;
    const Real length = std::sqrt(square);
    Real out_u = -segment.along[v] / length, out_v = segment.along[u] / length;
    if (segment.center[u] * out_u + segment.center[v] * out_v < 0) {
        out_u = -out_u;
        out_v = -out_v;
    }
    const Real above = segment.center[u] * out_u + segment.center[v] * out_v
        - (seen.box[u] * std::abs(out_u) + seen.box[v] * std::abs(out_v));
    // Faces win where rounding decides.
    if (!(above > best.separation + seen.noise)) return;
    best.separation = above;
    best.outward[edge] = 0;
    best.outward[u] = out_u;
    best.outward[v] = out_v;
    const Real to_u = std::copysign(seen.box[u], out_u) - segment.center[u];
    const Real to_v = std::copysign(seen.box[v], out_v) - segment.center[v];
    const Real at = (to_u * segment.along[u] + to_v * segment.along[v]) / square;
    best.at = std::min(segment.half, std::max(-segment.half, at));
}

template <class Real>
CapsuleAxis<Real> contact_axis(const Seen<Real>& seen, int face, Real above)
{
    const CapsuleAxis<Real> straight = over_face(seen, face, above);
    if (above > 0 && stands_on(seen, face, straight.at)) return straight;

    const Real at = nearest_at(seen);
    const Vec3T<Real> offset = nearest_offset(seen, at);
    const Real separation = length_of(offset);
    if (separation > seen.noise) return {offset / separation, at, separation};
    CapsuleAxis<Real> best = straight;
    for (int edge = 0; edge < 3; ++edge) try_across(seen, edge, best);
    return best;
}

// The stretch of the axis over the face that the box turns to it.
template <class Real>
SegmentRange<Real> over_turned_face(const Seen<Real>& seen, const CapsuleAxis<Real>& axis, int face)
{
    const CapsuleSegment<Real>& segment = seen.segment;
    const Real side = axis.outward[face] >= 0 ? Real(1) : Real(-1);
    const Real facing = axis.outward[face] * side;
    const Real height = side * segment.center[face] - seen.box[face],
               climb = side * segment.along[face];
    SegmentRange<Real> range = {-segment.half, segment.half, height / facing, climb / facing};
    for (const int i : {face == 0 ? 1 : 0, face == 2 ? 1 : 2}) {
        // Feet are where the axis meets the face going along the normal.
        const Real lean = axis.outward[i] / facing;
        const Real from = segment.center[i] - lean * height,
                   slope = segment.along[i] - lean * climb;
        range.keep(from, slope, seen.box[i] + seen.noise + beside_edge(segment, slope));
    }
    return range;
}

// The stretch of the axis along the edge that the box turns to it.
template <class Real>
SegmentRange<Real>
along_turned_edge(const Seen<Real>& seen, const CapsuleAxis<Real>& axis, int edge)
{
    const CapsuleSegment<Real>& segment = seen.segment;
    const Vec3T<Real>& out = axis.outward;
    SegmentRange<Real> range = {-segment.half, segment.half,
                                out.dot(segment.center) - out.cwiseAbs().dot(seen.box),
                                out.dot(segment.along)};
    range.keep(segment.center[edge], segment.along[edge], seen.box[edge] + seen.noise);
    const int u = edge == 0 ? 1 : 0, v = edge == 2 ? 1 : 2;
    const Real aside = out[u] * segment.along[v] - out[v] * segment.along[u];
    range.keep(-aside * axis.at, aside, beside_edge(segment, Real(0)));
    return range;
}

}  // namespace

template <class Real>
void capsule_box(const PairInput<Real>& in, PairCache&, LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    out.count = 0;
    const Mat3T<Real> turn = b_in_a.orientation.toRotationMatrix();
    const Seen<Real> seen =
        seen_from_box<Real>(shapes.capsules[a.index], shapes.boxes[b.index], turn, b_in_a.position);
    const Real limit = speculative_margin + seen.segment.radius;
    const Vec3T<Real> above = above_faces(seen);
    const int face = greatest_of(above);
    if (!(above[face] <= limit)) return;
    const CapsuleAxis<Real> axis = contact_axis(seen, face, above[face]);
    if (!(axis.separation <= limit)) return;

    out.normal = -(turn * axis.outward);
    if (lies_across(seen.segment, axis)) {
        const Vec3T<Real> size = axis.outward.cwiseAbs();
        const int turned = greatest_of(size);
        const SegmentRange<Real> range = size[turned] > kFacing<Real>
            ? over_turned_face(seen, axis, turned)
            : along_turned_edge(seen, axis, greatest_of<Real>(-size));
        if (add_capsule_ends(seen.segment, axis, range, seen.noise, speculative_margin, out))
            return;
    }
    add_capsule_point(seen.segment, axis, out);
}

THRONG_PAIR_INSTANCES(capsule_box)

}  // namespace throng
