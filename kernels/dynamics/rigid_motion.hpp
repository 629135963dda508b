// Rigid motion: the law by which bodies fly, alone or several that springs join.
//
// To an integrator a state is a row of numbers. Here is what they are, body after body:
//
//   places  its position (3); then the change of rotation since the last call of settle() (3) and
//           an angle (1), or the numbers of a rotation that adds rates (4 or 9)
//   speeds  velocity (3), angular velocity in body axes (3)
//
// A body on a pivot may have its angular momentum about the pivot in world axes instead, and its
// change of rotation in world axes too. What it spins about its axis of symmetry, or what comes
// nearest to one, is then counted apart: that is the angle, which is nothing for other bodies. So
// the numbers of a fast top hardly change, and those of one that nothing acts on are exact.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/forces.hpp"
#include "kernels/dynamics/integrators.hpp"
#include "kernels/dynamics/orientation.hpp"
#include "kernels/geometry/mass.hpp"

#include <span>

namespace throng {

/// What holds for all bodies of a step.
struct RigidRule {
    Vec3 gravity = Vec3::Zero();  // m/s2
    double time = 0;              // s, since the world began, as the step begins
    double substep = 0;           // s, as finely as attractors are followed
    bool turns = true;            // bodies may turn at all
    Rotation rotation = Rotation::quaternion;
    // How gyrate() takes the gyroscopic torque; to rates it is there or not.
    enum class Gyroscopic : std::uint8_t {
        off,
        implicit,
        direct
    } gyroscopic = Gyroscopic::implicit;
    bool momentum_on_pivots = false;  // as above
};

/// What the law reads of all bodies, as they are when the step begins.
struct RigidFacts {
    const Forces& forces;
    const Masses& masses;
    const Poses& poses;
    const Velocities& velocities;
};

class RigidMotion : public MotionLaw {
public:
    RigidMotion(const RigidRule& rule, const RigidFacts& facts)
        : rule_(rule), facts_(facts), forced_(facts.forces.any())
    { }

    /// Takes up some bodies, ascending, in place of those before. What springs join them to and is
    /// not among them moves on at its velocity.
    void take(std::span<const std::uint32_t> bodies, const Flights& flights);
    double* state() { return state_.data(); }
    /// From now on springs are somebody else's (see stiff_springs.hpp), or its own again.
    void leave_springs(bool leave = true) { by_springs_ = !leave; }
    /// Goes on by an integrator from a time, s since the step began; by splitting, which bears any
    /// spin, where a body turns further in the span than that one can follow.
    void
    advance(const IntegratorRow& integrator, double time, double span, IntegratorScratch& scratch);
    /// After each call of an integrator: changes of rotation are taken into the orientations.
    void settle();

    /// What has become of the body that was taken up at a place.
    struct Outcome : BodyMotion {
        FlightMemory memory;
    };
    Outcome outcome(std::size_t i) const;

    /// Puts a body where it is at some moment of the step, for find_accelerations(); its state
    /// stays.
    void stand(std::size_t i, const Pose& pose, const Vec3& velocity, const Vec3& spin);
    /// What forces do to those that stand, from a place to before another, at a time, s since the
    /// step began.
    void find_accelerations(double time, std::size_t begin, std::size_t end);
    /// World axes, m/s2 and rad/s2. Gravity is among them where it hangs from a pivot, and not
    /// where it falls. Of drag it is the mean over a span from there on.
    struct Acceleration {
        Vec3 linear, angular;
    };
    Acceleration acceleration_of(std::size_t i, double span) const;
    /// The same of one as its state has it, at the step's beginning.
    Acceleration mean_acceleration(std::size_t i, double span);

    /// Where its state has a body and how fast that goes, world axes.
    struct Going {
        Vec3 position;
        Mat3 turn;
        Vec3 velocity, spin;
        Mat3 inverse_inertia;
        Vec3 axis;  // how go() turns it: see BodyTurn
        double carries;
    };
    Going going(std::size_t i) const;
    /// Adds to that. Not for bodies that have a momentum in place of a spin.
    void add_speed(std::size_t i, const Vec3& velocity, const Vec3& spin);
    /// drift() in two, for what acts as bodies go: places, and the precession of what is symmetric
    /// about an axis; and the precession of the others, whose spin turns them as it is meanwhile.
    void go(double span);
    void precess(double span);

    std::size_t places() const override { return bodies_.size() * place_numbers(); }
    std::size_t speeds() const override { return bodies_.size() * 6; }
    void place_rates(const double* state, double* rates) override;
    void speed_rates(double time, const double* state, double* rates) override;
    void kick(double time, double span, double* state) override;
    void gyrate(double span, double* state) override;
    void drift(double span, double* state) override;

private:
    struct Body {
        std::uint32_t body = 0;
        bool turns = false, precesses = false, by_momentum = false;
        double inverse_mass = 0;
        Mat3 inverse_inertia = Mat3::Zero();  // inverse inertia
        PrincipalInertia principal;
        Vec3 own_axis = Vec3::Zero();    // that of the angle, in body axes
        double own_share = 0;            // the angle's rate over momentum about it, 1 / (kg m2)
        Vec3 spin = Vec3::Zero();        // as taken up: the speeds it begins with
        OrientationNumbers orientation;  // as of the last settle()
    };
    // Where a body is at a moment.
    struct Moment {
        Mat3 turn;            // body axes to world axes
        Vec3 position, arm;   // m; arm: from there to the center of mass
        Vec3 velocity, spin;  // of the center of mass, m/s; rad/s; world axes
    };

    double furthest_turn(double span) const;
    std::size_t place_numbers() const
    {
        const int turn = adds_rates(rule_.rotation) ? numbers_of(rule_.rotation) : 4;
        return 3 + static_cast<std::size_t>(turn);
    }
    std::size_t place_of(std::size_t i) const { return i * place_numbers(); }
    std::size_t speed_of(std::size_t i) const { return places() + i * 6; }
    double mass_of(const Body& body) const { return facts_.masses.mass[body.body]; }
    Mat3 turn_at(std::size_t i, const double* state) const;
    Vec3 body_spin(std::size_t i, const Mat3& turn, const double* state) const;
    Body taken(std::uint32_t id, const Flights& flights) const;
    Moment moment_at(std::size_t i, const double* state) const;
    Moment moment_outside(std::uint32_t body, double time) const;
    void look(const double* state);
    void find_wrenches(double time, bool all_drag, std::size_t begin, std::size_t end);
    void add_springs(std::size_t i, double time, Wrench& on) const;
    void apply_forces(std::size_t i, double span, double* speed) const;
    Vec3 fall_of(const Body& body) const
    {
        return body.inverse_mass > 0 ? rule_.gravity : Vec3(Vec3::Zero());
    }
    void add_momentum(std::size_t i, double span, double* momentum) const;
    bool precesses_evenly(const Body& body) const;
    static int parts_of_turn(const Vec3& turn);
    void drift_turning(std::size_t i, double span, double* state);
    template <class Turn>
    void turn_momentum(std::size_t i, double span, int parts, double* state, Turn turn_by);
    void turn_by(std::size_t i, const Vec3& turn, double* state);

    const RigidRule& rule_;
    RigidFacts facts_;
    bool forced_;  // there is more than gravity
    bool by_springs_ = true;
    std::vector<Body> bodies_;
    std::vector<double> state_;
    std::vector<Moment> moments_;   // [bodies]
    std::vector<Wrench> wrenches_;  // [bodies] about their positions
};

}  // namespace throng
