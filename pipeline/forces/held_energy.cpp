#include "pipeline/forces/held_energy.hpp"

#include "kernels/dynamics/energy.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

// m/s2, of the wind where it drives the body on: what it brakes is lost.
Vec3 HeldEnergy::wind_on(std::uint32_t body) const
{
    if (body >= forces_.linear_drag.size()) return Vec3::Zero();
    const Vec3& velocity = velocities_.linear[body];
    const Vec3 past = forces_.wind - velocity;
    if (!(past.dot(velocity) > 0)) return Vec3::Zero();
    return masses_.inverse_mass[body] * forces_.linear_drag[body] * past;
}

// m/s2, of what pulls alike all along its way: gravity, wind and what pushes it.
Vec3 HeldEnergy::acceleration_of(std::uint32_t body) const
{
    Vec3 pull = context_.gravity + wind_on(body);
    if (body < forces_.force.size()) pull += masses_.inverse_mass[body] * forces_.force[body];
    return pull;
}

// Who is kept from the rest of its way has not fallen down it: what its pull gave it for that
// goes, also where it has been thrown back by the end of it, and what it took comes back. Else
// who is held high bounces higher than it fell.
void HeldEnergy::take_back_fall(std::uint32_t body, const Vec3& held)
{
    const Vec3 pulled = acceleration_of(body);
    const double pull = pulled.norm();
    if (!(pull > 0) || !states_.dynamic(body)) return;
    const Vec3 down = pulled / pull;
    Vec3& velocity = velocities_.linear[body];
    const double falling = down.dot(velocity);
    const double gained = 2 * pulled.dot(held - poses_.position[body]);
    if (!(gained < 0 || falling < 0)) return;
    const double left = falling * falling + gained;
    velocity += (std::copysign(std::sqrt(std::max(0.0, left)), falling) - falling) * down;
    // What it has not got along its pull goes from the rest of its motion.
    if (left < 0 && masses_.inverse_mass[body] > 0)
        take_back_energy(body, -0.5 * masses_.mass[body] * left);
}

// J, of what pulls at the middle of one that goes round a pivot.
double HeldEnergy::hanging_energy_of(std::uint32_t body) const
{
    if (!forces_.on_pivot(body)) return 0;
    const Vec3 middle = poses_.at(body) * forces_.pivot_to_center_of(body);
    return attraction_of(forces_, masses_, poses_, body, context_.substep())
        - masses_.mass[body] * context_.gravity.dot(middle);
}

// Nor has its weight turned it down that way about a pivot. One that has not so much gives what
// it has: what pressed it in has stopped it, and it is held all the same.
void HeldEnergy::take_back_swing(std::uint32_t body, double gained)
{
    if (!take_back_energy(body, std::max(0.0, gained))) velocities_.angular[body] *= 0;
}

// J, of what attractors have given up for one that is on no pivot.
double HeldEnergy::attraction_energy_of(std::uint32_t body) const
{
    if (forces_.attractors.empty() || forces_.on_pivot(body)) return 0;
    return attraction_of(forces_, masses_, poses_, body, context_.substep());
}

// J, of its motion; below 0 it is given. False for one that has not so much, which keeps it.
bool HeldEnergy::take_back_energy(std::uint32_t body, double gained)
{
    if (gained == 0) return true;
    const double had = kinetic_energy_of(body, masses_, poses_, velocities_);
    if (had < gained) return false;
    if (!(had > 0)) return true;
    const double kept = std::sqrt(1 - gained / had);
    velocities_.linear[body] *= kept;
    velocities_.angular[body] *= kept;
    return true;
}

// Of a body that is on springs.
HeldEnergy::Joined HeldEnergy::joined_to(std::uint32_t body) const
{
    Joined joined;
    Vec3 momentum = Vec3::Zero();
    const std::uint32_t end = forces_.first_spring[body + 1];
    for (std::uint32_t k = forces_.first_spring[body]; k < end; ++k) {
        const SpringForce& spring = forces_.springs[forces_.spring_of[k]];
        const std::uint32_t other = spring.a == body ? spring.b : spring.a;
        if (other == kNoBody) return {};
        if (!states_.dynamic(other) || !(masses_.inverse_mass[other] > 0))
            return {{}, 0, velocities_.linear[other]};
        if (std::find(joined.bodies.begin(), joined.bodies.end(), other) != joined.bodies.end())
            continue;
        joined.bodies.push_back(other);
        joined.mass += masses_.mass[other];
        momentum += masses_.mass[other] * velocities_.linear[other];
    }
    joined.velocity = momentum / joined.mass;
    return joined;
}

// J, that its springs were drawn by: from how it moves beside those that they join it to, who keep
// the momentum. Who fly together are held by one another alone, however fast all of them are.
bool HeldEnergy::take_back_drawn(std::uint32_t body, double drawn)
{
    if (!(drawn > 0)) return true;
    const Joined joined = joined_to(body);
    const bool only_turns = !(masses_.inverse_mass[body] > 0);
    const bool all_yield = !joined.bodies.empty() && !only_turns;
    const double share = all_yield ? joined.mass / (joined.mass + masses_.mass[body]) : 1;
    Vec3& velocity = velocities_.linear[body];
    const Vec3 beside = only_turns ? velocity : Vec3(velocity - joined.velocity);
    const double all = kinetic_energy_of(body, masses_, poses_, velocities_),
                 of_middle = masses_.mass[body] * velocity.squaredNorm() / 2,
                 had = all - of_middle + share * masses_.mass[body] * beside.squaredNorm() / 2;
    if (!(had >= drawn)) return false;
    const double kept = std::sqrt(1 - drawn / had);
    velocity -= share * (1 - kept) * beside;
    velocities_.angular[body] *= kept;
    if (!all_yield) return true;
    for (const std::uint32_t other : joined.bodies)
        velocities_.linear[other] += (1 - share) * (1 - kept) * beside;
    return true;
}

// What does not turn as far as it would have keeps the spin that it has in its own axes: its
// inertia is in these.
void HeldEnergy::turn_back(std::uint32_t body, const Quat& held)
{
    Quat& orientation = poses_.orientation[body];
    if (masses_.gyroscopic_kind[body] != 0 && context_.gyroscopic != Gyroscopic::off) {
        Vec3& spin = velocities_.angular[body];
        spin = held * (orientation.conjugate() * spin);
    }
    orientation = held;
}

bool HeldEnergy::hold(std::uint32_t body, const Pose& end, const Vec3& fell_to)
{
    const Pose went = poses_.at(body);
    const Vec3 velocity = velocities_.linear[body], spin = velocities_.angular[body];
    const double before = springs_energy_of(body, forces_, poses_);
    const double attracted = attraction_energy_of(body);
    const double hung = hanging_energy_of(body);
    take_back_fall(body, fell_to);
    poses_.position[body] = end.position;
    turn_back(body, end.orientation.normalized());
    take_back_swing(body, hanging_energy_of(body) - hung);
    // Nor have its springs drawn it down that way: what they hold the more for it goes. And
    // attractors have given up another amount. One that has not so much is left to contacts.
    const double given_up = attraction_energy_of(body) - attracted;
    const double drawn = springs_energy_of(body, forces_, poses_) - before;
    if (take_back_energy(body, given_up) && take_back_drawn(body, drawn)) return true;
    poses_.position[body] = went.position;
    poses_.orientation[body] = went.orientation;
    velocities_.linear[body] = velocity;
    velocities_.angular[body] = spin;
    return false;
}

}  // namespace throng
