// Held energy: what a body may not keep that is held before the end of its way.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/forces.hpp"
#include "pipeline/step/step_context.hpp"

#include <vector>

namespace throng {

/// Puts bodies back that were held on their way, and takes from their velocities, and of those that
/// springs join them to, what forces gave them for the rest of it. Else who is held high has what
/// it fell down as well.
class HeldEnergy {
public:
    HeldEnergy(const StepContext& context,
               const Forces& forces,
               const Masses& masses,
               const BodyStates& states,
               Poses& poses,
               Velocities& velocities)
        : context_(context), forces_(forces), masses_(masses), states_(states), poses_(poses),
          velocities_(velocities)
    { }

    /// Puts a body where it is held. False where it has not so much energy as would have to go: it
    /// stays as it was, where it went.
    ///
    ///   fell_to  up to where its pull moved it, m
    bool hold(std::uint32_t body, const Pose& end, const Vec3& fell_to);

private:
    // Whom springs join a body to, their mass, kg, and the velocity of their center of mass, m/s.
    // Nobody where one of them does not yield, whose velocity it is then.
    struct Joined {
        std::vector<std::uint32_t> bodies;
        double mass = 0;
        Vec3 velocity = Vec3::Zero();
    };
    Vec3 wind_on(std::uint32_t body) const;
    Vec3 acceleration_of(std::uint32_t body) const;
    void take_back_fall(std::uint32_t body, const Vec3& held);
    double hanging_energy_of(std::uint32_t body) const;
    void take_back_swing(std::uint32_t body, double gained);
    double attraction_energy_of(std::uint32_t body) const;
    bool take_back_energy(std::uint32_t body, double gained);
    Joined joined_to(std::uint32_t body) const;
    bool take_back_drawn(std::uint32_t body, double drawn);
    void turn_back(std::uint32_t body, const Quat& held);

    const StepContext& context_;
    const Forces& forces_;
    const Masses& masses_;
    const BodyStates& states_;
    Poses& poses_;
    Velocities& velocities_;
};

}  // namespace throng
