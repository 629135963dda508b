#include "narrowphase/ccd/moving_cores.hpp"

#include "kernels/geometry/mesh.hpp"

#include <cmath>
#include <limits>

namespace throng {

namespace {

constexpr double kNoLimit = 1e30;
constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();

// The points that a core is spun of, of a hull or a triangle.
std::span<const Vec3> points_of(const ConvexCore<double>& core)
{
    if (core.hull != nullptr) return core.hull->vertices;
    return {core.corners, core.corner_count};
}

// Greatest distance of a point of the core from its frame's origin.
double extent_of(const ConvexCore<double>& core)
{
    if (core.kind == ShapeKind::sphere) return 0;
    if (core.hull == nullptr && core.corners == nullptr) return core.extents.norm();
    double most = 0;
    for (const Vec3& point : points_of(core)) most = std::max(most, point.squaredNorm());
    return std::sqrt(most);
}

// A ball with all of a core in it, in its body's frame. A hull may be far from its frame's origin.
struct BodyBall {
    Vec3 center;
    double radius;
};

BodyBall ball_of(const ConvexCore<double>& core, const Pose& local)
{
    if (core.hull == nullptr) return {local.position, extent_of(core)};
    return {local * core.hull->center, core.hull->outer_radius};
}

// The same from a line through a point, along a unit direction.
double extent_from_line(const ConvexCore<double>& core, const Vec3& on_line, const Vec3& along)
{
    if (core.kind == ShapeKind::sphere) return along.cross(on_line).norm();
    double most = 0;
    if (core.hull == nullptr && core.corners == nullptr) {
        for (int k = 0; k < 4; ++k) {
            const Vec3 corner(core.extents.x(), k & 1 ? -core.extents.y() : core.extents.y(),
                              k & 2 ? -core.extents.z() : core.extents.z());
            most = std::max(
                {most, along.cross(corner - on_line).norm(), along.cross(corner + on_line).norm()});
        }
        return most;
    }
    for (const Vec3& point : points_of(core))
        most = std::max(most, along.cross(point - on_line).norm());
    return most;
}

double rounding_of(const MovingCore& a, const MovingCore& b, double round)
{
    const double outer_radius = a.outer_radius() + b.outer_radius() + round;
    return kRounding
        * (outer_radius + a.trajectory().begin.position.norm()
           + b.trajectory().begin.position.norm() + a.trajectory().shift.norm()
           + b.trajectory().shift.norm());
}

// Whether a segment comes into a box.
bool meets(const Vec3& from, const Vec3& way, const Vec3& lower, const Vec3& upper)
{
    double first = 0, last = 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (way[axis] == 0) {
            if (from[axis] < lower[axis] || from[axis] > upper[axis]) return false;
            continue;
        }
        const double enters = (lower[axis] - from[axis]) / way[axis];
        const double leaves = (upper[axis] - from[axis]) / way[axis];
        first = std::max(first, std::min(enters, leaves));
        last = std::min(last, std::max(enters, leaves));
    }
    return first <= last;
}

}  // namespace

ConvexCore<double> moving_core(const Shapes& shapes, const MovingShape& moving)
{
    if (moving.ball > 0) {
        ConvexCore<double> ball;
        ball.convex_radius = ball.size = moving.ball;
        return ball;
    }
    if (const Mesh* const mesh = mesh_of(shapes, moving.shape))
        return convex_core_of_points(std::span<const Vec3>(mesh->vertices));
    ConvexCore<double> core = convex_core_of<double>(shapes, moving.shape);
    core.extents *= moving.scale;
    core.convex_radius *= moving.scale;
    core.size *= moving.scale;
    return core;
}

MovingCore::MovingCore(const ConvexCore<double>& core, const MovingShape& moving, const Vec3& from)
    : core_(core), trajectory_(moving.trajectory), local_(moving.local),
      outer_radius_(moving.local.position.norm() + extent_of(core))
{
    const BodyBall ball = ball_of(core, moving.local);
    outer_radius_ = std::min(outer_radius_, ball.center.norm() + ball.radius);
    trajectory_.begin.position -= from;
    if (trajectory_.spin.isZero(0)) return;
    const Quat back = local_.orientation.conjugate();
    spin_radius_ = extent_from_line(core_, back * -local_.position,
                                    back * Vec3(trajectory_.spin.normalized()));
}

SeparationRate MovingCore::extent(const Vec3& direction, double time) const
{
    const Vec3 furthest = furthest_along(direction, time);
    return {direction.dot(furthest), direction.dot(speed_of(furthest, time))};
}

Vec3 MovingCore::furthest_along(const Vec3& direction, double time) const
{
    const Pose placed = placed_at(time);
    return placed * support<double>(core_, placed.orientation.conjugate() * direction).position;
}

Vec3 MovingCore::speed_of(const Vec3& point, double time) const
{
    const Vec3 arm = point - (trajectory_.begin.position + time * trajectory_.shift);
    return trajectory_.shift + trajectory_.angular_velocity(time).cross(arm);
}

SeparationLimits MovingCore::turning_limits(const Vec3& direction) const
{
    // A point at r moves by w x r: along n at most |n x w| r, and that changes by |w| |n x w| r.
    const double speed = direction.cross(trajectory_.turn).norm() * outer_radius_;
    if (trajectory_.spin.isZero(0)) return {trajectory_.turn.norm() * speed, speed};
    // And of the spin, by as much as the point is off its axis, which turns.
    const double turning = trajectory_.turn.norm();
    const double spinning = trajectory_.spin.norm() * spin_radius_;
    return {turning * (speed + 2 * spinning) + trajectory_.spin.norm() * spinning,
            speed + spinning};
}

MovingCores::MovingCores(const ConvexCore<double>& core_a,
                         const MovingShape& a,
                         const ConvexCore<double>& core_b,
                         const MovingShape& b)
    : from_(a.trajectory.begin.position), a_(core_a, a, from_), b_(core_b, b, from_),
      round_(core_a.convex_radius + core_b.convex_radius), rounding_(rounding_of(a_, b_, round_))
{ }

Apart MovingCores::distance_at(double time) const
{
    const Pose a = a_.placed_at(time), b = b_.placed_at(time);
    const Pose b_in_a{a.orientation.conjugate() * (b.position - a.position),
                      a.orientation.conjugate() * b.orientation};
    const Distance found = gjk(ConvexCorePair(a_.core(), b_.core(), b_in_a), kNoLimit);
    Apart apart;
    if (!found.apart) return apart;
    apart.normal = a.orientation * found.normal;
    apart.normal /= apart.normal.norm();
    apart.separation = separation_rate(apart.normal, time);
    return apart;
}

SeparationRate MovingCores::separation_rate(const Vec3& normal, double time) const
{
    const SeparationRate a = a_.extent(normal, time), b = b_.extent(-normal, time);
    return {-b.value - a.value - round_ - rounding_, -b.slope - a.slope};
}

SeparationLimits MovingCores::limits_along(const Vec3& normal) const
{
    const SeparationLimits a = a_.turning_limits(normal), b = b_.turning_limits(normal);
    const double nearing = normal.dot(a_.trajectory().shift - b_.trajectory().shift);
    return {a.bend + b.bend, nearing + a.speed + b.speed};
}

OverPlane::OverPlane(const Shapes& shapes, const MovingShape& plane, const MovingShape& other)
    : plane_(shapes.planes[plane.shape.index]), from_(other.trajectory.begin.position),
      trajectory_(plane.trajectory), local_(plane.local),
      other_(moving_core(shapes, other), other, from_)
{
    trajectory_.begin.position -= from_;
    rounding_ = kRounding
        * (other_.outer_radius() + other_.core().convex_radius + trajectory_.begin.position.norm()
           + local_.position.norm() + std::abs(plane_.offset) + trajectory_.shift.norm()
           + other_.trajectory().shift.norm());
}

Vec3 OverPlane::normal_at(double time) const
{
    return (trajectory_.at(time) * local_).orientation * plane_.normal;
}

Apart OverPlane::distance_at(double time) const
{
    const Vec3 normal = normal_at(time);
    return {separation_rate(normal, time), normal};
}

SeparationRate OverPlane::separation_rate(const Vec3&, double time) const
{
    const Pose body = trajectory_.at(time);
    const Pose placed = body * local_;
    const Vec3 normal = placed.orientation * plane_.normal;
    const Vec3 lowest = other_.furthest_along(-normal, time);
    // Against that point of the plane's body that is there now.
    const Vec3 speed = other_.speed_of(lowest, time) - trajectory_.shift
        - trajectory_.angular_velocity(time).cross(lowest - body.position);
    return {normal.dot(lowest - placed.position) - plane_.offset - other_.core().convex_radius
                - rounding_,
            normal.dot(speed)};
}

SeparationLimits OverPlane::limits_along(const Vec3&) const
{
    const Vec3 normal = normal_at(0);
    const SeparationLimits turning = other_.turning_limits(normal);
    const Vec3 nearing = trajectory_.shift - other_.trajectory().shift;
    if (!trajectory_.turns()) return {turning.bend, normal.dot(nearing) + turning.speed};
    // In the frame of the plane, which turns with it about its body: nothing is further from there
    // than `far`.
    const double spin = trajectory_.angle(), spin_other = other_.trajectory().angle();
    const double far = trajectory_.begin.position.norm() + nearing.norm() + other_.outer_radius();
    const double speed = nearing.norm() + spin_other * other_.outer_radius();
    const double centripetal = spin * spin + trajectory_.angular_acceleration();
    const double of_other = spin_other * spin_other + other_.trajectory().angular_acceleration();
    return {centripetal * far + 2 * spin * speed + of_other * other_.outer_radius(),
            spin * far + speed};
}

void visit_triangles_in_way(const Mesh& mesh,
                            const MovingShape& on,
                            const ConvexCore<double>& core,
                            const MovingShape& other,
                            const Approach& approach,
                            const std::function<void(std::uint32_t)>& visit)
{
    const BodyBall ball = ball_of(core, other.local);
    // Of a mesh that turns, what turns about is looked at as if it were all round its body.
    const bool turns = on.trajectory.turns();
    const Vec3 middle = turns ? Vec3(Vec3::Zero()) : ball.center;
    const auto seen_at = [&](double time) {
        return (on.trajectory.at(time) * on.local).to_local(other.trajectory.at(time) * middle);
    };
    const double arm = ball.center.norm(), time = approach.end - approach.begin;
    // No curve leaves its chord by more than an eighth of what it bends by in the square of its
    // time; and this one keeps to the body's middle, which goes straight.
    const double bend = other.trajectory.angle() * other.trajectory.angle()
        + other.trajectory.angular_acceleration();
    const double beside = turns ? arm : std::min(2.0, bend * time * time / 8) * arm;
    double radius = ball.radius + beside + core.convex_radius + approach.margin;
    const Vec3 from = seen_at(approach.begin);
    Vec3 way = seen_at(approach.end) - from;
    if (turns) {
        // As far as the mesh may turn under it, it may be anywhere.
        const double most = (other.trajectory.begin.position - on.trajectory.begin.position).norm()
            + other.trajectory.shift.norm() + on.trajectory.shift.norm();
        radius += (other.trajectory.shift - on.trajectory.shift).norm()
            + std::min(2.0, on.trajectory.angle()) * most;
        way.setZero();
    }
    radius += kRounding * (from.norm() + way.norm() + radius);
    const Vec3 grown = Vec3::Constant(radius);
    visit_nodes(
        mesh,
        [&](const Mesh::Node& node) {
            return meets(from, way, node.lower - grown, node.upper + grown);
        },
        [&](std::uint32_t triangle) {
            const Box3 box = triangle_box(mesh, triangle);
            if (meets(from, way, box.lower - grown, box.upper + grown)) visit(triangle);
        });
}

}  // namespace throng
