// Body changes: what a scene states of a body, and a program says otherwise between steps; and what
// pushes a body for once.
#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "kernels/math/rotation.hpp"
#include "narrowphase/ccd/rigid_trajectory.hpp"
#include "pipeline/contacts/fall_asleep.hpp"
#include "pipeline/world/body_mass.hpp"
#include "pipeline/world/force_builder.hpp"
#include "pipeline/world/grown_list.hpp"
#include "pipeline/world/world_state.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/rules/scene_check.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace throng {

namespace {

[[noreturn]] void
refuse(const char* caller, const WorldState& state, std::uint32_t body, const std::string& why)
{
    throw std::invalid_argument(std::string(caller) + ": " + state.called(body) + ": " + why);
}

// Whether a cylinder may be followed as it runs round its rim. Of a needle the digits of float do
// not tell how it turns about its length beside how it tips over, and nothing of it runs far.
bool may_run_round(const Cylinder& cylinder)
{
    constexpr double kThinnest = 1e-2;
    return cylinder.radius >= kThinnest * cylinder.half_length;
}

// What changes of a body as its shapes move about its center of mass, and its frame stays.
void recenter(WorldState& state, std::uint32_t body, const Vec3& center)
{
    const Vec3 moved = center - state.center[body];
    if (moved.isZero(0)) return;
    auto& poses = state.get<Poses>();
    auto& colliders = state.get<Colliders>();
    auto& velocities = state.get<Velocities>();
    const Vec3 arm = poses.orientation[body] * moved;
    poses.position[body] += arm;
    velocities.linear[body] += velocities.angular[body].cross(arm);
    for (std::uint32_t i = 0; i < colliders.count[body]; ++i)
        colliders.local[colliders.begin[body] + i].position -= moved;
    auto& forces = state.get<Forces>();
    for (std::uint32_t k = 0;
         forces.has_springs(body) && k < forces.first_spring[body + 1] - forces.first_spring[body];
         ++k) {
        SpringForce& spring = forces.springs[forces.spring_of[forces.first_spring[body] + k]];
        if (spring.a == body) spring.at_a -= moved;
        if (spring.b == body) spring.at_b -= moved;
    }
    state.center[body] = center;
    state.measure_colliders(body);
}

// What a scene could state. No inertia is one of who never turns.
void need_possible(const WorldState& state,
                   std::uint32_t body,
                   const char* caller,
                   double mass,
                   const Sym3& inertia)
{
    Scene asked;
    BodyDescription& stated = asked.bodies.emplace_back();
    stated.mass = mass;
    stated.lock_rotation = inertia == Sym3{};
    if (!stated.lock_rotation) stated.inertia = inertia;
    if (const std::string trouble = check_scene(asked); !trouble.empty())
        refuse(caller, state, body,
               "wanted a mass and an inertia that a body can have; " + trouble);
}

// Of its shape and material, in its own frame. Throws where it has none.
KeptMass natural_mass(const WorldState& state, std::uint32_t body, const char* caller)
{
    const auto& colliders = state.get<Colliders>();
    std::vector<PlacedMass> parts;
    for (std::uint32_t i = 0; i < colliders.count[body]; ++i) {
        const std::uint32_t at = colliders.begin[body] + i;
        const ShapeKind kind = colliders.shape[at].kind;
        if (kind == ShapeKind::plane || kind == ShapeKind::mesh)
            refuse(caller, state, body,
                   kind == ShapeKind::plane
                       ? "wanted static or kinematic for a plane"
                       : "wanted static or kinematic for triangles; add a dynamic body with the "
                         "mesh, which is made into what may move");
        Pose pose = colliders.local[at];
        pose.position += state.center[body];
        parts.push_back({mass_of(state.get<Shapes>(), colliders.shape[at]), pose});
    }
    if (parts.empty())
        refuse(caller, state, body,
               "wanted a mass for a body without a shape; give set_mass() one, and an inertia");
    const MassProperties whole = combine(parts);
    const double density = state.material_density[colliders.material[colliders.begin[body]]];
    KeptMass kept;
    kept.mass = density * whole.volume;
    kept.inertia = scaled(whole.inertia, density);
    kept.center = whole.center;
    need_possible(state, body, caller, kept.mass, kept.inertia);
    return kept;
}

bool locks_position(const WorldState& state, std::uint32_t body)
{
    return state.get<Masses>().inverse_mass[body] == 0;
}
bool locks_rotation(const WorldState& state, std::uint32_t body)
{
    return state.get<Masses>().inverse_inertia[body] == Sym3{};
}

void give(WorldState& state, std::uint32_t body, const KeptMass& kept)
{
    give_mass(body, kept.mass, kept.inertia, kept.lock_position, kept.lock_rotation,
              state.settings.precision == Precision::double_, state.get<Masses>());
    auto& velocities = state.get<Velocities>();
    if (kept.lock_position) velocities.linear[body].setZero();
    if (kept.lock_rotation || kept.inertia == Sym3{}) velocities.angular[body].setZero();
}

// Moments about the center, of ones about the pivot.
Sym3 about_center(const WorldState& state, std::uint32_t body)
{
    const auto& masses = state.get<Masses>();
    const Vec3 off = state.get<Forces>().pivot_to_center_of(body);
    return shifted(masses.inertia[body], -masses.mass[body], off);
}

KeptMass mass_now(const WorldState& state, std::uint32_t body)
{
    return {state.get<Masses>().mass[body], about_center(state, body), state.center[body],
            locks_position(state, body), locks_rotation(state, body)};
}

BodyFilter filter_of(const WorldState& state, std::uint32_t body)
{
    if (const auto sensor = state.sensors.find(body); sensor != state.sensors.end())
        return sensor->second;
    const auto& colliders = state.get<Colliders>();
    const auto& filter = state.get<PairFilter>();
    const std::uint32_t first = colliders.begin[body];
    return colliders.count[body] == 0 ? BodyFilter{0, 0}
                                      : BodyFilter{filter.group[first], filter.mask[first]};
}

std::uint32_t dynamic_at(const WorldState& state, BodyId id, const char* caller)
{
    const std::uint32_t body = state.place_of(id, caller);
    if (!state.get<BodyStates>().dynamic(body))
        refuse(caller, state, body, "wanted a dynamic body; nothing pushes what is not");
    return body;
}

void need_finite(const Vec3& v, const char* caller, const char* unit)
{
    if (!v.allFinite())
        throw std::invalid_argument(std::string(caller) + ": give finite numbers, " + unit);
}

void set_constant_force(WorldState& state,
                        std::uint32_t body,
                        const Vec3& force,
                        const Vec3& torque)
{
    auto& forces = state.get<Forces>();
    for (auto* const list : {&forces.force, &forces.torque})
        if (list->size() <= body) list->resize(body + std::size_t{1}, Vec3(Vec3::Zero()));
    forces.force[body] = force;
    forces.torque[body] = torque;
}

AppliedForces& applied_to(WorldState& state, std::uint32_t body)
{
    const Forces& forces = state.get<Forces>();
    AppliedForces stated;
    if (body < forces.force.size()) {
        stated.force = forces.force[body];
        stated.torque = forces.torque[body];
    }
    return state.applied_forces.try_emplace(body, stated).first->second;
}

void push(WorldState& state, std::uint32_t body, const Vec3& force, const Vec3& torque)
{
    AppliedForces& applied = applied_to(state, body);
    if (!applied.pushed) state.pushed.push_back(body);
    applied.pushed = true;
    applied.pushed_by += force;
    applied.turned_by += torque;
    state.sum_forces(body);
    state.wake_beside(body);
    state.changed.push_back(body);
}

Vec3 inverse_inertia_times(const WorldState& state, std::uint32_t body, const Vec3& v)
{
    return in_world_axes(state.get<Masses>().inverse_inertia[body],
                         state.get<Poses>().orientation[body])
               .matrix()
        * v;
}

}  // namespace

void WorldState::begin_change(std::uint32_t body)
{
    follow_changes();
    get<EffectCensus>().forget(body, effect_facts().bodies);
    changed.push_back(body);
    effects_stale = true;
    disturb(body, false);
    wake(body);
}

void WorldState::set_filter(std::uint32_t body, const BodyFilter& to)
{
    const auto& colliders = get<Colliders>();
    auto& filter = get<PairFilter>();
    for (std::uint32_t i = 0; i < colliders.count[body]; ++i) {
        filter.group[colliders.begin[body] + i] = to.group;
        filter.mask[colliders.begin[body] + i] = to.mask;
    }
}

void WorldState::make_sensor(std::uint32_t body)
{
    sensors[body] = filter_of(*this, body);
    set_filter(body, {0, 0});
}

void WorldState::measure_colliders(std::uint32_t body)
{
    auto& colliders = get<Colliders>();
    const auto& shapes = get<Shapes>();
    const std::uint32_t count = colliders.count[body];
    double radius = 0;
    std::uint8_t bits = count > 1 ? Colliders::kMayHang : 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t at = colliders.begin[body] + i;
        const ShapeRef part = colliders.shape[at];
        const Vec3& local = colliders.local[at].position;
        const double outer = local.norm() + outer_radius(shapes, part);
        // By what is not convex, or round about another point.
        if (part.kind == ShapeKind::solid || !local.isZero(0)) bits |= Colliders::kMayHang;
        if (part.kind == ShapeKind::cylinder && count == 1 && local.isZero(0)
            && may_run_round(shapes.cylinders[part.index]))
            bits |= Colliders::kRim;
        if (part.kind == ShapeKind::box || part.kind == ShapeKind::hull) bits |= Colliders::kFlat;
        if (part.kind == ShapeKind::capsule || part.kind == ShapeKind::cylinder)
            bits |= Colliders::kRound;
        if (part.kind != ShapeKind::sphere || !local.isZero(0)) bits |= Colliders::kOffCenter;
        colliders.outer_radius[at] = outer;
        if (std::isfinite(outer)) radius = std::max(radius, outer);
    }
    colliders.shape_bits[body] = bits;
    get<BodyStates>().radius[body] = radius;
}

void WorldState::sum_forces(std::uint32_t body)
{
    const auto found = applied_forces.find(body);
    if (found == applied_forces.end()) return;
    const AppliedForces& applied = found->second;
    const double mass = get<Masses>().mass[body];  // 0 of who does not fall
    const Vec3 weight = (applied.gravity_scale - 1) * mass * get<StepContext>().gravity;
    set_constant_force(*this, body, applied.force + weight + applied.pushed_by,
                       applied.torque + applied.turned_by);
}

void WorldState::end_pushes()
{
    for (const std::uint32_t body : pushed) {
        const auto found = applied_forces.find(body);
        if (found == applied_forces.end() || !found->second.pushed) continue;
        AppliedForces& applied = found->second;
        applied.pushed_by = applied.turned_by = Vec3::Zero();
        applied.pushed = false;
        sum_forces(body);
        if (applied.gravity_scale == 1) applied_forces.erase(found);
        changed.push_back(body);
    }
    pushed.clear();
}

void WorldState::drive(std::uint32_t body, const std::array<std::optional<double>, 3>& velocity)
{
    auto& prescribed = get<PrescribedVelocities>();
    prescribed.erase(body);
    const double free = std::nan("");
    if (velocity[0] || velocity[1] || velocity[2])
        prescribed.put(
            body,
            {velocity[0].value_or(free), velocity[1].value_or(free), velocity[2].value_or(free)});
    drive_surface(body);
}

void WorldState::drive_surface(std::uint32_t body)
{
    auto& states = get<BodyStates>();
    Vec3 surface = Vec3::Zero();
    if (const auto* const driven = get<PrescribedVelocities>().of(body))
        for (int k = 0; k < 3; ++k)
            if (const double speed = (*driven)[static_cast<std::size_t>(k)]; !std::isnan(speed))
                surface[k] = speed;
    const bool still = states.kind[body] == BodyKind::static_;
    const bool carries = still && !surface.isZero(0);
    put(states.is_conveyor, body, std::uint8_t{carries});
    states.conveyors = states.conveyors || carries;
    if (still) get<Velocities>().linear[body] = surface;
}

void World::set_motion(BodyId body, Motion motion)
{
    const Door::Entry entry(state_->door, "set_motion");
    WorldState& state = *state_;
    const std::uint32_t at = state.place_of(body, "set_motion");
    const Motion before = state.motion[at];
    if (motion == before) return;
    if (motion != Motion::static_ && motion != Motion::kinematic && motion != Motion::dynamic)
        refuse("set_motion", state, at, "wanted static_, kinematic or dynamic");
    if (state.get<Forces>().on_pivot(at))
        refuse("set_motion", state, at, "wanted a body that is on no pivot");
    auto& states = state.get<BodyStates>();
    KeptMass next;
    if (motion == Motion::dynamic) {
        const auto kept = state.kept_masses.find(at);
        next =
            kept != state.kept_masses.end() ? kept->second : natural_mass(state, at, "set_motion");
    }
    // To the broad phase and to whoever touches it, it is somebody else from now on.
    state.begin_change(at);
    state.disturb(at, true);
    auto& velocities = state.get<Velocities>();
    if (before == Motion::dynamic) {
        state.kept_masses[at] = mass_now(state, at);
        give_no_mass(at, state.get<Masses>());
        recenter(state, at, Vec3::Zero());
    }
    if (motion == Motion::static_) velocities.angular[at].setZero();
    if (states.carries(at)) velocities.linear[at].setZero();
    states.kind[at] = motion == Motion::static_ ? BodyKind::static_
        : motion == Motion::kinematic           ? BodyKind::kinematic
                                                : BodyKind::dynamic;
    states.awake[at] = motion != Motion::static_ && states.quarantined[at] == 0 ? 1 : 0;
    states.sleep_time[at] = 0;
    state.motion[at] = motion;
    state.drive_surface(at);
    if (motion == Motion::dynamic) {
        recenter(state, at, next.center);
        give(state, at, next);
        state.kept_masses.erase(at);
        state.woken.push_back(at);
    }
    if (motion == Motion::kinematic || before == Motion::kinematic)
        state.active_bodies_stale = true;
    state.active_bodies_stopped = true;
    state.mark_changed(at);
    state.sum_forces(at);
    if (state.get<Forces>().has_springs(at)) {
        sort_springs(states, state.get<Forces>());
        state.census_stale = true;
        state.warn_of_substeps();
    }
}

void World::set_mass(BodyId body, double mass, const std::optional<Sym3>& inertia)
{
    const Door::Entry entry(state_->door, "set_mass");
    WorldState& state = *state_;
    const std::uint32_t at = state.place_of(body, "set_mass");
    const bool dynamic = state.get<BodyStates>().dynamic(at);
    KeptMass kept;
    if (dynamic)
        kept = mass_now(state, at);
    else if (const auto found = state.kept_masses.find(at); found != state.kept_masses.end())
        kept = found->second;
    else if (!inertia)
        kept = natural_mass(state, at, "set_mass");
    kept.inertia = inertia ? *inertia : scaled(kept.inertia, mass / kept.mass);
    if (inertia && *inertia == Sym3{})
        refuse("set_mass", state, at, "wanted moments above 0 kg m2");
    need_possible(state, at, "set_mass", mass, kept.inertia);
    kept.mass = mass;
    if (!dynamic) {
        state.kept_masses[at] = kept;
        return;
    }
    const bool turns = !locks_rotation(state, at);
    state.begin_change(at);
    const Vec3 off = state.get<Forces>().pivot_to_center_of(at);
    kept.inertia = shifted(kept.inertia, mass, off);
    kept.lock_rotation = !turns;
    give(state, at, kept);
    state.mark_changed(at);
    state.sum_forces(at);
    state.warn_of_substeps();
}

Sym3 World::inertia(BodyId body) const
{
    const std::uint32_t at = state_->place_of(body, "inertia");
    return state_->get<BodyStates>().dynamic(at) ? about_center(*state_, at) : Sym3{};
}

void World::set_locks(BodyId body, bool position, bool rotation)
{
    const Door::Entry entry(state_->door, "set_locks");
    WorldState& state = *state_;
    const std::uint32_t at = state.place_of(body, "set_locks");
    if (!state.get<BodyStates>().dynamic(at)) {
        if (const auto found = state.kept_masses.find(at); found != state.kept_masses.end()) {
            found->second.lock_position = position;
            found->second.lock_rotation = rotation;
            return;
        }
        refuse("set_locks", state, at, "wanted a dynamic body, or one that was");
    }
    const bool pivot = state.get<Forces>().on_pivot(at);
    if (pivot && position) refuse("set_locks", state, at, "wanted a body that is on no pivot");
    const Masses& masses = state.get<Masses>();
    if (!rotation && masses.inertia[at] == Sym3{})
        refuse("set_locks", state, at,
               "wanted an inertia for a body that is to turn; give "
               "set_mass() one");
    state.begin_change(at);
    give(state, at,
         {masses.mass[at], masses.inertia[at], state.center[at], position || pivot, rotation});
    state.mark_changed(at);
}

void World::set_filter(BodyId body, std::uint32_t group, std::uint32_t mask)
{
    const Door::Entry entry(state_->door, "set_filter");
    WorldState& state = *state_;
    const std::uint32_t at = state.place_of(body, "set_filter");
    if (const auto sensor = state.sensors.find(at); sensor != state.sensors.end()) {
        sensor->second = {group, mask};
        state.changed.push_back(at);
        return;
    }
    state.begin_change(at);
    state.set_filter(at, {group, mask});
    state.mark_changed(at);
}

std::uint32_t World::group(BodyId body) const
{
    const std::uint32_t at = state_->place_of(body, "group");
    return filter_of(*state_, at).group;
}

std::uint32_t World::mask(BodyId body) const
{
    const std::uint32_t at = state_->place_of(body, "mask");
    return filter_of(*state_, at).mask;
}

void World::set_drive_velocity(BodyId body, const std::array<std::optional<double>, 3>& velocity)
{
    const Door::Entry entry(state_->door, "set_drive_velocity");
    WorldState& state = *state_;
    const std::uint32_t at = state.place_of(body, "set_drive_velocity");
    for (const auto& component : velocity)
        if (component && !(std::abs(*component) <= kGreatestLength))
            refuse("set_drive_velocity", state, at, "wanted a velocity in m/s");
    state.begin_change(at);
    state.drive(at, velocity);
    // Whoever drives it anew wants those that lie on it to feel it.
    state.mark_changed(at);
}

void World::set_fast(BodyId body, bool fast)
{
    const Door::Entry entry(state_->door, "set_fast");
    WorldState& state = *state_;
    const std::uint32_t at = state.place_of(body, "set_fast");
    auto& states = state.get<BodyStates>();
    put(states.fast, at, std::uint8_t{fast && states.kind[at] != BodyKind::static_});
    state.wake(at);
    if (fast) {
        state.requests.ask(Effect::fast_motion, state.called(at));
        state.effects_stale = true;
    }
}

void World::set_force(BodyId body, const Vec3& force, const Vec3& torque)
{
    const Door::Entry entry(state_->door, "set_force");
    WorldState& state = *state_;
    const std::uint32_t at = dynamic_at(state, body, "set_force");
    need_finite(force, "set_force", "N");
    need_finite(torque, "set_force", "N m");
    state.wake_beside(at);
    set_constant_force(state, at, force, torque);
    if (const auto found = state.applied_forces.find(at); found != state.applied_forces.end()) {
        found->second.force = force;
        found->second.torque = torque;
        state.sum_forces(at);
    }
    state.changed.push_back(at);
}

void World::set_gravity_scale(BodyId body, double scale)
{
    const Door::Entry entry(state_->door, "set_gravity_scale");
    WorldState& state = *state_;
    const std::uint32_t at = state.place_of(body, "set_gravity_scale");
    if (!(std::abs(scale) <= kGreatestNumber))
        refuse("set_gravity_scale", state, at, "wanted a finite factor");
    state.wake_beside(at);
    AppliedForces& applied = applied_to(state, at);
    applied.gravity_scale = scale;
    state.sum_forces(at);
    if (scale == 1 && !applied.pushed) state.applied_forces.erase(at);
    state.changed.push_back(at);
}

double World::gravity_scale(BodyId body) const
{
    const std::uint32_t at = state_->place_of(body, "gravity_scale");
    const auto applied = state_->applied_forces.find(at);
    return applied == state_->applied_forces.end() ? 1 : applied->second.gravity_scale;
}

void World::set_user_data(BodyId body, std::uint64_t data)
{
    const Door::Entry entry(state_->door, "set_user_data");
    put(state_->user_data, state_->place_of(body, "set_user_data"), data);
}

std::uint64_t World::user_data(BodyId body) const
{
    const std::uint32_t at = state_->place_of(body, "user_data");
    return at < state_->user_data.size() ? state_->user_data[at] : 0;
}

void World::add_impulse(BodyId body, const Vec3& impulse)
{
    const Door::Entry entry(state_->door, "add_impulse");
    WorldState& state = *state_;
    const std::uint32_t at = dynamic_at(state, body, "add_impulse");
    need_finite(impulse, "add_impulse", "N s");
    const auto& velocities = state.get<Velocities>();
    Vec3 angular = velocities.angular[at];
    // What hangs on a pivot, about which its inertia is, turns by what reaches its center of mass.
    if (const Vec3 arm = state.arm(at); !arm.isZero(0))
        angular += inverse_inertia_times(state, at, arm.cross(impulse));
    state.set_velocities(at, velocities.linear[at] + impulse * state.get<Masses>().inverse_mass[at],
                         angular);
}

void World::add_impulse(BodyId body, const Vec3& impulse, const Vec3& point)
{
    const Door::Entry entry(state_->door, "add_impulse");
    WorldState& state = *state_;
    const std::uint32_t at = dynamic_at(state, body, "add_impulse");
    need_finite(impulse, "add_impulse", "N s");
    need_finite(point, "add_impulse", "m");
    const auto& velocities = state.get<Velocities>();
    const Vec3 arm = point - state.get<Poses>().position[at];
    state.set_velocities(at, velocities.linear[at] + impulse * state.get<Masses>().inverse_mass[at],
                         velocities.angular[at]
                             + inverse_inertia_times(state, at, arm.cross(impulse)));
}

void World::add_angular_impulse(BodyId body, const Vec3& impulse)
{
    const Door::Entry entry(state_->door, "add_angular_impulse");
    WorldState& state = *state_;
    const std::uint32_t at = dynamic_at(state, body, "add_angular_impulse");
    need_finite(impulse, "add_angular_impulse", "N m s");
    const auto& velocities = state.get<Velocities>();
    state.set_velocities(at, velocities.linear[at],
                         velocities.angular[at] + inverse_inertia_times(state, at, impulse));
}

void World::add_force(BodyId body, const Vec3& force)
{
    const Door::Entry entry(state_->door, "add_force");
    const std::uint32_t at = dynamic_at(*state_, body, "add_force");
    need_finite(force, "add_force", "N");
    push(*state_, at, force, Vec3::Zero());
}

void World::add_force(BodyId body, const Vec3& force, const Vec3& point)
{
    const Door::Entry entry(state_->door, "add_force");
    const std::uint32_t at = dynamic_at(*state_, body, "add_force");
    need_finite(force, "add_force", "N");
    need_finite(point, "add_force", "m");
    push(*state_, at, force, Vec3(point - state_->center_of_mass(at)).cross(force));
}

void World::add_torque(BodyId body, const Vec3& torque)
{
    const Door::Entry entry(state_->door, "add_torque");
    const std::uint32_t at = dynamic_at(*state_, body, "add_torque");
    need_finite(torque, "add_torque", "N m");
    push(*state_, at, Vec3::Zero(), torque);
}

void World::move_to(BodyId body, const Pose& pose, double seconds)
{
    const Door::Entry entry(state_->door, "move_to");
    WorldState& state = *state_;
    const std::uint32_t at = state.place_of(body, "move_to");
    if (state.get<BodyStates>().kind[at] != BodyKind::kinematic)
        refuse("move_to", state, at, "wanted a kinematic body; set_pose() puts any where it is");
    const double length = std::sqrt(pose.orientation.squaredNorm());
    if (!holdable(pose.position) || !(std::abs(length - 1) < 1e-6))
        refuse("move_to", state, at, "wanted a finite position and a unit quaternion");
    if (!(seconds > 0) || !std::isfinite(seconds))
        refuse("move_to", state, at, "wanted a time above 0 s");
    const Quat to(pose.orientation.coeffs() / length);
    const Vec3 place = to * state.center[at] + pose.position;
    const RigidTrajectory way =
        trajectory_between(state.get<Poses>().at(at), {place, to}, Vec3::Zero());
    state.set_velocities(at, way.shift / seconds, way.turn / seconds);
}

void World::wake(BodyId body)
{
    const Door::Entry entry(state_->door, "wake");
    const std::uint32_t at = state_->place_of(body, "wake");
    if (state_->get<BodyStates>().dynamic(at)) state_->wake_beside(at);
}

void World::sleep(BodyId body)
{
    const Door::Entry entry(state_->door, "sleep");
    WorldState& state = *state_;
    const std::uint32_t at = dynamic_at(state, body, "sleep");
    auto& states = state.get<BodyStates>();
    if (!state.settings.sleep && !rests_by_force(state.settings))
        refuse("sleep", state, at, "wanted the setting sleep=on: nobody may sleep");
    if (!states.moves(at)) return;
    auto& velocities = state.get<Velocities>();
    std::vector<std::uint32_t> together = {at};
    const auto& islands = state.get<Islands>();
    for (std::size_t island = 0; island < islands.size(); ++island) {
        const auto bodies = islands.bodies_of(island);
        if (!std::binary_search(bodies.begin(), bodies.end(), at)) continue;
        together.assign(bodies.begin(), bodies.end());
        std::erase_if(together, [&](std::uint32_t one) { return !states.movable(one); });
        break;
    }
    if (rests_by_force(state.settings)) {
        for (const std::uint32_t one : together) {
            velocities.linear[one].setZero();
            velocities.angular[one].setZero();
            states.sleep_time[one] = state.get<SleepParameters>().time;
            state.changed.push_back(one);
        }
        return;
    }
    auto& events = state.get<SleepEvents>();
    fall_asleep(together, states, state.get<SleepingIslands>(), velocities, events);
    keep_each_once(events.fell_asleep);
    std::erase_if(state.woken, [&](std::uint32_t one) { return !states.moves(one); });
    for (const std::uint32_t one : together) {
        state.get<OverloadedIslands>().forget(one);
        state.note_moved(one);
        state.changed.push_back(one);
    }
    state.active_bodies_stopped = true;
}

}  // namespace throng
