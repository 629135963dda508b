// Plain contact: one contact solved by the formulas of the textbook, in double and in world axes,
// everything computed afresh from the bodies after every impulse.
#pragma once

#include "kernels/data/contact_constraints.hpp"
#include "kernels/data/contacts.hpp"
#include "kernels/solver/contact_packing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace throng::given {

/// The solution of a few equations, rows of coefficients that end with the right side: by
/// elimination with the greatest pivot of a column. Eigen's would take each file that includes this
/// seconds more.
inline std::vector<double> solved_by_elimination(std::vector<std::vector<double>> rows)
{
    const std::size_t count = rows.size();
    for (std::size_t at = 0; at < count; ++at) {
        std::size_t pivot = at;
        for (std::size_t k = at + 1; k < count; ++k)
            if (std::abs(rows[k][at]) > std::abs(rows[pivot][at])) pivot = k;
        std::swap(rows[at], rows[pivot]);
        for (std::size_t k = 0; k < count; ++k) {
            const double share = k == at ? 0 : rows[k][at] / rows[at][at];
            for (std::size_t i = at; i <= count; ++i) rows[k][i] -= share * rows[at][i];
        }
    }
    std::vector<double> solution;
    for (std::size_t at = 0; at < count; ++at) solution.push_back(rows[at][count] / rows[at][at]);
    return solution;
}

/// A body as a textbook has it. Where nothing turns, it has neither spin nor inertia.
struct PlainBody {
    Vec3 velocity, spin, moved;
    Mat3 turn;
    double inverse_mass = 0;
    Mat3 inverse_inertia;
    bool written = false;
    bool halves = false;  // of gravity come before it moves and after

    template <class Real>
    PlainBody(const SolverBody<Real>& body, bool may_write, bool turns = true) : written(may_write)
    {
        const auto vec = [](const Real* from) {
            return Vec3(double{from[0]}, double{from[1]}, double{from[2]});
        };
        velocity = vec(body.motion);
        spin = vec(body.motion + 4);
        moved = vec(body.delta_pose);
        turn = Quat(double{body.delta_pose[7]}, double{body.delta_pose[4]},
                    double{body.delta_pose[5]}, double{body.delta_pose[6]})
                   .toRotationMatrix();
        inverse_mass = double{body.inertia[0]};
        halves = body.inertia[7] != 0;
        inverse_inertia =
            Sym3{double{body.inertia[1]}, double{body.inertia[2]}, double{body.inertia[3]},
                 double{body.inertia[4]}, double{body.inertia[5]}, double{body.inertia[6]}}
                .matrix();
        if (turns) return;
        spin.setZero();
        turn.setIdentity();
        inverse_inertia.setZero();
    }
    Vec3 velocity_at(const Vec3& arm) const { return velocity + spin.cross(arm); }
    /// Where a point of the body has gone since the step began, less where it was.
    Vec3 moved_at(const Vec3& arm) const { return moved + turn * arm - arm; }
    void push(const Vec3& impulse, const Vec3& arm)
    {
        velocity += inverse_mass * impulse;
        spin += inverse_inertia * arm.cross(impulse);
    }
    void apply_angular_impulse(const Vec3& impulse) { spin += inverse_inertia * impulse; }
};

struct PlainIteration {
    double substep = 0, push_limit = 0;
    bool use_bias = false, has_friction = true, has_rolling_friction = false;
    bool friction_at_points = false, friction_pyramid = false;  // friction of another kind
    bool together = true;  // the points are first pushed all at once
    int normal_iterations = 1;
    bool restitutions = false;  // what comes in faster than `slow` is left to its impact
    double restitution_threshold = 0;
    Vec3 gravity_step = Vec3::Zero();
};

/// The share that a point of a contact has in its center: as much as all, or of round sides as much
/// as it bears.
template <class Real>
double share_of_center(const Contact<Real>& contact, int k)
{
    double load = 0;
    for (int i = 0; i < contact.count; ++i)
        load += double{contact.points[static_cast<std::size_t>(i)].impulse};
    const bool rolls = contact.round_a + contact.round_b > 0 && load > 0;
    return rolls ? double{contact.points[static_cast<std::size_t>(k)].impulse} / load
                 : 1.0 / contact.count;
}

class PlainContact {
public:
    template <class Real>
    PlainContact(const Contact<Real>& contact,
                 const ContactParameters<Real>& terms,
                 const PlainBody& body_a,
                 const PlainBody& body_b)
        : a(body_a), b(body_b), normal(contact.normal.template cast<double>()),
          friction_impulse(contact.friction.template cast<double>()),
          rolling_impulse(contact.rolling.template cast<double>()),
          torsional_impulse(contact.torsional_impulse), round_a_(contact.round_a),
          round_b_(contact.round_b), friction_(terms.friction), restitution_(terms.restitution),
          rolling_(terms.rolling_friction), bias_rate_(terms.softness.bias_rate),
          impulse_scale_(terms.softness.impulse_scale), deep_(terms.deep)
    {
        const Vec3 between = contact.center_offset.template cast<double>();
        double total = 0;
        for (int k = 0; k < contact.count; ++k) {
            const auto& from = contact.points[static_cast<std::size_t>(k)];
            Point point;
            point.separation = from.separation;
            point.arm_a = from.anchor_a.template cast<double>();
            point.arm_b = point.arm_a + normal * point.separation + between;
            point.impulse = from.impulse;
            const double share = share_of_center(contact, k);
            center_a += point.arm_a * share;
            center_b += point.arm_b * share;
            total += point.impulse;
            points.push_back(point);
        }
        held_uncut = friction_impulse;
        // What was carried over stays within the cone.
        if (friction_impulse.norm() > friction_ * total)
            friction_impulse *= friction_ * total / friction_impulse.norm();
        // Seen from the center, points lie in the plane of the contact.
        for (Point& point : points) {
            point.off = point.arm_a - center_a;
            point.off -= normal * normal.dot(point.off);
        }
    }

    void warm_start(const PlainIteration& iteration)
    {
        for (const Point& point : points) apply(point.impulse * normal, point.arm_a, point.arm_b);
        if (!iteration.has_friction) return;
        if (iteration.friction_pyramid) friction_impulse = held_uncut;
        if (iteration.friction_at_points) {
            share_friction(iteration);
        } else if (iteration.friction_pyramid) {
            double total = 0;
            for (const Point& point : points) total += point.impulse;
            friction_impulse = within_pyramid(friction_impulse, friction_ * total);
        }
        apply(friction_impulse, center_a, center_b);
        apply_angular_impulse(torsional_impulse * normal);
        if (iteration.has_rolling_friction) apply_angular_impulse(rolling_impulse);
    }

    void solve(const PlainIteration& iteration)
    {
        // Aims are those of the iteration's beginning; friction comes before the last round of
        // pushes.
        int overlapping = 0;
        for (const Point& point : points)
            overlapping += separation_of(point) < 0 && mass_of(point) > 0 ? 1 : 0;
        for (Point& point : points) aim(point, iteration, overlapping);
        if (iteration.together) solve_normals_as_block();
        for (int i = 1; i < iteration.normal_iterations; ++i)
            for (Point& point : points) push(point);
        if (iteration.has_friction) hold(iteration);
        for (Point& point : points) push(point);
    }

    // An impact is a contact of its own that holds nothing yet: of the points that strike, seen in
    // the middle of what gravity does, where those are that it comes in halves to.
    void apply_restitution(const PlainIteration& iteration)
    {
        PlainContact struck = *this;
        const auto falls = [](const PlainBody& body) { return body.inverse_mass > 0 ? 1.0 : 0.0; };
        const auto lags = [&](const PlainBody& body) { return body.halves ? 0.0 : falls(body); };
        const Vec3 half = iteration.gravity_step * (falls(b) - falls(a)) / 2;
        const Vec3 behind = iteration.gravity_step * (lags(b) - lags(a)) / 2;
        struck.b.velocity += behind;
        struck.friction_impulse = struck.rolling_impulse = Vec3::Zero();
        struck.torsional_impulse = 0;
        std::vector<std::size_t> hits;
        for (std::size_t k = 0; k < points.size(); ++k) {
            Point& point = struck.points[k];
            point.impulse = 0;
            point.friction = Vec3::Zero();
            const double speed = struck.speed_of(point);
            const double then = separation_of(point) / iteration.substep + speed + normal.dot(half);
            if (restitution_ > 0 && speed < -iteration.restitution_threshold && then < 0
                && mass_of(point) > 0)
                hits.push_back(k);
        }
        if (hits.empty()) return;
        struck.throw_back(hits);
        if (iteration.has_friction) struck.hold(iteration);
        a = struck.a;
        b = struck.b;
        b.velocity -= behind;
        for (const Point& point : struck.points) impact_impulse += normal * point.impulse;
        impact_impulse += struck.friction_impulse;
    }

    struct Point {
        Vec3 arm_a, arm_b, off = Vec3::Zero();
        double separation = 0, impulse = 0, bias = 0, leak = 0;
        bool left = false;  // to its impact
        Vec3 friction = Vec3::Zero();
    };
    PlainBody a, b;
    Vec3 normal;
    std::vector<Point> points;
    Vec3 center_a = Vec3::Zero(), center_b = Vec3::Zero();
    Vec3 friction_impulse, held_uncut, rolling_impulse, impact_impulse = Vec3::Zero();
    double torsional_impulse;
    double held_by = 0, held_at = 0;  // load and its lever arm, by which friction went last

    /// How far apart the surfaces are by now. Within a round side there is a core that turns with
    /// the body; the skin round it does not.
    double separation_of(const Point& point) const
    {
        const Vec3 core_a = center_a + point.off - round_a_ * normal;
        const Vec3 core_b = center_b + point.off + round_b_ * normal;
        return point.separation + normal.dot(b.moved_at(core_b) - a.moved_at(core_a));
    }

private:
    void apply(const Vec3& impulse, const Vec3& arm_a, const Vec3& arm_b)
    {
        a.push(-impulse, arm_a);
        b.push(impulse, arm_b);
    }
    void apply_angular_impulse(const Vec3& impulse)
    {
        a.apply_angular_impulse(-impulse);
        b.apply_angular_impulse(impulse);
    }
    double speed_of(const Point& point) const
    {
        return normal.dot(b.velocity_at(point.arm_b) - a.velocity_at(point.arm_a));
    }
    // What answers an impulse p at the arms with velocity: the matrix of the textbook.
    Mat3 inverse_mass_matrix(const Vec3& arm_a, const Vec3& arm_b) const
    {
        const auto cross = [](const Vec3& v) {
            Mat3 m;
            m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
            return m;
        };
        return (a.inverse_mass + b.inverse_mass) * Mat3::Identity()
            - cross(arm_a) * a.inverse_inertia * cross(arm_a)
            - cross(arm_b) * b.inverse_inertia * cross(arm_b);
    }
    // None where neither body can be moved and the point has no lever arm to turn one by: at least
    // half of what it gives way has to come by arms that lie a hundredth aside of the normal.
    double mass_of(const Point& point) const
    {
        const double answer = normal.dot(inverse_mass_matrix(point.arm_a, point.arm_b) * normal);
        if (a.inverse_mass + b.inverse_mass > 0) return 1 / answer;
        double by_lever_arms = 0;
        for (const auto& [body, arm] : {std::pair(&a, point.arm_a), std::pair(&b, point.arm_b)}) {
            const Vec3 torque = arm.cross(normal);
            if (torque.norm() > 1e-2 * arm.norm())
                by_lever_arms += torque.dot(body->inverse_inertia * torque);
        }
        return 2 * by_lever_arms < answer || answer <= 0 ? 0 : 1 / answer;
    }
    void aim(Point& point, const PlainIteration& iteration, int overlapping) const
    {
        const double separation = separation_of(point);
        point.leak = 0;
        point.bias = separation > 0 ? separation / iteration.substep : 0;
        point.left = iteration.restitutions && !iteration.use_bias && restitution_ > 0
            && speed_of(point) < -iteration.restitution_threshold;
        if (separation > 0 || !iteration.use_bias) return;
        // Three points share a load: they may go three times as deep before they turn rigid.
        const double turns_rigid = deep_ * (overlapping >= 3 ? 3 : 1);
        const double depth = deep_ > 0 ? -separation / turns_rigid : 0;
        point.leak = impulse_scale_ * std::clamp(2 - depth, 0.0, 1.0);
        point.bias = std::max(bias_rate_ * separation, -iteration.push_limit);
    }
    void push(Point& point)
    {
        if (point.left) return;
        const double before = point.impulse;
        const double change = -mass_of(point) * (1 - point.leak) * (speed_of(point) + point.bias)
            - point.leak * before;
        point.impulse = std::max(before + change, 0.0);
        apply((point.impulse - before) * normal, point.arm_a, point.arm_b);
    }
    // The impulses with which each point gives way by its share and no other comes in between, by
    // a full system of equations; only where nobody pulls. A rigid point gives way by a little; of
    // one that is softer than it was only its present impulse leaks by what it is now.
    void solve_normals_as_block()
    {
        const std::size_t count = points.size();
        std::vector<std::vector<double>> system(count);
        for (std::size_t i = 0; i < count; ++i) {
            const Point& at = points[i];
            const double keep = at.left ? 0 : mass_of(at) * (1 - at.leak);
            for (const Point& other : points) system[i].push_back(keep * answer_at(at, other));
            system[i][i] += at.leak > 0 ? std::max(impulse_scale_, double{0.03f}) : double{0.03f};
            system[i].push_back(-keep * (speed_of(at) + at.bias) - at.leak * at.impulse);
        }
        std::vector<double> more = solved_by_elimination(std::move(system));
        for (std::size_t i = 0; i < count; ++i)
            if (points[i].left) more[i] = 0;
        for (std::size_t i = 0; i < count; ++i)
            if (points[i].impulse + more[i] < 0) return;
        for (std::size_t i = 0; i < count; ++i) {
            Point& at = points[i];
            at.impulse += more[i];
            apply(more[i] * normal, at.arm_a, at.arm_b);
        }
    }
    // Stops the points by sweeps; then as much of those impulses as leaves 1 - e2 of the energy
    // that it took behind.
    void throw_back(const std::vector<std::size_t>& hits)
    {
        PlainContact stopped = *this;
        for (int iteration = 0; iteration < kRestitutionIterations; ++iteration)
            for (const std::size_t k : hits) stopped.push(stopped.points[k]);
        double in = 0, change = 0;
        for (const std::size_t k : hits) {
            const double came = speed_of(points[k]);
            in -= stopped.points[k].impulse * came;
            change += stopped.points[k].impulse * (stopped.speed_of(stopped.points[k]) - came);
        }
        for (const std::size_t k : hits) {
            points[k].impulse = stopped.points[k].impulse * (1 + restitution_) * in / change;
            apply(points[k].impulse * normal, points[k].arm_a, points[k].arm_b);
        }
    }
    // The normal speed that an impulse of one on a point gives at another.
    double answer_at(const Point& at, const Point& pushed) const
    {
        PlainContact after = *this;
        after.a.velocity.setZero(), after.a.spin.setZero();
        after.b.velocity.setZero(), after.b.spin.setZero();
        after.apply(normal, pushed.arm_a, pushed.arm_b);
        return after.speed_of(at);
    }
    void hold(const PlainIteration& iteration)
    {
        double total = 0, lever_arm = 0;
        for (const Point& point : points) {
            total += point.impulse;
            lever_arm += point.impulse * point.off.norm();
        }
        held_by = total;
        held_at = lever_arm;
        const Mat3 turning = a.inverse_inertia + b.inverse_inertia;
        if (iteration.has_rolling_friction && turning.trace() > 0) {
            const Vec3 before = rolling_impulse;
            rolling_impulse -= (b.spin - a.spin) / turning.trace();
            const double most = rolling_ * total;
            if (rolling_impulse.norm() > most) rolling_impulse *= most / rolling_impulse.norm();
            apply_angular_impulse(rolling_impulse - before);
        }
        if (iteration.friction_at_points) return grip_each(iteration);
        if (points.size() > 1 && turning.trace() > 0) {
            const double before = torsional_impulse;
            const double mass = 1 / normal.dot(turning * normal);
            torsional_impulse -= mass * normal.dot(b.spin - a.spin);
            torsional_impulse =
                std::clamp(torsional_impulse, -friction_ * lever_arm, friction_ * lever_arm);
            apply_angular_impulse((torsional_impulse - before) * normal);
        }
        apply_friction(iteration, Vec3::Zero(), friction_ * total, friction_impulse);
    }
    void grip_each(const PlainIteration& iteration)
    {
        for (Point& point : points)
            apply_friction(iteration, point.off, friction_ * point.impulse, point.friction);
        add_up_friction();
    }
    void add_up_friction()
    {
        friction_impulse.setZero();
        torsional_impulse = 0;
        for (const Point& point : points) {
            friction_impulse += point.friction;
            torsional_impulse += normal.dot(point.off.cross(point.friction));
        }
    }
    // The friction of least weighted squares that has the force and torque that are held.
    void share_friction(const PlainIteration& iteration)
    {
        double load = 0, spread = 0, extent = 0;
        Vec3 middle = Vec3::Zero();
        for (const Point& point : points) load += point.impulse;
        for (const Point& point : points) {
            if (load > 0) middle += point.off * point.impulse / load;
            extent = std::max(extent, point.off.squaredNorm());
        }
        for (const Point& point : points)
            spread += point.impulse * (point.off - middle).squaredNorm();
        const double rest = torsional_impulse - normal.dot(middle.cross(friction_impulse));
        const double turn = spread > 1e-3 * load * extent ? rest / spread : 0;
        for (Point& point : points) {
            const double most = friction_ * point.impulse;
            Vec3 share = Vec3::Zero();
            if (load > 0)
                share = point.impulse
                    * (friction_impulse / load + turn * normal.cross(point.off - middle));
            if (iteration.friction_pyramid)
                share = within_pyramid(share, most);
            else if (share.norm() > most)
                share *= most / share.norm();
            point.friction = share;
        }
        add_up_friction();
    }
    // The first side of the pyramid: across the normal and an axis of the world far from it.
    Vec3 side() const
    {
        const bool flat = std::abs(normal.x()) < 0.6;
        return normal.cross(flat ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitY())).normalized();
    }
    Vec3 within_pyramid(const Vec3& held, double most) const
    {
        const Vec3 u = side(), v = normal.cross(u);
        return u * std::clamp(u.dot(held), -most, most) + v * std::clamp(v.dot(held), -most, most);
    }
    // Sticking with the full matrix of the tangent plane, else sliding within the cone or pyramid.
    void apply_friction(const PlainIteration& iteration, const Vec3& off, double most, Vec3& held)
    {
        const Vec3 arm_a = center_a + off, arm_b = center_b + off;
        const Vec3 u = side(), v = normal.cross(u);
        Eigen::Matrix<double, 3, 2> plane;
        plane << u, v;
        const Eigen::Matrix2d k = plane.transpose() * inverse_mass_matrix(arm_a, arm_b) * plane;
        const Eigen::Vector2d slip =
            plane.transpose() * (b.velocity_at(arm_b) - a.velocity_at(arm_a));
        const Eigen::Vector2d before = plane.transpose() * held;
        Eigen::Vector2d after = before - k.inverse() * slip;
        if (iteration.friction_pyramid && after.cwiseAbs().maxCoeff() > most) {
            after[0] = std::clamp(before[0] - slip[0] / k(0, 0), -most, most);
            const double then = slip[1] + k(0, 1) * (after[0] - before[0]);
            after[1] = std::clamp(before[1] - then / k(1, 1), -most, most);
        } else if (!iteration.friction_pyramid && after.norm() > most) {
            // The greater eigenvalue.
            const double stiffest = k.trace() / 2 + std::hypot((k(0, 0) - k(1, 1)) / 2, k(0, 1));
            after = before - slip / stiffest;
            if (after.norm() > most) after *= most / after.norm();
        }
        held = plane * after;
        apply(plane * (after - before), arm_a, arm_b);
    }

    double round_a_, round_b_;
    double friction_, restitution_, rolling_, bias_rate_, impulse_scale_, deep_;
};

}  // namespace throng::given
