// Capsule pairs: two capsules, in closed form: one point where they cross, two side by side.
#include "narrowphase/convex/capsule_contacts.hpp"
#include "narrowphase/convex/pair_functions.hpp"

namespace throng {

namespace {

// Axis a is z itself, so that the sine between the axes comes without cancellation.
template <class Real>
struct Axes {
    CapsuleSegment<Real> a;
    Vec3T<Real> center, along;  // of b
    Real half;                  // of b
    Real noise;                 // rounding errors of coordinates stay below this
};

template <class Real>
Real within(Real value, Real half)
{
    return std::min(half, std::max(-half, value));
}

// The axis z of a turned frame.
template <class Real>
Vec3T<Real> turned_z(const QuatT<Real>& turn)
{
    const Real x = turn.x(), y = turn.y(), z = turn.z(), w = turn.w();
    return {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
}

// Axes that meet part sideways, across both of them.
template <class Real>
Vec3T<Real> across_both(const Axes<Real>& axes)
{
    const Vec3T<Real> across(-axes.along.y(), axes.along.x(), 0);
    constexpr Real kParallel = 4 * std::numeric_limits<Real>::epsilon();
    const Real length = length_of(across);
    if (!(length > kParallel)) return Vec3T<Real>::UnitX();
    return across.dot(axes.center) < 0 ? Vec3T<Real>(-across / length)
                                       : Vec3T<Real>(across / length);
}

// Takes rounding out of the way between nearest points that are not at an end: it stands square on
// that axis. In a gap much narrower than the axes are long it would lean.
template <class Real>
void stand_square(const Axes<Real>& axes, Real on_a, Real on_b, Vec3T<Real>& between)
{
    Vec3T<Real> along = axes.along;
    if (std::abs(on_a) < axes.a.half && std::abs(between.z()) <= axes.noise) {
        between.z() = 0;
        along.z() = 0;
    }
    const Real square = along.squaredNorm(), tilt = along.dot(between);
    const bool rounding = tilt * tilt <= axes.noise * axes.noise * square && square > 0;
    if (std::abs(on_b) < axes.half && rounding) between -= along * (tilt / square);
}

// Nearest points. Where the axes are parallel to rounding any place will do to start from.
template <class Real>
CapsuleAxis<Real> axis_between(const Axes<Real>& axes)
{
    const Vec3T<Real>&center = axes.center, &along = axes.along;
    const Real square = along.x() * along.x() + along.y() * along.y();
    Real on_b = 0;
    if (square > std::numeric_limits<Real>::min()) {
        on_b = -(center.x() * along.x() + center.y() * along.y()) / square;
        on_b = within(on_b, axes.half);
    }
    const Real on_a = within(center.z() + on_b * along.z(), axes.a.half);
    on_b = within(on_a * along.z() - along.dot(center), axes.half);
    Vec3T<Real> between = center + on_b * along;
    between.z() -= on_a;
    stand_square(axes, on_a, on_b, between);
    const Real separation = length_of(between);
    if (separation > axes.noise) return {between / -separation, on_a, separation};
    const Vec3T<Real> normal = across_both(axes);
    return {-normal, on_a, normal.dot(between)};
}

// The stretch of a that has b beside it, in line along the normal.
template <class Real>
SegmentRange<Real> beside(const Axes<Real>& axes, const Vec3T<Real>& normal)
{
    const Vec3T<Real> slope = axes.along / axes.along.z();
    const Vec3T<Real> start = axes.center - slope * axes.center.z();
    SegmentRange<Real> range = {-axes.a.half, axes.a.half,
                                normal.x() * start.x() + normal.y() * start.y(),
                                normal.x() * slope.x() + normal.y() * slope.y()};
    const Real half = axes.half * std::abs(axes.along.z());
    range.low = std::max(range.low, axes.center.z() - half);
    range.high = std::min(range.high, axes.center.z() + half);
    if (range.low < range.high) {
        range.keep(normal.x() * start.y() - normal.y() * start.x(),
                   normal.x() * slope.y() - normal.y() * slope.x(), beside_edge(axes.a, Real(0)));
    }
    return range;
}

}  // namespace

template <class Real>
void capsule_capsule(const PairInput<Real>& in, PairCache&, LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    out.count = 0;
    Axes<Real> axes;
    const Capsule& one = shapes.capsules[a.index];
    const Capsule& two = shapes.capsules[b.index];
    axes.a.half = static_cast<Real>(one.half_length);
    axes.a.radius = static_cast<Real>(one.radius);
    axes.a.convex_radius = axes.a.radius + static_cast<Real>(two.radius);
    axes.half = static_cast<Real>(two.half_length);
    axes.center = b_in_a.position;
    const Real limit = speculative_margin + axes.a.convex_radius, length = axes.a.half + axes.half;
    const Real distance = limit + length;
    if (axes.center.squaredNorm() > distance * distance) return;
    axes.along = turned_z(b_in_a.orientation);
    axes.noise = 4 * std::numeric_limits<Real>::epsilon() * (axes.a.convex_radius + length);

    const CapsuleAxis<Real> axis = axis_between(axes);
    if (!(axis.separation <= limit)) return;
    out.normal = -axis.outward;
    const bool side_by_side =
        std::abs(axes.along.z()) > Real(0.9) && std::abs(out.normal.z()) < Real(0.17);
    if (side_by_side
        && add_capsule_ends(axes.a, axis, beside(axes, out.normal), axes.noise, speculative_margin,
                            out)) {
        return;
    }
    add_capsule_point(axes.a, axis, out);
}

THRONG_PAIR_INSTANCES(capsule_capsule)

}  // namespace throng
