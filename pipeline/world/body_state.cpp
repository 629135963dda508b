// Body state: of many bodies at once, as it is kept or where a program wants it.
#include "throng/body_state.hpp"

#include "kernels/math/numbers.hpp"
#include "kernels/parallel/blocks.hpp"
#include "pipeline/world/world_state.hpp"

#include <cmath>
#include <stdexcept>

namespace throng {

namespace {

constexpr std::size_t kBodies = 1024;  // a block: some 30 microseconds

Quat quaternion_at(const double* from) { return {from[0], from[1], from[2], from[3]}; }

[[noreturn]] void refuse(std::size_t i, BodyId id, const char* wanted)
{
    throw std::invalid_argument("write_state: body " + std::to_string(id.index) + ", number "
                                + std::to_string(i) + " of those given: wanted " + wanted);
}

void check(std::size_t i, BodyId id, const StateColumns<const double>& from)
{
    if (from.position.first != nullptr && !holdable(vector_at(from.position.of(i))))
        refuse(i, id, "a finite position, m");
    if (from.orientation.first != nullptr
        && !(std::abs(quaternion_at(from.orientation.of(i)).norm() - 1) < 1e-6))
        refuse(i, id, "a unit quaternion, w first");
    for (const auto& of : {from.velocity, from.angular_velocity})
        if (of.first != nullptr && !vector_at(of.of(i)).allFinite())
            refuse(i, id, "finite velocities, m/s and rad/s");
}

}  // namespace

StateSpans World::stored_state() const
{
    state_->door.need_no_step("stored_state");
    const auto& poses = state_->get<Poses>();
    const auto& velocities = state_->get<Velocities>();
    const auto& states = state_->get<BodyStates>();
    return {poses.position,
            poses.orientation,
            velocities.linear,
            velocities.angular,
            state_->generation,
            states.awake,
            states.active_bodies.dynamic,
            states.active_bodies.kinematic};
}

void World::read_state(std::span<const BodyId> bodies, const StateColumns<double>& to) const
{
    const WorldState& state = *state_;
    for (const BodyId id : bodies) state.place_of(id, "read_state");
    const auto& poses = state.get<Poses>();
    const auto& velocities = state.get<Velocities>();
    const auto read_some = [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t body = bodies[i].index;
            const Quat& turn = poses.orientation[body];
            if (to.position.first != nullptr)
                put(Vec3(poses.position[body] - turn * state.center[body]), to.position.of(i));
            if (to.orientation.first != nullptr) {
                double* const q = to.orientation.of(i);
                q[0] = turn.w();
                put(turn.vec(), q + 1);
            }
            if (to.velocity.first != nullptr) put(state.velocity(body), to.velocity.of(i));
            if (to.angular_velocity.first != nullptr)
                put(velocities.angular[body], to.angular_velocity.of(i));
        }
    };
    if (bodies.size() <= kBodies) return read_some(0, bodies.size(), 0);
    state_->pool.run([&](std::size_t, std::size_t, std::size_t) {
        for_each_block(bodies.size(), kBodies, read_some);
    });
}

void World::write_state(std::span<const BodyId> bodies, const StateColumns<const double>& from)
{
    const Door::Entry entry(state_->door, "write_state");
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        state_->place_of(bodies[i], "write_state");
        check(i, bodies[i], from);
    }
    const bool moves = from.position.first != nullptr || from.orientation.first != nullptr;
    const bool pushes = from.velocity.first != nullptr || from.angular_velocity.first != nullptr;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const BodyId id = bodies[i];
        if (moves) {
            Pose to = pose(id);
            if (from.position.first != nullptr) to.position = vector_at(from.position.of(i));
            if (from.orientation.first != nullptr)
                to.orientation = quaternion_at(from.orientation.of(i));
            state_->place(id.index, to);
        }
        if (pushes)
            state_->set_velocities(
                id.index,
                from.velocity.first != nullptr ? vector_at(from.velocity.of(i))
                                               : state_->get<Velocities>().linear[id.index],
                from.angular_velocity.first != nullptr ? vector_at(from.angular_velocity.of(i))
                                                       : angular_velocity(id));
    }
}

}  // namespace throng
