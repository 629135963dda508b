// Direct problems: stacks and heaps in one step's fall, for the direct solver to stop.
#pragma once

#include "kernels/solver/direct/direct.hpp"
#include "tests/support/dice.hpp"

#include <cmath>
#include <vector>

namespace throng::test {

inline constexpr double kFall = 9.81 / 60;  // m/s, of one step

struct Problem {
    std::vector<DirectBody> bodies;
    std::vector<DirectPoint> points;

    DirectAnswer solve(const DirectEffort& effort = {})
    {
        return DirectSolver().solve(bodies, points, effort);
    }
};

inline DirectBody box(double mass, const Vec3& size)
{
    DirectBody body;
    const Vec3 squares = size.cwiseProduct(size);
    const double share = 12 / mass;
    body.inverse_mass = 1 / mass;
    body.inverse_inertia = {share / (squares.y() + squares.z()),
                            share / (squares.x() + squares.z()),
                            share / (squares.x() + squares.y())};
    body.velocity = Vec3(0, 0, -kFall);
    return body;
}

// Four points under a face, `half` below b's center and above a's.
inline void add_face(Problem& problem, int a, int b, double half, double friction)
{
    for (const double x : {-0.5, 0.5})
        for (const double y : {-0.5, 0.5}) {
            DirectPoint point;
            point.a = a;
            point.b = b;
            point.arm_a = Vec3(x, y, half);
            point.arm_b = Vec3(x, y, -half);
            point.friction = friction;
            problem.points.push_back(point);
        }
}

inline Problem stack(int high, double top_mass = 1)
{
    Problem problem;
    for (int k = 0; k < high; ++k) {
        problem.bodies.push_back(box(k == high - 1 ? top_mass : 1, Vec3::Ones()));
        add_face(problem, k - 1, k, 0.5, 0.5);
    }
    return problem;
}

// Bodies of all masses in a cloud, each touching the ground or some before it.
inline Problem heap(Dice& dice, int bodies, double friction)
{
    Problem problem;
    for (int k = 0; k < bodies; ++k) {
        const Vec3 size(dice.between(0.5, 1.5), dice.between(0.5, 1.5), dice.between(0.5, 1.5));
        problem.bodies.push_back(box(std::pow(10, dice.between(-0.5, 0.5)), size));
        problem.bodies.back().velocity += dice.point(0.3);
        problem.bodies.back().spin = dice.point(0.3);
        for (int i = 0; i < 3; ++i) {
            DirectPoint point;
            point.b = k;
            point.a = static_cast<int>(dice.between(-1, k)) - (k == 0 ? 1 : 0);
            if (point.a >= k) point.a = k - 1;
            point.normal = (Vec3::UnitZ() + dice.point(0.7)).normalized();
            point.arm_a = dice.point(0.5);
            point.arm_b = -0.5 * point.normal + dice.point(0.3);
            point.friction = friction;
            point.least = dice.between(0, 1) < 0.3 ? -dice.between(0, 0.1) : 0;
            problem.points.push_back(point);
        }
    }
    return problem;
}

}  // namespace throng::test
