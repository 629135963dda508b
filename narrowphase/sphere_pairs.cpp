// Sphere pairs: a sphere against each other convex shape, in closed form, always one point.
//
// Each asks of b the one thing a sphere cares about: how far the sphere's center is from b's
// surface, and which way. A center inside b leaves by the nearest way out.
#include "kernels/geometry/support.hpp"
#include "narrowphase/pair_functions.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Where the sphere's center is, seen from b's surface, in b's frame.
template <class Real>
struct Outward {
    Vec3T<Real> direction = Vec3T<Real>::UnitZ();  // unit, from the surface to the center
    Real distance = 0;                             // below 0 inside
};

template <class Real>
void touch(const Outward<Real>& outward,
           Real radius,
           const PoseT<Real>& b_in_a,
           Real reach,
           LocalManifold<Real>& out)
{
    out.count = 0;
    const Real separation = outward.distance - radius;
    if (!(separation <= reach)) return;
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

template <class Real>
Vec3T<Real> corner_of(const Hull& hull, std::size_t vertex)
{
    return hull.vertices[vertex].cast<Real>();
}

// Whether a point of a face's plane lies within the face.
template <class Real>
bool within_face(const Hull& hull, std::size_t face, const Vec3T<Real>& point)
{
    const Vec3T<Real> normal = hull.normals[face].cast<Real>();
    const std::size_t begin = hull.face_begin[face];
    const std::size_t end = hull.face_begin[face + 1];
    Vec3T<Real> from = corner_of<Real>(hull, hull.face_vertices[end - 1]);
    for (std::size_t i = begin; i < end; ++i) {
        const Vec3T<Real> to = corner_of<Real>(hull, hull.face_vertices[i]);
        if (normal.dot((to - from).cross(point - from)) < 0) return false;
        from = to;
    }
    return true;
}

// A center outside is nearest to a point of an edge or to one within a face that it looks down on.
template <class Real>
Outward<Real> outward_of_rim(const Hull& hull, const Vec3T<Real>& center, std::size_t best)
{
    const Vec3T<Real> fallback = hull.normals[best].cast<Real>();
    Outward<Real> nearest = {fallback, std::numeric_limits<Real>::infinity()};
    for (std::size_t i = 0; i < hull.normals.size(); ++i) {
        const Vec3T<Real> normal = hull.normals[i].cast<Real>();
        const Real above = normal.dot(center) - static_cast<Real>(hull.offsets[i]);
        if (!(above >= 0 && above < nearest.distance)) continue;
        if (within_face<Real>(hull, i, center - normal * above)) nearest = {normal, above};
    }
    for (const Hull::Edge& edge : hull.edges) {
        const Vec3T<Real> from = corner_of<Real>(hull, edge.from);
        const Vec3T<Real> along = corner_of<Real>(hull, edge.to) - from;
        const Real square = along.squaredNorm();
        Real part = square > 0 ? along.dot(center - from) / square : Real(0);
        part = std::clamp(part, Real(0), Real(1));
        const Outward<Real> now = away_from(Vec3T<Real>(center - from - along * part), fallback);
        if (now.distance < nearest.distance) nearest = now;
    }
    return nearest;
}

template <class Real>
Outward<Real> outward_of(const Hull& hull, const Vec3T<Real>& center, Real enough)
{
    std::size_t best = 0;
    Real most = -std::numeric_limits<Real>::infinity();
    for (std::size_t i = 0; i < hull.normals.size(); ++i) {
        const Real above =
            hull.normals[i].cast<Real>().dot(center) - static_cast<Real>(hull.offsets[i]);
        if (!(above > most)) continue;
        most = above;
        best = i;
    }
    const Vec3T<Real> normal = hull.normals[best].cast<Real>();
    // A face's plane is never further than the hull itself, so this far is out of reach.
    if (most <= 0 || most > enough) return {normal, most};
    if (within_face<Real>(hull, best, center - normal * most)) return {normal, most};
    return outward_of_rim(hull, center, best);
}

template <class Real>
Real radius_of(const Shapes& shapes, ShapeRef sphere)
{
    return static_cast<Real>(shapes.spheres[sphere.index].radius);
}

}  // namespace

template <class Real>
void sphere_sphere(const Shapes& shapes,
                   ShapeRef a,
                   ShapeRef b,
                   const PoseT<Real>& b_in_a,
                   Real reach,
                   PairCache&,
                   LocalManifold<Real>& out)
{
    out.count = 0;
    const Real radius = radius_of<Real>(shapes, a);
    const Vec3T<Real> normal = unit_or(b_in_a.position, Vec3T<Real>(Vec3T<Real>::UnitZ()));
    const Real separation = normal.dot(b_in_a.position) - radius - radius_of<Real>(shapes, b);
    if (!(separation <= reach)) return;
    out.normal = normal;
    out.add(normal * (radius + separation / 2), separation, 0);
}

template <class Real>
void sphere_capsule(const Shapes& shapes,
                    ShapeRef a,
                    ShapeRef b,
                    const PoseT<Real>& b_in_a,
                    Real reach,
                    PairCache&,
                    LocalManifold<Real>& out)
{
    const Capsule& capsule = shapes.capsules[b.index];
    const Real half = static_cast<Real>(capsule.half_length);
    Vec3T<Real> offset = b_in_a.to_local(Vec3T<Real>::Zero());
    offset.z() -= std::clamp(offset.z(), -half, half);
    // On the axis every way to the side is as short as any other.
    Outward<Real> outward = away_from(offset, Vec3T<Real>(Vec3T<Real>::UnitX()));
    outward.distance -= static_cast<Real>(capsule.radius);
    touch(outward, radius_of<Real>(shapes, a), b_in_a, reach, out);
}

template <class Real>
void sphere_cylinder(const Shapes& shapes,
                     ShapeRef a,
                     ShapeRef b,
                     const PoseT<Real>& b_in_a,
                     Real reach,
                     PairCache&,
                     LocalManifold<Real>& out)
{
    const Vec3T<Real> center = b_in_a.to_local(Vec3T<Real>::Zero());
    const Outward<Real> outward = outward_of(shapes.cylinders[b.index], center);
    touch(outward, radius_of<Real>(shapes, a), b_in_a, reach, out);
}

template <class Real>
void sphere_box(const Shapes& shapes,
                ShapeRef a,
                ShapeRef b,
                const PoseT<Real>& b_in_a,
                Real reach,
                PairCache&,
                LocalManifold<Real>& out)
{
    const Vec3T<Real> center = b_in_a.to_local(Vec3T<Real>::Zero());
    const Outward<Real> outward = outward_of(shapes.boxes[b.index], center);
    touch(outward, radius_of<Real>(shapes, a), b_in_a, reach, out);
}

template <class Real>
void sphere_hull(const Shapes& shapes,
                 ShapeRef a,
                 ShapeRef b,
                 const PoseT<Real>& b_in_a,
                 Real reach,
                 PairCache&,
                 LocalManifold<Real>& out)
{
    const Real radius = radius_of<Real>(shapes, a);
    const Vec3T<Real> center = b_in_a.to_local(Vec3T<Real>::Zero());
    touch(outward_of(shapes.hulls[b.index], center, radius + reach), radius, b_in_a, reach, out);
}

#define THRONG_INSTANTIATE(name, Real)                                                             \
    template void name<Real>(const Shapes&, ShapeRef, ShapeRef, const PoseT<Real>&, Real,          \
                             PairCache&, LocalManifold<Real>&);
#define THRONG_BOTH(name) THRONG_INSTANTIATE(name, float) THRONG_INSTANTIATE(name, double)
THRONG_BOTH(sphere_sphere)
THRONG_BOTH(sphere_capsule)
THRONG_BOTH(sphere_cylinder)
THRONG_BOTH(sphere_box)
THRONG_BOTH(sphere_hull)
#undef THRONG_BOTH
#undef THRONG_INSTANTIATE

}  // namespace throng
