#include "throng/momentum_ledger.hpp"

#include "pipeline/world/tied_bodies.hpp"

#include <vector>

namespace throng {

class MomentumLedger::Inside {
public:
    void before_step(const World& world);
    void after_step(const World& world);

private:
    friend class MomentumLedger;  // which tells what was found

    struct Begun {
        std::uint32_t generation = 0;
        bool dynamic = false, awake = false;
        Vec3 velocity = Vec3::Zero();
    };
    struct Group {
        Vec3 change = Vec3::Zero();  // N s, less what gravity and constant forces gave
        bool held = false, moves = false;
    };

    static Vec3 velocity_of(const WorldState& state, std::uint32_t body);
    bool is_here(const WorldState& state, std::uint32_t body) const;
    bool is_held(const WorldState& state, std::uint32_t body) const;
    void join_groups(const WorldState& state);
    void hold_groups(const WorldState& state);
    void add_up(const WorldState& state);

    std::vector<Begun> begun_;  // by body
    DisjointSets sets_;
    std::vector<Group> groups_;  // [bodies] at the first of each
    double made_ = 0;
    std::uint64_t count_ = 0;
};

void MomentumLedger::Inside::before_step(const World& world)
{
    const WorldState& state = state_of(world);
    const auto& states = state.get<BodyStates>();
    begun_.assign(states.kind.size(), {});
    for (std::uint32_t body = 0; body < begun_.size(); ++body)
        if (states.dynamic(body))
            begun_[body] = {state.generation[body], true, states.moves(body),
                            velocity_of(state, body)};
}

// As of its place: a velocity may be half a substep of gravity behind, and is not any more, or is
// again, once something is touched.
Vec3 MomentumLedger::Inside::velocity_of(const WorldState& state, std::uint32_t body)
{
    return state.velocity(body) + state.velocity_lag(body) * state.get<StepContext>().gravity;
}

// The same dynamic body as before the step.
bool MomentumLedger::Inside::is_here(const WorldState& state, std::uint32_t body) const
{
    return body < begun_.size() && begun_[body].dynamic && state.get<BodyStates>().dynamic(body)
        && begun_[body].generation == state.generation[body];
}

// By something besides contacts, nobody can say how much. Whom a sleeper touches is not told: it
// may lie on what stands still.
bool MomentumLedger::Inside::is_held(const WorldState& state, std::uint32_t body) const
{
    const auto& states = state.get<BodyStates>();
    const auto& forces = state.get<Forces>();
    return !begun_[body].awake || forces.is_dragged(body) || states.quarantined[body] != 0
        || forces.on_pivot(body) || state.get<Masses>().inverse_mass[body] == 0
        || !forces.attractors.empty() || forces.field
        || state.get<PrescribedVelocities>().of(body) != nullptr;
}

void MomentumLedger::Inside::join_groups(const WorldState& state)
{
    join_tied_bodies(
        state, [&](std::uint32_t body) { return is_here(state, body); }, sets_);
    if (!state.get<StepContext>().effects.meets(kEventDriven)) return;
    std::uint32_t first = kNoBody;
    for (std::uint32_t body = 0; body < state.get<BodyStates>().kind.size(); ++body) {
        if (!is_here(state, body)) continue;
        if (first == kNoBody) first = body;
        sets_.join(first, body);
    }
}

void MomentumLedger::Inside::hold_groups(const WorldState& state)
{
    const auto& states = state.get<BodyStates>();
    const auto count = static_cast<std::uint32_t>(states.kind.size());
    groups_.assign(count, {});
    const auto hold = [&](std::uint32_t body) { groups_[sets_.find(body)].held = true; };
    const auto hold_by = [&](std::uint32_t a, std::uint32_t b) {
        const bool a_here = a != kNoBody && is_here(state, a),
                   b_here = b != kNoBody && is_here(state, b);
        if (a_here && !b_here) hold(a);
        if (b_here && !a_here) hold(b);
    };
    for (const auto& entry : state.get<ActiveContacts>().entries)
        hold_by(entry.body_a, entry.body_b);
    for (const SpringForce& spring : state.get<Forces>().springs) hold_by(spring.a, spring.b);
    bool any_other = false;
    for (std::uint32_t body = 0; body < count; ++body) {
        if (!is_here(state, body))
            any_other = any_other || states.kind[body] != BodyKind::removed;
        else if (is_held(state, body))
            hold(body);
    }
    if (any_other && state.get<StepContext>().effects.meets(kEventDriven))
        for (Group& group : groups_) group.held = true;
}

void MomentumLedger::Inside::add_up(const WorldState& state)
{
    const auto& masses = state.get<Masses>();
    const auto& forces = state.get<Forces>();
    const auto& context = state.get<StepContext>();
    for (std::uint32_t body = 0; body < groups_.size(); ++body) {
        if (!is_here(state, body)) continue;
        Group& group = groups_[sets_.find(body)];
        group.moves = true;
        const double mass = masses.mass[body];
        group.change += mass * (velocity_of(state, body) - begun_[body].velocity);
        group.change -= context.dt * mass * context.gravity;
        if (body < forces.force.size()) group.change -= context.dt * forces.force[body];
    }
    for (const Group& group : groups_) {
        if (!group.moves || group.held) continue;
        made_ += group.change.norm();
        ++count_;
    }
}

void MomentumLedger::Inside::after_step(const World& world)
{
    const WorldState& state = state_of(world);
    join_groups(state);
    hold_groups(state);
    add_up(state);
}

MomentumLedger::MomentumLedger() : inside_(std::make_unique<Inside>()) { }
MomentumLedger::~MomentumLedger() = default;
MomentumLedger::MomentumLedger(MomentumLedger&&) noexcept = default;
MomentumLedger& MomentumLedger::operator=(MomentumLedger&&) noexcept = default;

void MomentumLedger::before_step(const World& world) { inside_->before_step(world); }
void MomentumLedger::after_step(const World& world) { inside_->after_step(world); }
double MomentumLedger::made() const { return inside_->made_; }
std::uint64_t MomentumLedger::groups() const { return inside_->count_; }

}  // namespace throng
