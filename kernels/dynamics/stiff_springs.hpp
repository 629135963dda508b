// Stiff springs: bodies that springs join, through a step of any length, by a rule that neither
// damps nor gains.
//
// Half of what springs give in a step comes before bodies move and half after it, both as the
// springs are in the middle of it: the implicit midpoint rule,
//
//   u = v + f(x, x + h u) h / 2m,   x' = x + h u,   v' = u + f(x, x + h u) h / 2m,
//
// where u is how fast places change. For a spring along a line, f = -k (x + x') / 2, so
// m (v'^2 - v^2) / 2 = m u (v' - v) = u h f = (x' - x) f = -k (x'^2 - x^2) / 2: energy stays as it
// is, exactly, at any k and h. For one that turns f is the discrete gradient of its energy, the
// change of energy over the change of length along the sum of both ways, which keeps that so:
//
//   f = -k ((l + l') / 2 - length) (q + q') / (l + l'),   q from end to end, l = |q|.
//
// A body that turns is turned by both halves alike in its own axes (turning_arm.hpp), which keeps
// it so at any inertia and however far it turns. Damping is half in either half, both as implicit
// Euler has it: it slows, and turns nothing round.
//
// Source: Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), II.1 and V.5; Gonzalez &
//         Simo, On the stability of symplectic and energy-momentum algorithms for non-linear
//         Hamiltonian systems with symmetry (1996).
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/forces.hpp"
#include "kernels/dynamics/turning_arm.hpp"

#include <span>

namespace throng {

/// A body as its springs see it.
///
///   position, turn   as the step began; of the point that its inertia is about
///   velocity, spin   m/s, rad/s, world axes
///   inverse_inertia  1/(kg m2), world axes
///   axis, carries    how its spin turns it: see BodyTurn
struct SpringBody {
    std::uint32_t body = kNoBody;
    Vec3 position = Vec3::Zero();
    Mat3 turn = Mat3::Identity();
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
    double inverse_mass = 0;
    Mat3 inverse_inertia = Mat3::Zero();
    Vec3 axis = Vec3::UnitZ();
    double carries = 1;
};

/// The springs of bodies that are joined.
class StiffSprings {
public:
    /// Velocities of a body, and impulses on it.
    struct Six {
        Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    };

    /// Ends that are on none of the bodies move on from where they are in the facts.
    ///
    ///   group  bodies, ascending
    StiffSprings(const Forces& forces,
                 const Masses& masses,
                 const Poses& poses,
                 const Velocities& velocities,
                 std::span<const std::uint32_t> group);

    /// To be filled before begin(); velocities and spins before again() and end() too.
    std::vector<SpringBody>& bodies() { return bodies_; }

    /// What springs add to velocities before places change. The step begins at a time, s since the
    /// facts were so.
    std::span<const Six> begin(double time, double span);
    /// The same once something else has changed the velocities as well: what is to be added to what
    /// was.
    std::span<const Six> again();
    /// What they add after it, to the velocities and spins that the bodies have then: nothing where
    /// they could not be followed.
    std::span<const Six> end();

    /// Whether what they were asked last was found.
    bool found() const { return found_; }
    /// J, that they take up in the step as bodies go on by that.
    double stored() const;
    /// Whether any end is on none of the bodies; and whether such an end moves, and so does work.
    bool are_tied() const;
    bool are_drawn() const;
    /// rad, how far any arm goes round by that.
    double furthest_turn() const;

private:
    // a, b: places among the bodies; below 0 for others.
    struct Row {
        const SpringForce* spring = nullptr;
        std::int32_t a = -1, b = -1;
        Vec3 arm_a, arm_b;  // m, world axes, from positions, as the step began
        Vec3 from, outer;   // m, end to end then; what ends that are outside move until its end
        // Arms, and end to end, once places have changed; lever arms: see BodyTurn.
        Vec3 end_a = Vec3::Zero(), end_b = Vec3::Zero(), to = Vec3::Zero();
        Mat3 lever_a = Mat3::Zero(), lever_b = Mat3::Zero();
        Vec3 elastic, damping;  // N s on a, in half the step and in all of it
        Mat3 stiffness;         // N s per m/s: how these change with the speed of b against a
        double stored = 0;      // J, that the spring takes up in the step
    };

    Row row_of(const SpringForce& spring, double time) const;
    Vec3 outer_end(std::uint32_t body, const Vec3& at, double time) const;
    void stretch(Row& row) const;
    void stretch_all();
    double inverse_mass_at(std::int32_t place, const Mat3& lever_arm) const;
    Vec3 speed_between(const Row& row, std::span<const Six> speeds) const;
    void apply_impulse(const Row& row, const Vec3& impulse, std::span<Six> on) const;
    Six eased(std::size_t i, const Six& impulse) const;
    void follow();
    double find_missing();
    void foresee();
    bool find_on();
    double gained_energy() const;
    bool guess();
    void hold();
    void slow_down();
    Vec3 common_velocity() const;
    Six stopping(std::size_t i, const Vec3& common) const;
    double damping_again();
    void damp_end();
    void find();
    void conjugate_gradients();
    std::span<const Six> changes(std::span<const Six> impulses);

    const Forces& forces_;
    const Masses& masses_;
    const Poses& poses_;
    const Velocities& velocities_;
    std::vector<SpringBody> bodies_;
    std::vector<Row> rows_;
    std::vector<BodyTurn> turns_;  // [bodies] by how they go on
    double time_ = 0, span_ = 0;
    bool found_ = false;
    std::vector<Six> without_, going_;  // [bodies] velocities without springs, and with them
    std::vector<Six> impulse_, given_;  // [bodies] before places change; what was told of it
    std::vector<Six> before_, missing_, step_, step_momentum_, answer_,
        change_;  // [bodies] scratch
};

}  // namespace throng
