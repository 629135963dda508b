#include "cost/windows/errors.hpp"

#include "scene/names.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace throng {

namespace {

constexpr MeasureInfo kInfo[kMeasures] = {
    {"drift", "m", "how far bodies come to be from where the reference has them"},
    {"turn", "rad", "how far they are turned from where the reference has them"},
    {"velocity", "m/s", "how far their velocities are from the reference's"},
    {"overlap", "m", "the greatest depth to which two shapes overlap at a window's end"},
    {"energy", "J", "what a window's steps made from nothing"},
    {"momentum", "N s", "what bodies that nothing holds were given from nothing"},
    {"complementarity", "m/s",
     "the most by which a contact pushes what parts, or lets what is in go on"},
    {"friction_cone", "m/s",
     "the most by which friction leaves its cone, or does not oppose a slip"},
    {"missed_contacts", "1", "the share of pairs that touch for which there was no contact"},
    {"force_error", "1", "what is left of the forces on what rests, over its weight"},
};

constexpr int kDraws = 1000;
constexpr double kShare = 0.99;

double angle_between(const Quat& a, const Quat& b)
{
    const Quat turn = a.conjugate() * b;
    return 2 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
}

}  // namespace

const MeasureInfo& info(Measure measure) { return kInfo[place_of(measure)]; }

std::array<std::string_view, kMeasures> measure_names()
{
    std::array<std::string_view, kMeasures> names;
    for (std::size_t i = 0; i < kMeasures; ++i) names[i] = kInfo[i].name;
    return names;
}

Measure measure_named(std::string_view name)
{
    for (std::size_t i = 0; i < kMeasures; ++i)
        if (kInfo[i].name == name) return static_cast<Measure>(i);
    throw std::invalid_argument("wanted " + either_of(measure_names()) + ", not "
                                + in_quotes(name));
}

void compare(const BodyStates& states, const BodyStates& reference, Errors& errors)
{
    double drift = 0, turn = 0, velocity = 0;
    std::size_t bodies = 0;
    for (std::size_t i = 0; i < states.size(); ++i) {
        const BodyState &is = states[i], &should_be = reference[i];
        if (!should_be.counts) continue;
        ++bodies;
        drift += (is.center - should_be.center).squaredNorm();
        const double angle = angle_between(is.pose.orientation, should_be.pose.orientation);
        turn += angle * angle;
        velocity += (is.velocity - should_be.velocity).squaredNorm();
        if (is.counts) continue;
        drift = turn = velocity = std::numeric_limits<double>::infinity();
    }
    const double share = bodies > 0 ? 1 / static_cast<double>(bodies) : 0;
    const auto put = [&](Measure measure, double sum) {
        of(errors, measure) =
            std::isfinite(sum) ? sum * share : std::numeric_limits<double>::infinity();
    };
    put(Measure::drift, drift);
    put(Measure::turn, turn);
    put(Measure::velocity, velocity);
}

double rms(std::span<const Errors> trials, std::size_t place)
{
    if (trials.empty()) return 0;
    double sum = 0;
    for (const Errors& trial : trials) sum += of(trial, place);
    return std::sqrt(sum / static_cast<double>(trials.size()));
}

double rms_at_most(std::span<const Errors> trials, std::size_t place)
{
    const double at = rms(trials, place);
    if (trials.size() < 2 || !std::isfinite(at)) return at;
    std::mt19937_64 engine(1);
    std::vector<double> drawn(kDraws);
    const std::size_t count = trials.size();
    double sum = 0, squares = 0;
    for (double& each : drawn) {
        double total = 0;
        for (std::size_t i = 0; i < count; ++i) total += of(trials[engine() % count], place);
        each = std::sqrt(total / static_cast<double>(count));
        sum += each;
        squares += each * each;
    }
    const auto bound = drawn.begin() + static_cast<std::ptrdiff_t>(kShare * kDraws);
    std::nth_element(drawn.begin(), bound, drawn.end());
    const double mean = sum / kDraws;
    return *bound + std::sqrt(std::max(0.0, squares / kDraws - mean * mean));
}

}  // namespace throng
