// Prescribe velocities: what the user wants to move at a given speed does, whatever pushed it.
#include "pipeline/step/stages.hpp"

#include <cmath>

namespace throng {

void prescribe_velocities(const PrescribedVelocities& prescribed,
                          const BodyStates& states,
                          Velocities& velocities)
{
    for (std::size_t i = 0; i < prescribed.body.size(); ++i) {
        const std::uint32_t body = prescribed.body[i];
        if (!states.moves(body)) continue;
        for (int axis = 0; axis < 3; ++axis) {
            const double speed = prescribed.velocity[i][static_cast<std::size_t>(axis)];
            if (!std::isnan(speed)) velocities.linear[body][axis] = speed;
        }
    }
}

}  // namespace throng
