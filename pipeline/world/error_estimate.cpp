#include "throng/error_estimate.hpp"

#include "pipeline/forces/rigid_law.hpp"
#include "pipeline/world/world_state.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace throng {

namespace {

// How often the difference of the two rules is taken; and of whom something stops: of the way that
// he would have gone by it in the step, as far as a substep lets him, and of the way that he goes
// in the step, no more than that. Found on the sweep of H103, so that few steps are told too small.
constexpr double kOfDifference = 6, kOfStopped = 3e-3, kOfWay = 0.1;

}  // namespace

class ErrorEstimate::Inside {
public:
    void before_step(const World& world);
    void after_step(const World& world);

private:
    friend class ErrorEstimate;  // which tells what was found

    struct Begun {
        std::uint32_t body = 0, generation = 0;
        Vec3 center = Vec3::Zero(), velocity = Vec3::Zero();
    };

    void mark_touched(const WorldState& state);
    double error_of(const WorldState& state, const Begun& begun) const;

    std::vector<Begun> begun_;           // who was awake as the step began, ascending
    std::vector<std::uint8_t> touched_;  // by body
    StepError last_, worst_;
    double squares_ = 0;
    std::uint64_t count_ = 0;  // of bodies, of all steps
};

void ErrorEstimate::Inside::before_step(const World& world)
{
    const WorldState& state = state_of(world);
    const auto& states = state.get<BodyStates>();
    begun_.clear();
    for (std::uint32_t body = 0; body < states.kind.size(); ++body)
        if (states.movable(body))
            begun_.push_back(
                {body, state.generation[body], state.center_of_mass(body), state.velocity(body)});
}

// Where the step is cut at touches, who touches whom is not kept: all may.
void ErrorEstimate::Inside::mark_touched(const WorldState& state)
{
    const bool is_kept = !state.get<StepContext>().effects.meets(kEventDriven);
    touched_.assign(state.get<BodyStates>().kind.size(), is_kept ? 0 : 1);
    for (const auto& entry : state.get<ActiveContacts>().entries)
        touched_[entry.body_a] = touched_[entry.body_b] = 1;
}

double ErrorEstimate::Inside::error_of(const WorldState& state, const Begun& begun) const
{
    const auto& context = state.get<StepContext>();
    const double dt = context.dt;
    const std::uint32_t body = begun.body;
    const Vec3 velocity = state.velocity(body), way = state.center_of_mass(body) - begun.center;
    const double difference = Vec3(way - 0.5 * dt * (begun.velocity + velocity)).norm();
    if (touched_[body] == 0) {
        // Who flies by rules of second order is off by what becomes of it in parts as short as a
        // substep.
        const bool is_followed =
            state.get<Forces>().act_on(body) && integrator_of(context, true).order > 1;
        const double parts = is_followed ? context.substeps * context.substeps : 1;
        return kOfDifference * difference / parts;
    }
    const Vec3 gravity = context.has(Effect::gravity) ? Vec3(context.gravity) : Vec3(Vec3::Zero());
    const double stopped = dt * Vec3(velocity - begun.velocity - dt * gravity).norm();
    return kOfDifference * difference + kOfStopped * stopped / context.substeps
        + kOfWay * std::min(dt * velocity.norm(), stopped);
}

void ErrorEstimate::Inside::after_step(const World& world)
{
    const WorldState& state = state_of(world);
    const auto& states = state.get<BodyStates>();
    mark_touched(state);
    last_ = {};
    last_.step = world.report().step;
    double squares = 0;
    std::uint64_t count = 0;
    for (const Begun& begun : begun_) {
        const std::uint32_t body = begun.body;
        if (state.generation[body] != begun.generation || !states.dynamic(body)
            || states.quarantined[body] != 0)
            continue;
        const double error = error_of(state, begun);
        squares += error * error;
        ++count;
        if (error > last_.greatest || count == 1) {
            last_.greatest = error;
            last_.worst = {body, begun.generation};
        }
    }
    if (count > 0) last_.rms = std::sqrt(squares / static_cast<double>(count));
    squares_ += squares;
    count_ += count;
    if (last_.greatest > worst_.greatest || worst_.step == 0) worst_ = last_;
}

ErrorEstimate::ErrorEstimate() : inside_(std::make_unique<Inside>()) { }
ErrorEstimate::~ErrorEstimate() = default;
ErrorEstimate::ErrorEstimate(ErrorEstimate&&) noexcept = default;
ErrorEstimate& ErrorEstimate::operator=(ErrorEstimate&&) noexcept = default;

void ErrorEstimate::before_step(const World& world) { inside_->before_step(world); }
void ErrorEstimate::after_step(const World& world) { inside_->after_step(world); }
const StepError& ErrorEstimate::last() const { return inside_->last_; }
const StepError& ErrorEstimate::worst() const { return inside_->worst_; }

double ErrorEstimate::rms() const
{
    return inside_->count_ > 0 ? std::sqrt(inside_->squares_ / static_cast<double>(inside_->count_))
                               : 0;
}

}  // namespace throng
