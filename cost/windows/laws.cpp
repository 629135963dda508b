#include "cost/windows/laws.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

constexpr double kTouches = 1e-6;  // m
// m and m/s: what a reference pushes out of the overlap that a window began with is at rest all the
// same, and over a window of 0.1 s balanced to a share of 1e-3 of its weight or so.
constexpr double kRests = 1e-3, kRestingSpeed = 1e-3;

}  // namespace

void LawWatch::before_step(const World& world, bool is_last)
{
    momentum_.before_step(world);
    if (is_last) residuals_.before_step(world);
}

void LawWatch::after_step(const World& world, bool is_last)
{
    momentum_.after_step(world);
    if (is_last) residuals_.after_step(world);
}

void LawWatch::put_into(Errors& errors) const
{
    const auto put = [&](Measure measure, double error) { of(errors, measure) = error * error; };
    put(Measure::momentum, momentum_.made());
    put(Measure::complementarity, residuals_.complementarity());
    put(Measure::friction_cone, residuals_.friction_cone());
}

std::vector<std::uint8_t> resting(const BodyStates& from, const BodyStates& to)
{
    std::vector<std::uint8_t> rests(to.size());
    for (std::size_t i = 0; i < to.size(); ++i) {
        const bool stays = (to[i].center - from[i].center).norm() <= kRests;
        const bool is_slow =
            from[i].velocity.norm() <= kRestingSpeed && to[i].velocity.norm() <= kRestingSpeed;
        rests[i] = stays && is_slow ? 1 : 0;
    }
    return rests;
}

double missed_share(std::span<const BodyPair> touching, std::span<const BodyPair> found)
{
    if (touching.empty()) return 0;
    const auto missed = std::count_if(touching.begin(), touching.end(), [&](const BodyPair& pair) {
        return !std::binary_search(found.begin(), found.end(), pair);
    });
    return static_cast<double>(missed) / static_cast<double>(touching.size());
}

double missed_squared(const World& world, World& geometry)
{
    put_states(geometry, states_of(world));
    const std::vector<BodyPair> touching = overlapping_pairs(geometry, kTouches);
    const bool keeps_none = world.settings().overlap != Overlap::allow;
    if (keeps_none && !touching.empty()) return std::numeric_limits<double>::infinity();
    const double share = missed_share(touching, contact_pairs(world));
    return share * share;
}

double force_squared(const World& world, std::span<const std::uint8_t> rests)
{
    const BodyStates states = states_of(world);
    const std::vector<Vec3> left = unbalanced_forces(world);
    double sum = 0;
    std::size_t bodies = 0;
    for (std::size_t i = 0; i < states.size(); ++i) {
        const double weight = world.mass(states[i].body) * world.gravity().norm();
        const Vec3& force = left[states[i].body.index];
        if (rests[i] == 0 || !(weight > 0) || !force.allFinite()) continue;
        sum += force.squaredNorm() / (weight * weight);
        ++bodies;
    }
    return bodies > 0 ? sum / static_cast<double>(bodies) : 0;
}

}  // namespace throng
