// Box against box: the best of fifteen separating axes, then one box's face clipped against the
// other's, or the place where two edges cross or lie along one another.
//
// All of it in a's frame (or, where b's face leads, in b's): numbers stay as small as the boxes are
// far apart, which is what lets float do.
#include "kernels/geometry/clip.hpp"
#include "narrowphase/convex/pair_functions.hpp"
#include "narrowphase/manifold/contact_points.hpp"
#include "narrowphase/manifold/edge_on_edge.hpp"
#include "narrowphase/manifold/edge_over_face.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// b's center and axes in a's frame, and both boxes' half extents.
template <class Real>
struct BoxPair {
    Vec3T<Real> half_a, half_b, center;
    Mat3T<Real> turn;  // columns: b's axes
    Mat3T<Real> abs_turn;

    BoxPair mirrored() const
    {
        return {half_b, half_a, -(turn.transpose() * center), turn.transpose(),
                abs_turn.transpose()};
    }
};

// Axes are numbered: 0-2 a's faces, 3-5 b's faces, 6 + 3i + j a's edge i across b's edge j.
constexpr std::uint32_t kEdgeAxes = 6, kAxes = 15;

// A face leads unless another axis is better by this part of the boxes' least half extents, so that
// the normal of a body at rest does not jump between axes that are as good as one another.
template <class Real>
constexpr Real kFaceBias = Real(1e-3);

// Square of the sine below which two edges count as parallel. Their common normal could point
// anywhere by then, and the faces beside the edges part the boxes as well to within this sine.
template <class Real>
constexpr Real kParallel = Real(1e-8);

// Cosine below which an edge's normal is no stand-in for a face's: a fiftieth of a radian. Boxes
// that lie on one another a little askew, one over the other's side, touch at an edge but rest on
// the face.
template <class Real>
constexpr Real kAlike = Real(0.9998);

template <class Real>
struct Axis {
    Real separation;
    std::uint32_t index;
};

template <class Real>
Real face_separation(const BoxPair<Real>& pair, std::uint32_t index)
{
    if (index < 3) {
        return std::abs(pair.center[index])
            - (pair.half_a[index] + pair.abs_turn.row(index).dot(pair.half_b));
    }
    const std::uint32_t j = index - 3;
    return std::abs(pair.turn.col(j).dot(pair.center))
        - (pair.half_b[j] + pair.abs_turn.col(j).dot(pair.half_a));
}

// The cross product of a's edge i and b's edge j, not of unit length.
template <class Real>
Vec3T<Real> edge_axis(const BoxPair<Real>& pair, std::uint32_t index)
{
    const std::uint32_t i = (index - kEdgeAxes) / 3, j = (index - kEdgeAxes) % 3;
    const std::uint32_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    Vec3T<Real> axis;
    axis[i] = 0;
    axis[i1] = -pair.turn(i2, j);
    axis[i2] = pair.turn(i1, j);
    return axis;
}

// The separation times the axis' length. Every term uses the very axis that was rounded, so that
// near-parallel edges, whose axis is short and coarse, still get the true answer for that axis.
template <class Real>
Real scaled_edge_separation(const BoxPair<Real>& pair, std::uint32_t index)
{
    const std::uint32_t i = (index - kEdgeAxes) / 3, j = (index - kEdgeAxes) % 3;
    const std::uint32_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    const Real x = -pair.turn(i2, j), y = pair.turn(i1, j);
    const Real along = std::abs(x * pair.center[i1] + y * pair.center[i2]);
    const Real extent_a = pair.half_a[i1] * std::abs(x) + pair.half_a[i2] * std::abs(y);
    const Real extent_b = pair.half_b[j1] * std::abs(x * pair.turn(i1, j1) + y * pair.turn(i2, j1))
        + pair.half_b[j2] * std::abs(x * pair.turn(i1, j2) + y * pair.turn(i2, j2));
    return along - (extent_a + extent_b);
}

template <class Real>
Real edge_axis_length(const BoxPair<Real>& pair, std::uint32_t index)
{
    const std::uint32_t i = (index - kEdgeAxes) / 3, j = (index - kEdgeAxes) % 3;
    const Real x = pair.turn((i + 2) % 3, j), y = pair.turn((i + 1) % 3, j);
    const Real squared = x * x + y * y;
    return squared > kParallel<Real> ? std::sqrt(squared) : Real(0);
}

// Whether this one axis shows that the boxes are beyond the margin; the same numbers as the full
// search.
template <class Real>
bool parts(const BoxPair<Real>& pair, std::uint32_t index, Real speculative_margin)
{
    if (index < kEdgeAxes) return face_separation(pair, index) > speculative_margin;
    const Real length = edge_axis_length(pair, index);
    return length > 0 && scaled_edge_separation(pair, index) / length > speculative_margin;
}

template <class Real>
Axis<Real> best_of_faces(const BoxPair<Real>& pair, std::uint32_t first)
{
    Axis<Real> best{face_separation(pair, first), first};
    for (std::uint32_t index = first + 1; index < first + 3; ++index) {
        const Real separation = face_separation(pair, index);
        if (separation > best.separation) best = {separation, index};
    }
    return best;
}

// The best edge axis that beats `to_beat`; index kAxes where none does.
template <class Real>
Axis<Real> best_of_edges(const BoxPair<Real>& pair, Real to_beat)
{
    Axis<Real> best{to_beat, kAxes};
    for (std::uint32_t index = kEdgeAxes; index < kAxes; ++index) {
        const Real scaled = scaled_edge_separation(pair, index);
        // Dividing by a length of at most 1 brings a negative number no nearer to 0.
        if (scaled <= best.separation && scaled <= 0) continue;
        const Real length = edge_axis_length(pair, index);
        if (length > 0 && scaled > best.separation * length) best = {scaled / length, index};
    }
    return best;
}

// The face of b most against `normal`, in a's frame.
template <class Real>
Polygon<Real>
incident_face(const BoxPair<Real>& pair, std::uint32_t axis, Real sign, std::uint32_t& face)
{
    std::uint32_t k = 0;
    for (std::uint32_t j = 1; j < 3; ++j) {
        if (pair.abs_turn(axis, j) > pair.abs_turn(axis, k)) k = j;
    }
    const Real side = pair.turn(axis, k) * sign > 0 ? Real(-1) : Real(1);
    const std::uint32_t k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    const Vec3T<Real> center = pair.center + side * pair.half_b[k] * pair.turn.col(k);
    const Vec3T<Real> u = pair.half_b[k1] * pair.turn.col(k1);
    const Vec3T<Real> v = pair.half_b[k2] * pair.turn.col(k2);
    Polygon<Real> polygon;
    polygon.add(center + u + v, 0);
    polygon.add(center - u + v, 1);
    polygon.add(center - u - v, 2);
    polygon.add(center + u - v, 3);
    face = 2 * k + (side > 0 ? 1 : 0);
    return polygon;
}

template <class Real>
struct Candidates {
    std::array<typename LocalManifold<Real>::Point, kMaxCorners> points;
    std::size_t count = 0;
    Real least = std::numeric_limits<Real>::max();  // separation of the deepest

    void add(const Vec3T<Real>& position, Real separation, std::uint32_t feature)
    {
        points[count++] = {position, separation, feature};
        least = std::min(least, separation);
    }
};

// Clips b's incident face against a's face; points in a's frame, midway between the faces.
template <class Real>
void clip_faces(const BoxPair<Real>& pair,
                std::uint32_t axis,
                Real sign,
                Real speculative_margin,
                Candidates<Real>& out)
{
    std::uint32_t face = 0;
    Polygon<Real> polygon = incident_face(pair, axis, sign, face);
    // Corners of equal boxes in a stack lie on the sides to within noise: keep them as corners.
    const Real slack = kFaceBias<Real> * pair.half_a.minCoeff();
    const std::array<std::uint32_t, 2> across = {(axis + 1) % 3, (axis + 2) % 3};
    for (std::uint32_t k = 0; k < 2; ++k) {
        Vec3T<Real> side = Vec3T<Real>::Unit(across[k]);
        const Real half = pair.half_a[across[k]];
        cut(polygon, side, half, slack, static_cast<std::uint16_t>(4 + 2 * k));
        side[across[k]] = -1;
        cut(polygon, side, half, slack, static_cast<std::uint16_t>(5 + 2 * k));
    }
    const std::uint32_t faces = face | (2 * axis + (sign > 0 ? 1 : 0)) << 3;
    for (int i = 0; i < polygon.count; ++i) {
        Vec3T<Real> position = polygon.corners[static_cast<std::size_t>(i)];
        const Real separation = sign * position[axis] - pair.half_a[axis];
        if (separation > speculative_margin) continue;
        position[axis] -= sign * separation / 2;
        // Line ids are below 8: the 24 bits of a corner's name come down to 6.
        const std::uint32_t corner = polygon.corner_id(i);
        out.add(position, separation, (corner >> 12 & 7) | (corner & 7) << 3 | faces << 6);
    }
}

template <class Real>
Real sign_of(Real value)
{
    return value < 0 ? Real(-1) : Real(1);
}

// The manifold of a face axis: a's face leads, or b's with the roles turned round.
template <class Real>
Real face_manifold(const BoxPair<Real>& pair,
                   std::uint32_t index,
                   Real speculative_margin,
                   LocalManifold<Real>& out)
{
    Candidates<Real> found;
    if (index < 3) {
        const Real sign = sign_of(pair.center[index]);
        clip_faces(pair, index, sign, speculative_margin, found);
        out.normal = sign * Vec3T<Real>::Unit(index);
    } else {
        const BoxPair<Real> turned = pair.mirrored();
        const std::uint32_t axis = index - 3;
        const Real sign = sign_of(turned.center[axis]);
        clip_faces(turned, axis, sign, speculative_margin, found);
        out.normal = -sign * pair.turn.col(axis);
        for (std::size_t i = 0; i < found.count; ++i) {
            auto& point = found.points[i];
            point.position = pair.turn * point.position + pair.center;
            point.feature |= 1u << 12;
        }
    }
    reduce_to_four<Real>({found.points.data(), found.count}, out);
    return found.least;
}

template <class Real>
Vec3T<Real> edge_normal(const BoxPair<Real>& pair, std::uint32_t index)
{
    const Vec3T<Real> normal = edge_axis(pair, index).normalized();
    return normal.dot(pair.center) < 0 ? Vec3T<Real>(-normal) : normal;
}

template <class Real>
Vec3T<Real> face_normal(const BoxPair<Real>& pair, std::uint32_t index)
{
    if (index < 3) return sign_of(pair.center[index]) * Vec3T<Real>::Unit(index);
    const Vec3T<Real> axis = pair.turn.col(index - 3);
    return sign_of(pair.center.dot(axis)) * axis;
}

// The point midway between the two edges that face one another along the axis.
template <class Real>
void edge_manifold(const BoxPair<Real>& pair,
                   const Axis<Real>& best,
                   Real speculative_margin,
                   LocalManifold<Real>& out)
{
    const std::uint32_t i = (best.index - kEdgeAxes) / 3, j = (best.index - kEdgeAxes) % 3;
    const Vec3T<Real> normal = edge_normal(pair, best.index);

    // The middles of a's furthest edge along the normal, and of b's furthest against it.
    std::uint32_t feature = 1u << 31 | best.index;
    Vec3T<Real> on_a = Vec3T<Real>::Zero(), on_b = pair.center;
    for (std::uint32_t k = 0; k < 3; ++k) {
        if (k != i) {
            on_a[k] = normal[k] < 0 ? -pair.half_a[k] : pair.half_a[k];
            if (on_a[k] < 0) feature |= 1u << (8 + k);
        }
        if (k != j) {
            const Real side = sign_of(-normal.dot(pair.turn.col(k)));
            on_b += side * pair.half_b[k] * pair.turn.col(k);
            if (side < 0) feature |= 1u << (12 + k);
        }
    }
    // Closest points of the two lines, held to the edges.
    const Vec3T<Real> between = on_b - on_a, along_b = pair.turn.col(j);
    const Real cosine = along_b[i], sine2 = edge_axis(pair, best.index).squaredNorm();
    const Real da = between[i], db = between.dot(along_b);
    const Real sa = std::clamp((da - cosine * db) / sine2, -pair.half_a[i], pair.half_a[i]);
    const Real sb = std::clamp(cosine * sa - db, -pair.half_b[j], pair.half_b[j]);
    on_a[i] += sa;
    on_b += sb * along_b;

    // Boxes that are apart may have their closest points elsewhere: these two then pass each other
    // by and there is nothing to hold.
    const Real distance2 = (on_b - on_a).squaredNorm();
    const Real limit =
        speculative_margin + kFaceBias<Real> * (pair.half_a.minCoeff() + pair.half_b.minCoeff());
    out.count = 0;
    if (best.separation > 0 && distance2 > limit * limit) return;
    out.normal = normal;
    out.add((on_a + on_b) / 2, best.separation, feature);
}

}  // namespace

template <class Real>
void box_box(const PairInput<Real>& in, PairCache& cache, LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    out.count = 0;
    BoxPair<Real> pair;
    pair.half_a = shapes.boxes[a.index].half_extents.template cast<Real>();
    pair.half_b = shapes.boxes[b.index].half_extents.template cast<Real>();
    pair.center = b_in_a.position;
    pair.turn = b_in_a.orientation.toRotationMatrix();
    pair.abs_turn = pair.turn.cwiseAbs();

    // The axis that parted the boxes last time most often still does.
    if (cache.kind == 1 && cache.feature_a < kAxes
        && parts(pair, cache.feature_a, speculative_margin))
        return;
    cache = {};
    const Axis<Real> face_a = best_of_faces(pair, 0), face_b = best_of_faces(pair, 3);
    const Axis<Real> top = face_b.separation > face_a.separation ? face_b : face_a;
    if (top.separation > speculative_margin) {
        cache = {top.index, 0, 1};
        return;
    }
    const Real bias = kFaceBias<Real> * (pair.half_a.minCoeff() + pair.half_b.minCoeff());
    const Axis<Real> edge = best_of_edges(pair, top.separation);
    if (edge.index < kAxes && edge.separation > speculative_margin) {
        cache = {edge.index, 0, 1};
        return;
    }
    // b's face leads only where it is clearly better, for the same reason.
    const Axis<Real> face = face_b.separation > face_a.separation + bias ? face_b : face_a;
    const bool has_edge = edge.index < kAxes;
    const bool edge_better = has_edge && edge.separation > face.separation + bias;
    const bool alike =
        has_edge && edge_normal(pair, edge.index).dot(face_normal(pair, face.index)) > kAlike<Real>;
    if (edge_better && !alike) {
        edge_manifold(pair, edge, speculative_margin, out);
        lay_edge_over_face<Real>(pair.half_a, pair.half_b, pair.turn, pair.center,
                                 speculative_margin, out);
        return;
    }
    // A face that has lost its deepest corner over the other's side still tells the depth, if what
    // is left of it agrees with the edges. Otherwise clipping has lost the very place of touch.
    const Real least = face_manifold(pair, face.index, speculative_margin, out);
    const bool kept = !edge_better && (face.separation >= 0 || least <= face.separation + 2 * bias);
    const bool agrees = alike && std::abs(least - edge.separation) <= 2 * bias;
    if (has_edge && !kept && !agrees) edge_manifold(pair, edge, speculative_margin, out);
    meet_edge_on_edge<Real>(pair.half_a, pair.half_b, pair.turn, pair.center, speculative_margin,
                            out);
}

THRONG_PAIR_INSTANCES(box_box)

}  // namespace throng
