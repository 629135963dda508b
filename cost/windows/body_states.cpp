#include "cost/windows/body_states.hpp"

#include <algorithm>

namespace throng {

BodyStates states_of(const World& world)
{
    BodyStates states;
    for (const BodyId body : world.bodies()) {
        if (world.motion(body) == Motion::static_) continue;
        states.push_back({body, world.motion(body) == Motion::dynamic && !world.quarantined(body),
                          world.pose(body), world.center_of_mass(body), world.velocity(body),
                          world.angular_velocity(body)});
    }
    return states;
}

void put_states(World& world, const BodyStates& states)
{
    for (const BodyState& state : states) {
        world.set_pose(state.body, state.pose);
        world.set_velocity(state.body, state.velocity, state.spin);
    }
}

bool all_finite(const BodyStates& states)
{
    return std::all_of(states.begin(), states.end(), [](const BodyState& state) {
        return state.center.allFinite() && state.pose.orientation.coeffs().allFinite()
            && state.velocity.allFinite() && state.spin.allFinite();
    });
}

}  // namespace throng
