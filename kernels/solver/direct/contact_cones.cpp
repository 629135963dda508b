#include "kernels/solver/direct/contact_cones.hpp"

#include "kernels/data/contact_constraints.hpp"

#include <limits>

namespace throng {

namespace {

// L of inverse inertia = L L'. About what does not turn it has zeros.
Mat3 root_of(const Sym3& inertia)
{
    const Mat3 m = inertia.matrix();
    const double least = 1e-14 * m.trace();
    Mat3 root = Mat3::Zero();
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k <= i; ++k) {
            double left = m(i, k);
            for (int j = 0; j < k; ++j) left -= root(i, j) * root(k, j);
            if (i == k)
                root(i, i) = left > least ? std::sqrt(left) : 0;
            else
                root(i, k) = root(k, k) > 0 ? left / root(k, k) : 0;
        }
    }
    return root;
}

// Any direction across the normal; which one does not matter, friction is a round cone.
Vec3 across(const Vec3& n)
{
    const bool flat = std::abs(n.x()) < 0.6;
    return n.cross(flat ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitY())).normalized();
}

// To slide as one walks is not to slide.
void choose_rows(const DirectPoint& point, ContactCone& cone)
{
    const Vec3 tangent = across(point.normal), other = point.normal.cross(tangent);
    cone.rows = 0;
    const auto add = [&](const Vec3& axis, double share, bool turns) {
        cone.axis[cone.rows] = axis;
        cone.share[cone.rows] = share;
        cone.turns[cone.rows++] = turns;
    };
    add(point.normal, 1, false);
    if (point.friction > 0)
        for (const Vec3& axis : {tangent, other}) {
            cone.free[cone.rows] = -point.friction * axis.dot(point.walk);
            add(axis, point.friction, false);
        }
    if (point.rolling > 0)
        for (const Vec3& axis : {tangent, other, point.normal}) add(axis, point.rolling, true);
}

// Whether a push along the normal does anything but spin what cannot be moved: see kLeastLeverArm.
bool gives_way(const DirectPoint& point, const ContactCone& cone)
{
    double moves = 0, turns = 0, by_lever_arms = 0;
    const auto add = [&](const ConeBlock& rows, const Vec3& arm) {
        const double turned = rows.row(0).tail<3>().squaredNorm();
        const double lever_arm = arm.cross(point.normal).squaredNorm();
        moves += rows.row(0).head<3>().squaredNorm();
        turns += turned;
        if (lever_arm > kLeastLeverArm * kLeastLeverArm * arm.squaredNorm())
            by_lever_arms += turned;
    };
    add(cone.of_a, point.arm_a);
    add(cone.of_b, point.arm_b);
    return moves > 0 || (turns > 0 && 2 * by_lever_arms >= turns);
}

}  // namespace

void ContactCones::take_bodies(std::span<const DirectBody> bodies)
{
    roots_.resize(bodies.size());
    columns_ = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        Root& root = roots_[i];
        root = {std::sqrt(bodies[i].inverse_mass), root_of(bodies[i].inverse_inertia), -1};
        if (root.linear > 0 || root.angular.norm() > 0)
            root.column = static_cast<std::int32_t>(columns_++);
    }
}

void ContactCones::add_side(const DirectPoint& point,
                            std::span<const DirectBody> bodies,
                            bool is_b,
                            ContactCone& cone) const
{
    const std::int32_t place = is_b ? point.b : point.a;
    if (place < 0) return;
    const DirectBody& body = bodies[static_cast<std::size_t>(place)];
    const Root& root = roots_[static_cast<std::size_t>(place)];
    const Vec3& arm = is_b ? point.arm_b : point.arm_a;
    ConeBlock& rows = is_b ? cone.of_b : cone.of_a;
    for (std::size_t k = 0; k < cone.rows; ++k) {
        const Vec3 axis = cone.axis[k] * (is_b ? cone.share[k] : -cone.share[k]);
        const Vec3 linear = cone.turns[k] ? Vec3(Vec3::Zero()) : axis;
        const Vec3 angular = cone.turns[k] ? axis : Vec3(arm.cross(axis));
        const auto row = static_cast<Eigen::Index>(k);
        rows.row(row).head<3>() = linear * root.linear;
        rows.row(row).tail<3>() = root.angular.transpose() * angular;
        cone.free[k] += linear.dot(body.velocity) + angular.dot(body.spin);
    }
    (is_b ? cone.tie.b : cone.tie.a) = root.column;
}

void ContactCones::take_guess(const DirectPoint& point, ContactCone& cone) const
{
    cone.impulse = {};
    for (std::size_t k = 0; k < cone.rows; ++k)
        cone.impulse[k] = cone.axis[k].dot(cone.turns[k] ? point.torque : point.impulse)
            / (cone.share[k] * cone.unit * unit_);
    cone.impulse = projected(cone.impulse);
    if (!std::isfinite(dot(cone.impulse, cone.impulse))) cone.impulse = {};
}

bool ContactCones::take(std::span<const DirectBody> bodies, std::span<const DirectPoint> points)
{
    take_bodies(bodies);
    cones.clear();
    unit_ = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        ContactCone cone;
        cone.point = i;
        choose_rows(points[i], cone);
        add_side(points[i], bodies, false, cone);
        add_side(points[i], bodies, true, cone);
        const double answer =
            std::sqrt(cone.of_a.row(0).squaredNorm() + cone.of_b.row(0).squaredNorm());
        // Where neither can be moved along the normal, no impulse helps.
        constexpr double kNone = 1e-150;
        if (!(answer > kNone) || !gives_way(points[i], cone)) continue;
        cone.free[0] -= points[i].least;
        cone.unit = 1 / answer;
        cone.of_a *= cone.unit;
        cone.of_b *= cone.unit;
        for (double& speed : cone.free) {
            speed *= cone.unit;
            unit_ = std::max(unit_, std::abs(speed));
        }
        cones.push_back(cone);
    }
    if (!(unit_ > 0)) return false;
    for (ContactCone& cone : cones) {
        for (double& speed : cone.free) speed /= unit_;
        take_guess(points[cone.point], cone);
    }
    return true;
}

void ContactCones::give(std::span<DirectBody> bodies, std::span<DirectPoint> points) const
{
    std::vector<BodySix> change;
    push_all(change);
    for (DirectPoint& point : points) point.impulse = point.torque = Vec3::Zero();
    for (const ContactCone& cone : cones) {
        DirectPoint& point = points[cone.point];
        for (std::size_t k = 0; k < cone.rows; ++k)
            (cone.turns[k] ? point.torque : point.impulse) +=
                cone.axis[k] * (cone.impulse[k] * cone.share[k] * cone.unit * unit_);
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (roots_[i].column < 0) continue;
        const BodySix& by = change[static_cast<std::size_t>(roots_[i].column)];
        bodies[i].velocity += by.head<3>() * (roots_[i].linear * unit_);
        bodies[i].spin += roots_[i].angular * by.tail<3>() * unit_;
    }
}

std::vector<BodyTie> ContactCones::ties() const
{
    std::vector<BodyTie> ties;
    for (const ContactCone& cone : cones) ties.push_back(cone.tie);
    return ties;
}

ConeVector ContactCones::seen(const ContactCone& cone, std::span<const BodySix> change) const
{
    ConeVector speed{};
    for (std::size_t k = 0; k < cone.rows; ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        if (cone.tie.a >= 0)
            speed[k] += cone.of_a.row(row).dot(change[static_cast<std::size_t>(cone.tie.a)]);
        if (cone.tie.b >= 0)
            speed[k] += cone.of_b.row(row).dot(change[static_cast<std::size_t>(cone.tie.b)]);
    }
    return speed;
}

void ContactCones::apply_impulse(const ContactCone& cone,
                                 const ConeVector& impulse,
                                 std::span<BodySix> change) const
{
    for (std::size_t k = 0; k < cone.rows; ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        if (cone.tie.a >= 0)
            change[static_cast<std::size_t>(cone.tie.a)] +=
                cone.of_a.row(row).transpose() * impulse[k];
        if (cone.tie.b >= 0)
            change[static_cast<std::size_t>(cone.tie.b)] +=
                cone.of_b.row(row).transpose() * impulse[k];
    }
}

void ContactCones::push_all(std::vector<BodySix>& change) const
{
    change.assign(columns_, BodySix::Zero());
    for (const ContactCone& cone : cones) apply_impulse(cone, cone.impulse, change);
}

double ContactCones::residual(std::vector<BodySix>& scratch) const
{
    push_all(scratch);
    double greatest = 0;
    for (const ContactCone& cone : cones) {
        ConeVector speed = sum(cone.free, seen(cone, scratch));
        speed[0] += width(speed);
        const ConeVector kept = projected(sum(cone.impulse, speed, -1));
        const ConeVector missed = sum(cone.impulse, kept, -1);
        const double length = std::sqrt(dot(missed, missed));
        if (!std::isfinite(length)) return std::numeric_limits<double>::infinity();
        greatest = std::max(greatest, length);
    }
    return greatest;
}

double ContactCones::work(std::vector<BodySix>& scratch) const
{
    push_all(scratch);
    double work = 0;
    for (const ContactCone& cone : cones)
        work += dot(cone.impulse, sum(cone.free, seen(cone, scratch), 0.5));
    return work;
}

}  // namespace throng
