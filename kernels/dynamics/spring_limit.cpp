#include "kernels/dynamics/spring_limit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

// How easily a body gives way at a point of it, in whatever direction is easiest, 1/kg: at most the
// sum of what turning makes of it in all. About the arm itself nothing turns the point.
double inverse_mass_at(const Masses& masses, std::uint32_t body, const Vec3& lever_arm)
{
    const Sym3& turning = masses.inverse_inertia[body];
    const double all = (turning.xx + turning.yy + turning.zz) * lever_arm.squaredNorm();
    const double about = lever_arm.dot(Vec3(turning.matrix() * lever_arm));
    return masses.inverse_mass[body] + std::max(0.0, all - about);
}

}  // namespace

SpringLoad spring_load(const Forces& forces, const Masses& masses, std::uint32_t body)
{
    SpringLoad load;
    if (body == kNoBody) return load;
    for (std::uint32_t k = forces.first_spring[body]; k < forces.first_spring[body + 1]; ++k) {
        const SpringForce& spring = forces.springs[forces.spring_of[k]];
        const Vec3& at = spring.a == body ? spring.at_a : spring.at_b;
        const double inverse_mass =
            inverse_mass_at(masses, body, forces.pivot_to_center_of(body) + at);
        load.square += spring.stiffness * inverse_mass;
        load.damping += spring.damping * inverse_mass;
    }
    return load;
}

double damping_ratio(const SpringLoad& load) { return load.damping / (2 * std::sqrt(load.square)); }

// With w^2 = square and 2 z w = damping: sqrt(1 + z^2) - z, without a difference of like numbers.
double longest_step(const SpringLoad& load)
{
    const double half = 0.5 * load.damping, w = std::sqrt(load.square + half * half) + half;
    return w > 0 ? 2 / w : std::numeric_limits<double>::infinity();
}

double
longest_step(const Forces& forces, const Masses& masses, std::span<const std::uint32_t> group)
{
    std::vector<SpringLoad> loads;
    for (const std::uint32_t body : group) loads.push_back(spring_load(forces, masses, body));
    const auto load_of = [&](std::uint32_t body) {
        const auto at = std::lower_bound(group.begin(), group.end(), body);
        if (at != group.end() && *at == body)
            return loads[static_cast<std::size_t>(at - group.begin())];
        return SpringLoad{};  // what is not of the group gives way to none of its springs
    };
    double longest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t body : group)
        for (std::uint32_t k = forces.first_spring[body]; k < forces.first_spring[body + 1]; ++k) {
            const SpringForce& spring = forces.springs[forces.spring_of[k]];
            longest = std::min(longest, longest_step(load_of(spring.a) + load_of(spring.b)));
        }
    return longest;
}

}  // namespace throng
