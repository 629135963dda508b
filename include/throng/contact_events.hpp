// Contact events: who touches whom, with what force, and since when.
#pragma once

#include "throng/body_id.hpp"
#include "throng/math.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace throng {

/// Two bodies of which parts touch. Parts count from 0 in the order of a compound's; of any other
/// shape there is one, but for meshes that move, which may be taken by several hulls.
struct TouchingParts {
    BodyId a, b;
    std::uint32_t part_a = 0, part_b = 0;
    bool operator==(const TouchingParts&) const = default;
};

/// A point where two bodies touch, or may before the next step.
///
///   position    m, on the surface of a
///   separation  m, along the normal as the step began; below 0 where they overlapped
///   impulse     N s, along the normal over the last substep
struct ContactPoint {
    Vec3 position = Vec3::Zero();
    double separation = 0;
    double impulse = 0;
};

/// A contact of the last step: up to four points with one normal. A pair of parts has one, but for
/// meshes and level sets, which have one a triangle or patch.
///
///   normal  unit, from a to b
///   force   N on b over the last substep, friction included, and all impacts of the step as if
///           they had been in it: those of a body add up to World::contact_force()
struct ContactReport : TouchingParts {
    Vec3 normal = Vec3::UnitZ();
    Vec3 force = Vec3::Zero();
    int count = 0;  // of the points
    std::array<ContactPoint, 4> points;

    std::span<const ContactPoint> used() const
    {
        return std::span(points).first(static_cast<std::size_t>(count));
    }
};

/// What a program wants to be told of, from the next step on.
///
///   touches    who begins and who ceases to touch
///   hit_speed  m/s, above 0: hits at this speed or faster; infinite for none
///   sensors    who comes into a sensor and who leaves it, however fast
struct Listening {
    bool touches = false;
    double hit_speed = std::numeric_limits<double>::infinity();
    bool sensors = false;
};

/// That two parts begin or cease to touch. Parts touch in a step when a contact of theirs overlaps
/// as it begins, or bears anything at its end, or throws them apart.
struct TouchEvent : TouchingParts {
    std::uint64_t step = 0;  // as StepReport::step counts them
};

/// That two parts met.
///
///   point   m, where they met fastest, on the surface of a
///   normal  unit, from a to b
///   speed   m/s along it, as the step began
struct HitEvent : TouchEvent {
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::UnitZ();
    double speed = 0;
};

/// Of all steps of the last call of World::step(), in order of step, then of parts; the same for
/// any number of threads. Every begin has its end: who is removed ceases to touch in the next step,
/// and whoever falls asleep goes on touching.
///
///   sensed, left  who came to overlap a sensor, which is a, and who no longer does. Who went
///                 through one within a step is told of in both. Neither tells of other sensors,
///                 nor of what is static where the sensor is
struct Events {
    std::vector<TouchEvent> begun, ended;
    std::vector<HitEvent> hits;
    std::vector<TouchEvent> sensed, left;
};

}  // namespace throng
