// Capsule pairs: two capsules, in closed form: one point where they cross, two side by side.
#include "kernels/geometry/support.hpp"
#include "narrowphase/pair_functions.hpp"
#include "narrowphase/support_contacts.hpp"

#include <cmath>

namespace throng {

namespace {

// Axes that meet part sideways, across both of them.
Vec3 normal_between(const ClosestPoints<double>& nearest, const Vec3& along_b, double size)
{
    const Vec3 between = nearest.on_b - nearest.on_a;
    if (between.squaredNorm() > 1e-24 * size * size) return unit_or<double>(between, Vec3::UnitX());
    const Vec3 across = Vec3::UnitZ().cross(along_b);
    if (across.squaredNorm() > 1e-24) return unit_or<double>(across, Vec3::UnitX());
    return Vec3::UnitX();
}

}  // namespace

template <class Real>
void capsule_capsule(const Shapes& shapes,
                     ShapeRef a,
                     ShapeRef b,
                     const PoseT<Real>& b_in_a,
                     Real reach,
                     PairCache&,
                     LocalManifold<Real>& out)
{
    out.count = 0;
    const Capsule& one = shapes.capsules[a.index];
    const Capsule& two = shapes.capsules[b.index];
    const Vec3 center = b_in_a.position.template cast<double>();
    const Vec3 along = b_in_a.orientation.template cast<double>() * Vec3(0, 0, 1);
    const Segment<double> axis_a = {Vec3(0, 0, -one.half_length), Vec3(0, 0, one.half_length)};
    const Segment<double> axis_b = {center - along * two.half_length,
                                    center + along * two.half_length};

    const ClosestPoints<double> nearest = closest_points(axis_a, axis_b);
    const double rounding = one.radius + two.radius;
    const Vec3 normal =
        normal_between(nearest, along, rounding + one.half_length + two.half_length);
    const double separation = normal.dot(nearest.on_b - nearest.on_a) - rounding;
    if (!(separation <= static_cast<double>(reach))) return;

    out.normal = normal.cast<Real>();
    const auto add = [&](const Vec3& on_axis, double between, std::uint32_t feature) {
        if (!(between <= static_cast<double>(reach))) return;
        const Vec3 middle = on_axis + normal * (one.radius + between / 2);
        out.add(middle.cast<Real>(), static_cast<Real>(between), feature);
    };
    std::array<SharedEnd, 2> ends;
    if (share_line(axis_a, axis_b, normal, rounding, ends)) {
        for (const SharedEnd& end : ends) add(end.on_a, end.separation - rounding, end.feature);
    }
    if (out.count == 0) add(nearest.on_a, separation, 0);
}

template void capsule_capsule<float>(const Shapes&,
                                     ShapeRef,
                                     ShapeRef,
                                     const PoseT<float>&,
                                     float,
                                     PairCache&,
                                     LocalManifold<float>&);
template void capsule_capsule<double>(const Shapes&,
                                      ShapeRef,
                                      ShapeRef,
                                      const PoseT<double>&,
                                      double,
                                      PairCache&,
                                      LocalManifold<double>&);

}  // namespace throng
