// Quarantine bodies: what turned non-finite stays where it last was finite, and stands still.
#include "pipeline/step/stages.hpp"

#include <algorithm>

namespace throng {

void quarantine_bodies(StepDiagnostics& diagnostics,
                       BodyStates& states,
                       Masses& masses,
                       Velocities& velocities)
{
    std::sort(diagnostics.quarantined.begin(), diagnostics.quarantined.end());
    for (const std::uint32_t body : diagnostics.quarantined) {
        states.quarantined[body] = 1;
        states.kind[body] = BodyKind::static_;
        states.awake[body] = 0;
        masses.inverse_mass[body] = 0;
        masses.inverse_inertia[body] = {};
        velocities.linear[body].setZero();
        velocities.angular[body].setZero();
    }
}

}  // namespace throng
