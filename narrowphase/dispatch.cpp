#include "narrowphase/dispatch.hpp"

#include "kernels/geometry/separating_axes.hpp"
#include "kernels/geometry/support.hpp"
#include "narrowphase/convex/contact_axis.hpp"

#include <algorithm>
#include <array>

namespace throng {

namespace {

// Pairs that never meet here: planes with planes, and all that goes by triangles (collide_mesh) or
// that is a solid (collide_solid).
template <class Real>
void apart(const PairInput<Real>&, PairCache&, LocalManifold<Real>& out)
{
    out.count = 0;
}

constexpr std::size_t kTabled = 6;

// clang-format off
template <class Real>
constexpr std::array<std::array<PairFunction<Real>, kTabled>, kTabled> kTable = {{
    //               sphere               capsule                cylinder               box
    //               hull                 plane
    /* sphere   */ {{sphere_sphere<Real>, sphere_capsule<Real>,  sphere_cylinder<Real>, sphere_box<Real>,    sphere_hull<Real>,   convex_plane<Real>}},
    /* capsule  */ {{nullptr,             capsule_capsule<Real>, convex_convex<Real>,   capsule_box<Real>,   capsule_hull<Real>,  convex_plane<Real>}},
    /* cylinder */ {{nullptr,             nullptr,               convex_convex<Real>,   convex_convex<Real>, convex_convex<Real>, convex_plane<Real>}},
    /* box      */ {{nullptr,             nullptr,               nullptr,               box_box<Real>,       hull_hull<Real>,     convex_plane<Real>}},
    /* hull     */ {{nullptr,             nullptr,               nullptr,               nullptr,             hull_hull<Real>,     convex_plane<Real>}},
    /* plane    */ {{nullptr,             nullptr,               nullptr,               nullptr,             nullptr,             apart<Real>}},
}};
// clang-format on

template <class Real>
PairFunction<Real> function_for(ShapeKind a, ShapeKind b)
{
    const auto row = static_cast<std::size_t>(a);
    const auto column = static_cast<std::size_t>(b);
    return row < kTabled && column < kTabled ? kTable<Real>[row][column] : apart<Real>;
}

double
separation_from_plane(const Shapes& shapes, ShapeRef a, const Plane& plane, const Pose& b_in_a)
{
    const ConvexCore<double> core = convex_core_of<double>(shapes, a);
    const Vec3 normal = b_in_a.orientation * plane.normal;
    const Vec3 lowest = support<double>(core, -normal).position;
    return normal.dot(lowest - b_in_a.position) - core.convex_radius - plane.offset;
}

}  // namespace

template <class Real>
void collide(const PairInput<Real>& in, PairCache& cache, LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    if (a.kind <= b.kind) return function_for<Real>(a.kind, b.kind)(in, cache, out);
    function_for<Real>(b.kind, a.kind)({shapes, b, a, b_in_a.inverse(), speculative_margin}, cache,
                                       out);
    out.normal = b_in_a.orientation * -out.normal;
    for (int i = 0; i < out.count; ++i) {
        auto& position = out.points[static_cast<std::size_t>(i)].position;
        position = b_in_a * position;
    }
}

THRONG_PAIR_INSTANCES(collide)

double penetration_depth(const Shapes& shapes, ShapeRef a, ShapeRef b, const Pose& b_in_a)
{
    if (a.kind > b.kind) return penetration_depth(shapes, b, a, b_in_a.inverse());
    const auto is_polytope = [](ShapeRef shape) {
        return shape.kind == ShapeKind::box || shape.kind == ShapeKind::hull;
    };
    double separation = 0;
    if (static_cast<std::size_t>(b.kind) >= kTabled || a.kind == ShapeKind::plane) {
        return 0;
    } else if (b.kind == ShapeKind::plane) {
        separation = separation_from_plane(shapes, a, shapes.planes[b.index], b_in_a);
    } else if (a.kind == ShapeKind::sphere) {
        // Closed forms of one point, so the point's separation is the answer.
        PairCache cache;
        LocalManifold<double> manifold;
        collide<double>({shapes, a, b, b_in_a, 0}, cache, manifold);
        if (manifold.count > 0) separation = manifold.points[0].separation;
    } else if (is_polytope(a) && is_polytope(b)) {
        const PolytopeShape polytope_a(shapes, a);
        const PolytopeShape polytope_b(shapes, b);
        separation = polytope_separation(polytope_a.view(), polytope_b.view(), b_in_a, nullptr);
    } else {
        const ConvexCorePair pair(shapes, a, b, b_in_a);
        const double convex_radius = pair.a.convex_radius + pair.b.convex_radius;
        ContactAxis axis;
        if (search_axis(pair, convex_radius, axis)) separation = axis.separation - convex_radius;
    }
    return std::max(0.0, -separation);
}

Pose pose_seen_from_a(const Shapes& shapes, ShapeRef b, const Pose& pose_a, const Pose& pose_b)
{
    const Quat back = pose_a.orientation.conjugate();
    Vec3 offset = pose_b.position - pose_a.position;
    if (b.kind == ShapeKind::plane) {
        const Vec3 normal = pose_b.orientation * shapes.planes[b.index].normal;
        offset = normal * normal.dot(offset);
    }
    return {back * offset, back * pose_b.orientation};
}

}  // namespace throng
