// Plain sweeps: the same problem as the direct solver's, point after point until nothing changes.
//
// The answer sheet of the direct solver: projected Gauss-Seidel on the law itself, with no matrix
// and no cone program. It needs thousands of sweeps, and small heaps.
#pragma once

#include "kernels/solver/direct/direct.hpp"

#include <vector>

namespace throng::test {

class PlainSweeps {
public:
    PlainSweeps(std::vector<DirectBody>& bodies, std::vector<DirectPoint>& points)
        : bodies_(bodies), points_(points)
    {
        for (DirectPoint& point : points_) point.impulse = Vec3::Zero();
    }

    /// Of b against a at the point.
    Vec3 speed(const DirectPoint& point) const
    {
        const auto at = [&](std::int32_t body, const Vec3& arm) -> Vec3 {
            if (body < 0) return Vec3::Zero();
            const DirectBody& of = bodies_[static_cast<std::size_t>(body)];
            return of.velocity + of.spin.cross(arm);
        };
        return at(point.b, point.arm_b) - at(point.a, point.arm_a);
    }

    void run(int iterations)
    {
        for (int i = 0; i < iterations; ++i)
            for (DirectPoint& point : points_) visit(point);
    }

private:
    // How the point answers to an impulse.
    Mat3 answer(const DirectPoint& point) const
    {
        Mat3 all = Mat3::Zero();
        for (const auto& [body, arm] :
             {std::pair(point.a, point.arm_a), std::pair(point.b, point.arm_b)}) {
            if (body < 0) continue;
            const DirectBody& of = bodies_[static_cast<std::size_t>(body)];
            Mat3 lever_arm;
            lever_arm << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
            all += of.inverse_mass * Mat3::Identity()
                - lever_arm * of.inverse_inertia.matrix() * lever_arm;
        }
        return all;
    }
    void apply_impulse(const DirectPoint& point, const Vec3& impulse)
    {
        const auto give = [&](std::int32_t body, const Vec3& arm, const Vec3& by) {
            if (body < 0) return;
            DirectBody& to = bodies_[static_cast<std::size_t>(body)];
            to.velocity += by * to.inverse_mass;
            to.spin += to.inverse_inertia.matrix() * arm.cross(by);
        };
        give(point.a, point.arm_a, -impulse);
        give(point.b, point.arm_b, impulse);
    }
    void visit(DirectPoint& point)
    {
        const Vec3& n = point.normal;
        const Mat3 how = answer(point);
        const double old = n.dot(point.impulse);
        const double load =
            std::max(0.0, old - (n.dot(speed(point)) - point.least) / n.dot(how * n));
        apply_impulse(point, n * (load - old));
        point.impulse += n * (load - old);

        const Vec3 u = speed(point);
        const Vec3 before = point.impulse - n * load;
        Vec3 held = before - (u - n * n.dot(u)) / how.trace();
        const double most = point.friction * load;
        if (held.norm() > most) held *= most / held.norm();
        apply_impulse(point, held - before);
        point.impulse = n * load + held;
    }

    std::vector<DirectBody>& bodies_;
    std::vector<DirectPoint>& points_;
};

}  // namespace throng::test
