// Forces: what acts on bodies besides gravity and contacts, and how orientations are kept.
//
// Every list by body may be shorter than the bodies, or empty: the rest have nothing of the kind.
#pragma once

#include "throng/force_field.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace throng {

/// Holds two points at a distance: stiffness (distance - length) + damping d distance / dt.
struct SpringForce {
    std::uint32_t a = 0, b = 0;                     // bodies; kNoBody: the world
    Vec3 at_a = Vec3::Zero(), at_b = Vec3::Zero();  // m, from the center of mass, body axes
    double stiffness = 0, damping = 0, length = 0;  // N/m, N s/m, m
};

/// Draws every body with mass near by strength / distance^2, m/s2.
struct AttractorForce {
    Vec3 position = Vec3::Zero();
    double strength = 0;  // m3/s2
};

struct Forces {
    std::vector<Vec3> force, torque;  // [bodies] N, N m; constant, world axes; both or none
    std::vector<double> linear_drag, angular_drag;  // [bodies] kg/s, kg m2/s; both or none
    Vec3 wind = Vec3::Zero();                       // m/s, of the air that drag is against
    std::vector<AttractorForce> attractors;
    ForceField field;  // empty: none
    // [bodies] m, body axes: where the center of mass is, seen from the pivot that the body's
    // position is; zero for a body without a pivot.
    std::vector<Vec3> pivot_to_center;
    std::vector<std::uint8_t> has_pivot;  // [bodies] 1: has a pivot

    std::vector<SpringForce> springs;
    std::vector<std::uint32_t> first_spring, spring_of;  // [bodies + 1]; springs of each body
    // Bodies that springs join and that have to be carried on together; each list ascending.
    std::vector<std::vector<std::uint32_t>> groups;
    std::vector<std::uint32_t> group_of;  // [bodies] kNoBody: in none

    /// Whether there is anything but gravity.
    bool any() const
    {
        return !force.empty() || !linear_drag.empty() || !attractors.empty() || field
            || !pivot_to_center.empty() || !springs.empty();
    }
    bool has_springs(std::uint32_t body) const
    {
        return body + std::size_t{1} < first_spring.size()
            && first_spring[body] != first_spring[body + 1];
    }
    bool on_pivot(std::size_t body) const
    {
        return body < has_pivot.size() && has_pivot[body] != 0;
    }
    /// Whether a constant force or torque acts on a body.
    bool push(std::uint32_t body) const
    {
        return body < force.size() && !(force[body].isZero(0) && torque[body].isZero(0));
    }
    /// Whether drag acts on how a body moves or turns.
    bool is_damped(std::uint32_t body) const
    {
        return is_dragged(body) || (body < angular_drag.size() && angular_drag[body] != 0);
    }
    /// Whether something else than drag may turn a body that can turn.
    bool turn(std::uint32_t body) const
    {
        if (field || on_pivot(body) || (body < torque.size() && !torque[body].isZero(0)))
            return true;
        if (body + std::size_t{1} >= first_spring.size()) return false;
        const auto beside_center = [&](std::uint32_t k) {
            const SpringForce& spring = springs[k];
            return !(spring.a == body ? spring.at_a : spring.at_b).isZero(0);
        };
        return std::any_of(spring_of.begin() + first_spring[body],
                           spring_of.begin() + first_spring[body + 1], beside_center);
    }
    /// Whether a body is held by something that may move it from rest at any time.
    bool keeps_awake(std::uint32_t body) const { return field || has_springs(body); }
    /// Whether drag acts on how a body moves; its spin may be dragged by itself.
    bool is_dragged(std::uint32_t body) const
    {
        return body < linear_drag.size() && linear_drag[body] != 0;
    }
    /// Whether the force on a body changes as it goes, whatever turns it.
    bool force_depends_on_state(std::uint32_t body) const
    {
        return field || !attractors.empty() || has_springs(body) || on_pivot(body)
            || is_dragged(body);
    }
    /// Whether what acts on a body changes as it goes: to take it as it was when the step began
    /// would make energy. So would drag, for one that is thrown back within the step.
    bool depends_on_state(std::uint32_t body) const
    {
        return force_depends_on_state(body) || is_damped(body);
    }
    /// Whether anything but gravity acts on a body.
    bool act_on(std::uint32_t body) const { return depends_on_state(body) || push(body); }
    /// From where a body's position is to its center of mass, m, body axes.
    Vec3 pivot_to_center_of(std::uint32_t body) const
    {
        return body < pivot_to_center.size() ? pivot_to_center[body] : Vec3(Vec3::Zero());
    }
};

/// What forces that stay as they are through a step (see Forces::depends_on_state) do to the
/// velocities of bodies that the solver moves.
struct ExternalAcceleration {
    std::vector<Vec3> linear, angular;  // [bodies] m/s2, rad/s2 in world axes; empty: no forces
};

/// What bodies in flight keep from step to step where turning there and back between body axes and
/// world axes would be seen, or an orientation is not held as a quaternion. It counts for as long
/// as pose and velocity are still what it was shown as.
struct FlightMemory {
    std::array<double, 9> orientation = {};  // by the rotation that is chosen
    Vec3 spin = Vec3::Zero();                // rad/s, body axes
    bool is_momentum = false;                // what spin is instead: N m s, world axes
    Quat shown_orientation = Quat(0, 0, 0, 0);
    Vec3 shown_spin = Vec3::Zero();  // world axes
};

/// By body; empty where none is kept.
///
///   lags  n where contacts left a velocity half an n-th of a substep behind, 0 where they were not
///         the last to move a body (see pipeline/forces/velocity_lag.hpp); may be shorter
struct Flights {
    std::vector<FlightMemory> memory;
    std::vector<std::uint8_t> lags;
    bool finer = false;  // some are behind by less than half a substep, or were

    std::uint8_t lags_of(std::size_t body) const { return body < lags.size() ? lags[body] : 0; }
};

}  // namespace throng
