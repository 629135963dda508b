// Sphere pairs: a sphere against each other convex shape, in closed form, always one point.
//
// Each asks of b the one thing a sphere cares about: how far the sphere's center is from b's
// surface, and which way. A center inside b leaves by the nearest way out.
#include "narrowphase/convex/sphere_pairs.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/support.hpp"
#include "narrowphase/convex/capsule_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

template <class Real>
void fill_manifold(const Outward<Real>& outward,
                   Real radius,
                   const PoseT<Real>& b_in_a,
                   Real speculative_margin,
                   LocalManifold<Real>& out)
{
    out.count = 0;
    const Real separation = outward.distance - radius;
    if (!(separation <= speculative_margin)) return;
    out.normal = b_in_a.orientation * -outward.direction;
    out.add(out.normal * (radius + separation / 2), separation, 0);
}

template <class Real>
Outward<Real> away_from(const Vec3T<Real>& offset, const Vec3T<Real>& otherwise)
{
    const Vec3T<Real> direction = unit_or(offset, otherwise);
    return {direction, direction.dot(offset)};
}

template <class Real>
Outward<Real> outward_of(const Cylinder& cylinder, const Vec3T<Real>& center)
{
    const Real radius = static_cast<Real>(cylinder.radius);
    const Real half = static_cast<Real>(cylinder.half_length);
    const Vec3T<Real> across =
        unit_or(Vec3T<Real>(center.x(), center.y(), 0), Vec3T<Real>(Vec3T<Real>::UnitX()));
    const Real beside = across.dot(center) - radius;
    const Real above = std::abs(center.z()) - half;
    const Vec3T<Real> up(0, 0, center.z() >= 0 ? Real(1) : Real(-1));
    if (beside > 0 && above > 0) return away_from(Vec3T<Real>(across * beside + up * above), up);
    if (above >= beside) return {up, above};
    return {across, beside};
}

template <class Real>
Outward<Real> outward_of(const Box& box, const Vec3T<Real>& center)
{
    const Vec3T<Real> half = box.half_extents.cast<Real>();
    const Vec3T<Real> nearest = center.cwiseMax(-half).cwiseMin(half);
    const Vec3T<Real> offset = center - nearest;
    int face = 0;
    for (int i = 1; i < 3; ++i) {
        if (std::abs(center[i]) - half[i] > std::abs(center[face]) - half[face]) face = i;
    }
    Vec3T<Real> out_of_face = Vec3T<Real>::Zero();
    out_of_face[face] = center[face] >= 0 ? Real(1) : Real(-1);
    const Real above = std::abs(center[face]) - half[face];
    if (above <= 0) return {out_of_face, above};
    return away_from(offset, out_of_face);
}

double above_face(const Hull& hull, std::size_t face, const Vec3& point)
{
    return hull.normals[face].dot(point) - hull.offsets[face];
}

// Where a point is, seen from the face's polygon: straight above it, or from the edges that it is
// beyond. Takes the place of what is further.
void look_from_face(const Hull& hull, std::size_t face, const Vec3& point, Outward<double>& nearest)
{
    const Vec3& normal = hull.normals[face];
    const std::size_t begin = hull.face_begin[face], end = hull.face_begin[face + 1];
    Vec3 from = hull.vertices[hull.face_vertices[end - 1]];
    bool inside = true;
    for (std::size_t i = begin; i < end; ++i) {
        const Vec3& to = hull.vertices[hull.face_vertices[i]];
        const Vec3 along = to - from, offset = point - from;
        if (normal.dot(along.cross(offset)) < 0) {
            inside = false;
            const double square = along.squaredNorm();
            const double part = square > 0 ? along.dot(offset) / square : 0;
            const Vec3 away = offset - along * std::clamp(part, 0.0, 1.0);
            const double distance = length_of(away);
            if (distance < nearest.distance && distance > 0) nearest = {away / distance, distance};
        }
        from = to;
    }
    const double above = above_face(hull, face, point);
    if (inside && above < nearest.distance) nearest = {normal, above};
}

// A face straight below is what the pair remembers: while it stays so, the others are further.
bool look_from_known_face(const Hull& hull,
                          const Vec3& point,
                          double enough,
                          const PairCache& cache,
                          Outward<double>& outward)
{
    if (cache.kind == 0 || cache.feature_b >= hull.normals.size()) return false;
    const double above = above_face(hull, cache.feature_b, point);
    if (!(above > 0)) return false;
    outward = {hull.normals[cache.feature_b], std::numeric_limits<double>::infinity()};
    if (!(above > enough)) look_from_face(hull, cache.feature_b, point, outward);
    // A plane is never further than the hull itself, so more than enough is beyond the margin.
    return above > enough || outward.distance == above;
}

// A point outside is nearest to some face that it is above; one inside leaves by the nearest.
Outward<double> outward_of(const Hull& hull, const Vec3& point, double enough, PairCache& cache)
{
    Outward<double> known;
    if (look_from_known_face(hull, point, enough, cache, known)) return known;
    std::size_t best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hull.normals.size(); ++i) {
        const double above = above_face(hull, i, point);
        if (!(above > most)) continue;
        most = above;
        best = i;
    }
    cache.kind = 1;
    cache.feature_b = static_cast<std::uint32_t>(best);
    if (most <= 0 || most > enough) return {hull.normals[best], most};
    Outward<double> nearest = {hull.normals[best], std::numeric_limits<double>::infinity()};
    look_from_face(hull, best, point, nearest);
    if (nearest.distance == most) return nearest;
    for (std::size_t i = 0; i < hull.normals.size(); ++i) {
        if (i != best && above_face(hull, i, point) > 0) look_from_face(hull, i, point, nearest);
    }
    return nearest;
}

template <class Real>
Real radius_of(const Shapes& shapes, ShapeRef sphere)
{
    return static_cast<Real>(shapes.spheres[sphere.index].radius);
}

template <class Real>
Outward<Real> outward_of(const Capsule& capsule, const Vec3T<Real>& center)
{
    const Real half = static_cast<Real>(capsule.half_length);
    Vec3T<Real> offset = center;
    offset.z() -= std::clamp(offset.z(), -half, half);
    // On the axis every way to the side is as short as any other.
    Outward<Real> outward = away_from(offset, Vec3T<Real>(Vec3T<Real>::UnitX()));
    outward.distance -= static_cast<Real>(capsule.radius);
    return outward;
}

}  // namespace

Outward<double> outward_of_convex(
    const Shapes& shapes, ShapeRef convex, const Vec3& place, double enough, PairCache& cache)
{
    switch (convex.kind) {
    case ShapeKind::sphere: {
        Outward<double> outward = away_from(place, Vec3(Vec3::UnitZ()));
        outward.distance -= shapes.spheres[convex.index].radius;
        return outward;
    }
    case ShapeKind::capsule:
        return outward_of(shapes.capsules[convex.index], place);
    case ShapeKind::cylinder:
        return outward_of(shapes.cylinders[convex.index], place);
    case ShapeKind::box:
        return outward_of(shapes.boxes[convex.index], place);
    case ShapeKind::hull:
        return outward_of(shapes.hulls[convex.index], place, enough, cache);
    default:
        THRONG_CHECK(false, "the way out is that of a convex shape of some volume");
        return {};
    }
}

template <class Real>
void sphere_sphere(const PairInput<Real>& in, PairCache&, LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    out.count = 0;
    const Real radius = radius_of<Real>(shapes, a);
    const Vec3T<Real> normal = unit_or(b_in_a.position, Vec3T<Real>(Vec3T<Real>::UnitZ()));
    const Real separation = normal.dot(b_in_a.position) - radius - radius_of<Real>(shapes, b);
    if (!(separation <= speculative_margin)) return;
    out.normal = normal;
    out.add(normal * (radius + separation / 2), separation, 0);
}

template <class Real>
void sphere_capsule(const PairInput<Real>& in, PairCache&, LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    const Vec3T<Real> center = b_in_a.to_local(Vec3T<Real>::Zero());
    const Outward<Real> outward = outward_of(shapes.capsules[b.index], center);
    fill_manifold(outward, radius_of<Real>(shapes, a), b_in_a, speculative_margin, out);
}

template <class Real>
void sphere_cylinder(const PairInput<Real>& in, PairCache&, LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    const Vec3T<Real> center = b_in_a.to_local(Vec3T<Real>::Zero());
    const Outward<Real> outward = outward_of(shapes.cylinders[b.index], center);
    fill_manifold(outward, radius_of<Real>(shapes, a), b_in_a, speculative_margin, out);
}

template <class Real>
void sphere_box(const PairInput<Real>& in, PairCache&, LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    const Vec3T<Real> center = b_in_a.to_local(Vec3T<Real>::Zero());
    const Outward<Real> outward = outward_of(shapes.boxes[b.index], center);
    fill_manifold(outward, radius_of<Real>(shapes, a), b_in_a, speculative_margin, out);
}

template <class Real>
void sphere_hull(const PairInput<Real>& in, PairCache& cache, LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    const Real radius = radius_of<Real>(shapes, a);
    const Vec3T<Real> center = b_in_a.to_local(Vec3T<Real>::Zero());
    // Hulls are stored in double.
    const Outward<double> outward =
        outward_of(shapes.hulls[b.index], center.template cast<double>(),
                   static_cast<double>(radius + speculative_margin), cache);
    fill_manifold<Real>({outward.direction.cast<Real>(), static_cast<Real>(outward.distance)},
                        radius, b_in_a, speculative_margin, out);
}

THRONG_PAIR_INSTANCES(sphere_sphere)
THRONG_PAIR_INSTANCES(sphere_capsule)
THRONG_PAIR_INSTANCES(sphere_cylinder)
THRONG_PAIR_INSTANCES(sphere_box)
THRONG_PAIR_INSTANCES(sphere_hull)

}  // namespace throng
