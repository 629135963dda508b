#include "scene/catalog/swept_meshes.hpp"

#include "kernels/check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace throng {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3 reflected(const Vec3& v, const Vec3& mirror)
{
    return v - 2 * mirror.dot(v) / mirror.squaredNorm() * mirror;
}

// What stood square to the curve at a, carried on to b without turning about the curve.
Vec3 carried(const Vec3& square, const CurvePoint& a, const CurvePoint& b)
{
    const Vec3 way = b.place - a.place;
    const Vec3 along = reflected(a.along, way);
    return reflected(reflected(square, way), b.along - along);
}

}  // namespace

TriangleSoup tube_mesh(std::span<const CurvePoint> curve, double tube, std::uint32_t across)
{
    THRONG_CHECK(curve.size() >= 3 && across >= 3, "a tube needs three points and three corners");
    const auto around = static_cast<std::uint32_t>(curve.size());
    const Vec3 first = curve[0].along.unitOrthogonal();
    std::vector<Vec3> out = {first};
    for (std::uint32_t i = 0; i < around; ++i)
        out.push_back(carried(out[i], curve[i], curve[(i + 1) % around]));
    // Back at the start, the frame has turned about the curve by some angle.
    const Vec3 left = first.cross(curve[0].along);
    const double missing = -std::atan2(out.back().dot(left), out.back().dot(first));

    TriangleSoup mesh;
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t k = 0; k < across; ++k) {
            const double angle = missing * i / around + 2 * kPi * k / across;
            mesh.vertices.emplace_back(curve[i].place + tube * std::cos(angle) * out[i]
                                       + tube * std::sin(angle) * out[i].cross(curve[i].along));
        }
    close_grid(mesh, around, across);
    return mesh;
}

std::vector<CurvePoint> torus_knot(const TorusKnot& knot, std::uint32_t around)
{
    std::vector<CurvePoint> curve;
    for (std::uint32_t i = 0; i < around; ++i) {
        const double turn = 2 * kPi * i / around;
        const double p = knot.longways * turn, q = knot.crossways * turn;
        const double distance = knot.ring + knot.swing * std::cos(q);
        const Vec3 outward(std::cos(p), std::sin(p), 0), onward(-std::sin(p), std::cos(p), 0);
        const Vec3 crossing = -std::sin(q) * outward + std::cos(q) * Vec3::UnitZ();
        curve.push_back(
            {distance * outward + knot.swing * std::sin(q) * Vec3::UnitZ(),
             (knot.longways * distance * onward + knot.crossways * knot.swing * crossing)
                 .normalized()});
    }
    return curve;
}

std::vector<CurvePoint> link_curve(double half_length, double radius, std::uint32_t bend)
{
    const double piece = kPi * radius / bend;
    const auto side = static_cast<std::uint32_t>(std::max(1.0, std::ceil(2 * half_length / piece)));
    std::vector<CurvePoint> curve;
    for (const double end : {1.0, -1.0}) {
        for (std::uint32_t i = 0; i <= bend; ++i) {
            const double angle = kPi * i / bend - kPi / 2;
            const Vec3 outward(std::cos(angle), std::sin(angle), 0);
            curve.push_back({end * (half_length * Vec3::UnitX() + radius * outward),
                             end * Vec3(-outward.y(), outward.x(), 0)});
        }
        for (std::uint32_t i = 1; i < side; ++i)
            curve.push_back(
                {end * Vec3(half_length * (1 - 2.0 * i / side), radius, 0), -end * Vec3::UnitX()});
    }
    return curve;
}

}  // namespace throng
