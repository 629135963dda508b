#include "kernels/geometry/mass.hpp"

#include "kernels/geometry/mesh.hpp"

#include <cmath>
#include <numbers>

namespace throng {
namespace {

constexpr double kPi = std::numbers::pi;

MassProperties mass_of(const Sphere& sphere)
{
    const double squared = sphere.radius * sphere.radius;
    const double volume = 4 * kPi / 3 * squared * sphere.radius;
    const double moment = 0.4 * volume * squared;
    return {volume, Vec3::Zero(), {moment, moment, moment, 0, 0, 0}};
}

MassProperties mass_of(const Cylinder& cylinder)
{
    const double squared = cylinder.radius * cylinder.radius;
    const double length = 2 * cylinder.half_length;
    const double volume = kPi * squared * length;
    const double across = volume * (3 * squared + length * length) / 12;
    return {volume, Vec3::Zero(), {across, across, 0.5 * volume * squared, 0, 0, 0}};
}

// A cylinder and two half balls, whose own centers lie 3/8 of the radius beyond its ends.
MassProperties mass_of(const Capsule& capsule)
{
    const MassProperties rod = mass_of(Cylinder{capsule.radius, capsule.half_length});
    const MassProperties ball = mass_of(Sphere{capsule.radius});
    const double half = capsule.half_length;
    const double moved = ball.volume * half * (half + 0.75 * capsule.radius);
    const double across = rod.inertia.xx + ball.inertia.xx + moved;
    const double along = rod.inertia.zz + ball.inertia.zz;
    return {rod.volume + ball.volume, Vec3::Zero(), {across, across, along, 0, 0, 0}};
}

MassProperties mass_of(const Box& box)
{
    const Vec3& half = box.half_extents;
    const double volume = 8 * half.x() * half.y() * half.z();
    const Vec3 squared = half.cwiseProduct(half) * (volume / 3);
    return {
        volume,
        Vec3::Zero(),
        {squared.y() + squared.z(), squared.x() + squared.z(), squared.x() + squared.y(), 0, 0, 0}};
}

// The integrals of 1, x and x x^T over the inside of a closed surface, about a given point.
struct Moments {
    double volume = 0;
    Vec3 first = Vec3::Zero();
    Sym3 second;

    // The tetrahedron of a triangle and the origin. Below zero where the triangle faces inward.
    // Source: Tonon, Explicit exact formulas for the 3-D tetrahedron inertia tensor (2004).
    void add(const Vec3& a, const Vec3& b, const Vec3& c)
    {
        const double det = a.dot(b.cross(c));
        const Vec3 sum = a + b + c;
        const auto entry = [&](int i, int j) {
            return det / 120 * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + sum[i] * sum[j]);
        };
        volume += det / 6;
        first += det / 24 * sum;
        second.xx += entry(0, 0);
        second.yy += entry(1, 1);
        second.zz += entry(2, 2);
        second.xy += entry(0, 1);
        second.xz += entry(0, 2);
        second.yz += entry(1, 2);
    }
};

// Calls visit(a, b, c) for triangles that cover the surface.
template <class Visitor>
void visit_surface(const Hull& hull, Visitor visit)
{
    for (std::size_t face = 0; face + 1 < hull.face_begin.size(); ++face) {
        const std::size_t begin = hull.face_begin[face];
        for (std::size_t i = begin + 2; i < hull.face_begin[face + 1]; ++i)
            visit(hull.vertices[hull.face_vertices[begin]],
                  hull.vertices[hull.face_vertices[i - 1]], hull.vertices[hull.face_vertices[i]]);
    }
}

template <class Visitor>
void visit_surface(const Mesh& mesh, Visitor visit)
{
    for (const auto& [a, b, c] : mesh.triangles)
        visit(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
}

template <class Solid>
Moments moments_about(const Solid& solid, const Vec3& origin)
{
    Moments moments;
    visit_surface(solid, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        moments.add(a - origin, b - origin, c - origin);
    });
    return moments;
}

MassProperties about_center(const Moments& moments, const Vec3& start)
{
    const Vec3 off = moments.first / moments.volume;
    const double v = moments.volume;
    const double xx = moments.second.xx - v * off.x() * off.x();
    const double yy = moments.second.yy - v * off.y() * off.y();
    const double zz = moments.second.zz - v * off.z() * off.z();
    return {v,
            start + off,
            {yy + zz, xx + zz, xx + yy, v * off.x() * off.y() - moments.second.xy,
             v * off.x() * off.z() - moments.second.xz, v * off.y() * off.z() - moments.second.yz}};
}

// Twice round the surface: about a vertex to find the center, then about the center, so that
// nothing is lost to a frame far away or to a long thin shape.
template <class Solid>
MassProperties mass_inside(const Solid& solid)
{
    if (solid.vertices.empty()) return {};
    const Vec3& start = solid.vertices.front();
    const Moments rough = moments_about(solid, start);
    if (rough.volume == 0) return {};
    const Vec3 guess = start + rough.first / rough.volume;
    return about_center(moments_about(solid, guess), guess);
}

}  // namespace

MassProperties mass_of(const Hull& hull) { return mass_inside(hull); }

MassProperties mass_of(const Mesh& mesh)
{
    return is_closed(mesh) ? mass_inside(mesh) : MassProperties{};
}

MassProperties mass_as_if_closed(const Mesh& mesh)
{
    if (mesh.tree.empty()) return {};
    const Box3 box = box_of(mesh);
    const Vec3 middle = 0.5 * (box.lower + box.upper);
    const Moments moments = moments_about(mesh, middle);
    return moments.volume == 0 ? MassProperties{} : about_center(moments, middle);
}

MassProperties mass_of(const Shapes& shapes, ShapeRef shape)
{
    switch (shape.kind) {
    case ShapeKind::sphere:
        return mass_of(shapes.spheres[shape.index]);
    case ShapeKind::capsule:
        return mass_of(shapes.capsules[shape.index]);
    case ShapeKind::cylinder:
        return mass_of(shapes.cylinders[shape.index]);
    case ShapeKind::box:
        return mass_of(shapes.boxes[shape.index]);
    case ShapeKind::hull:
        return mass_of(shapes.hulls[shape.index]);
    case ShapeKind::mesh:
        return mass_of(shapes.meshes[shape.index]);
    case ShapeKind::solid:
        return mass_of(shapes.solids[shape.index].mesh);
    case ShapeKind::plane:
    case ShapeKind::triangle:
        break;
    }
    return {};
}

MassProperties combine(std::span<const PlacedMass> parts)
{
    if (parts.empty()) return {};

    // Relative to the first part, so that a compound far from its frame keeps its digits.
    const Vec3 start = parts.front().pose * parts.front().mass.center;
    double volume = 0;
    Vec3 first = Vec3::Zero();
    for (const PlacedMass& part : parts) {
        volume += part.mass.volume;
        first += part.mass.volume * (part.pose * part.mass.center - start);
    }
    if (volume == 0) return {};
    const Vec3 center = start + first / volume;

    Mat3 inertia = Mat3::Zero();
    for (const PlacedMass& part : parts) {
        const Mat3 turn = part.pose.orientation.toRotationMatrix();
        const Vec3 arm = part.pose * part.mass.center - center;
        inertia += turn * part.mass.inertia.matrix() * turn.transpose();
        inertia +=
            part.mass.volume * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
    }
    return {volume, center, Sym3::from(inertia)};
}

}  // namespace throng
