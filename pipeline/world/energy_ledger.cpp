#include "throng/energy_ledger.hpp"

#include "kernels/dynamics/energy.hpp"
#include "pipeline/world/tied_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace throng {

namespace {

// Roundings of a velocity in a substep: what is added to it, a few times over.
constexpr double kRoundings = 8;

template <class Number>
Number of_body(const std::vector<Number>& list, std::uint32_t body, const Number& none)
{
    return body < list.size() ? list[body] : none;
}

// Whether a body goes its own way, whatever pushes it. A driven one may be dynamic.
bool moves_by_itself(const WorldState& state, std::uint32_t body)
{
    const auto& states = state.get<BodyStates>();
    if (states.carries(body)) return true;
    if (states.kind[body] != BodyKind::kinematic) return false;
    const auto& velocities = state.get<Velocities>();
    return !velocities.linear[body].isZero(0) || !velocities.angular[body].isZero(0);
}

// W, the most that drag in the wind gives at a velocity between two.
double wind_power(double drag, const Vec3& wind, const Vec3& from, const Vec3& to)
{
    double most = 0;
    for (const Vec3& v : {from, Vec3((from + to) / 2), to})
        most = std::max(most, drag * (wind - v).dot(v));
    return most;
}

// The same of what goes round a pivot, which may go any way in between, no faster than at either
// end.
double wind_power_round(double drag, const Vec3& wind, const Vec3& from, const Vec3& to)
{
    const double fastest = std::sqrt(std::max(from.squaredNorm(), to.squaredNorm()));
    const double blows = wind.norm(), speed = std::min(fastest, blows / 2);
    return drag * speed * (blows - speed);
}

}  // namespace

class EnergyLedger::Inside {
public:
    void before_step(const World& world);
    void after_step(const World& world);

private:
    friend class EnergyLedger;  // which tells what was found

    struct OfBody {
        double kinetic = 0, potential = 0;  // J
        Vec3 place = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero();
        double power = 0;  // W, of the program's own field
    };
    struct Look {
        std::vector<OfBody> bodies;
        std::vector<double> springs;  // J
    };
    struct OfGroup {
        double before = 0, after = 0;  // J
        double faster = 0;             // J, of which in motion
        double work = 0, rounding = 0;
        bool driven = false, touches = false;
    };

    void look(const World& world, Look& look) const;
    void join_groups(const World& world);
    void mark_groups(const World& world);
    void add_up(const World& world);
    double pay_back(double rise);
    void enter(double change, std::uint64_t step);
    double work_on(const World& world, std::uint32_t body) const;

    Look before_, after_;
    DisjointSets sets_;            // of bodies
    std::vector<OfGroup> groups_;  // [bodies] at the first of each
    double account_ = 0, lowest_ = 0, gained_ = 0, net_ = 0, greatest_kinetic_ = 0;
    // J, that contacts took in each of the last steps: of more of them than the four for which a
    // soft contact swings where a step has one substep.
    std::array<double, 6> taken_ = {};
    std::uint64_t lowest_step_ = 0, from_step_ = 0, to_step_ = 0;
};

void EnergyLedger::Inside::look(const World& world, Look& look) const
{
    const WorldState& state = state_of(world);
    const auto& masses = state.get<Masses>();
    const auto& states = state.get<BodyStates>();
    const auto& poses = state.get<Poses>();
    const auto& velocities = state.get<Velocities>();
    const auto& forces = state.get<Forces>();
    const Vec3 gravity = world.gravity();
    look.bodies.assign(states.kind.size(), {});
    for (std::uint32_t body = 0; body < look.bodies.size(); ++body) {
        if (!states.dynamic(body)) continue;
        OfBody& of = look.bodies[body];
        of.place = state.center_of_mass(body);
        of.velocity = state.velocity(body);
        of.spin = velocities.angular[body];
        of.kinetic = kinetic_energy_of(body, masses, poses, velocities);
        const Vec3 then = of.place - state.velocity_lag(body) * of.velocity;
        of.potential =
            attraction_of(forces, masses, poses, body, state.get<StepContext>().substep())
            - masses.mass[body] * gravity.dot(then);
        if (!forces.field) continue;
        const Wrench wrench =
            forces.field({body, state.get<StepContext>().time, masses.mass[body],
                          Pose{of.place, poses.orientation[body]}, of.velocity, of.spin});
        of.power = wrench.force.dot(of.velocity) + wrench.torque.dot(of.spin);
    }
    look.springs.clear();
    for (const SpringForce& spring : forces.springs)
        look.springs.push_back(spring_energy(spring, forces, poses));
}

// What cannot be moved joins nobody.
void EnergyLedger::Inside::join_groups(const World& world)
{
    const WorldState& state = state_of(world);
    const auto& states = state.get<BodyStates>();
    join_tied_bodies(
        state, [&](std::uint32_t body) { return states.dynamic(body); }, sets_);
}

void EnergyLedger::Inside::mark_groups(const World& world)
{
    const WorldState& state = state_of(world);
    const auto& states = state.get<BodyStates>();
    const auto mark = [&](std::uint32_t body) {
        if (body != kNoBody && states.dynamic(body)) groups_[sets_.find(body)].driven = true;
    };
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        if (a != kNoBody && moves_by_itself(state, a)) mark(b);
        if (b != kNoBody && moves_by_itself(state, b)) mark(a);
    };
    for (const std::uint32_t body : state.get<PrescribedVelocities>().body) mark(body);
    for (const auto& entry : state.get<ActiveContacts>().entries) {
        join(entry.body_a, entry.body_b);
        for (const std::uint32_t body : {entry.body_a, entry.body_b})
            if (states.dynamic(body)) groups_[sets_.find(body)].touches = true;
    }
    for (const SpringForce& spring : state.get<Forces>().springs) join(spring.a, spring.b);
    // Who touches whom is not kept where the step is cut at touches.
    if (!state.get<StepContext>().effects.meets(kEventDriven)) return;
    bool any = !state.get<PrescribedVelocities>().body.empty();
    for (std::uint32_t body = 0; body < states.kind.size(); ++body)
        any = any || moves_by_itself(state, body);
    for (OfGroup& group : groups_) {
        group.driven = group.driven || any;
        group.touches = true;
    }
}

double EnergyLedger::Inside::work_on(const World& world, std::uint32_t body) const
{
    const auto& forces = state_of(world).get<Forces>();
    const double dt = world.settings().dt;
    const OfBody &from = before_.bodies[body], &to = after_.bodies[body];
    const Vec3 none = Vec3::Zero();
    const Vec3 torque = of_body(forces.torque, body, none);
    const auto power = forces.on_pivot(body) ? wind_power_round : wind_power;
    return of_body(forces.force, body, none).dot(to.place - from.place)
        + dt
        * (std::max(torque.dot(from.spin), torque.dot(to.spin))
           + power(of_body(forces.linear_drag, body, 0.0), forces.wind, from.velocity, to.velocity)
           + std::max(from.power, to.power));
}

void EnergyLedger::Inside::add_up(const World& world)
{
    const WorldState& state = state_of(world);
    const Settings& settings = world.settings();
    const double digit = settings.precision == Precision::float_ ? 0x1p-24 : 0x1p-53;
    for (std::uint32_t body = 0; body < groups_.size(); ++body) {
        if (!state.get<BodyStates>().dynamic(body)) continue;
        const OfBody &from = before_.bodies[body], &to = after_.bodies[body];
        OfGroup& group = groups_[sets_.find(body)];
        group.before += from.kinetic + from.potential;
        group.after += to.kinetic + to.potential;
        group.faster += to.kinetic - from.kinetic;
        group.work += work_on(world, body);
        group.rounding +=
            kRoundings * settings.substeps * digit * std::max(from.kinetic, to.kinetic)
            + kRoundings * 0x1p-53 * (std::abs(from.potential) + std::abs(to.potential));
    }
    const std::vector<SpringForce>& springs = state.get<Forces>().springs;
    for (std::size_t i = 0; i < springs.size(); ++i) {
        const bool on_a = springs[i].a != kNoBody && state.get<BodyStates>().dynamic(springs[i].a);
        const std::uint32_t body = on_a ? springs[i].a : springs[i].b;
        if (body == kNoBody) continue;
        OfGroup& group = groups_[sets_.find(body)];
        group.before += before_.springs[i];
        group.after += after_.springs[i];
        group.rounding += kRoundings * 0x1p-53 * (before_.springs[i] + after_.springs[i]);
    }
}

void EnergyLedger::Inside::enter(double change, std::uint64_t step)
{
    account_ += change;
    if (account_ < lowest_) {
        lowest_ = account_;
        lowest_step_ = step;
    }
    if (account_ - lowest_ <= gained_) return;
    gained_ = account_ - lowest_;
    from_step_ = lowest_step_;
    to_step_ = step;
}

// What is left of a rise after what contacts have taken lately.
double EnergyLedger::Inside::pay_back(double rise)
{
    double lent = 0;
    for (const double taken : taken_) lent += taken;
    const double paid = std::min(rise, lent);
    if (!(paid > 0)) return rise;
    for (double& taken : taken_) taken *= 1 - paid / lent;
    return rise - paid;
}

void EnergyLedger::Inside::before_step(const World& world) { look(world, before_); }

void EnergyLedger::Inside::after_step(const World& world)
{
    look(world, after_);
    join_groups(world);
    groups_.assign(after_.bodies.size(), {});
    mark_groups(world);
    add_up(world);
    double change = 0, by_contacts = 0, taken = 0;
    for (const OfGroup& group : groups_) {
        double rise = group.after - group.before - group.work;
        if (group.driven || !std::isfinite(rise)) continue;
        net_ += rise;
        if (group.touches && rise > 0) rise = std::min(rise, std::max(0.0, group.faster));
        if (rise > 0) rise = std::max(0.0, rise - group.rounding);
        if (group.touches) (rise > 0 ? by_contacts : taken) += std::abs(rise);
        if (!group.touches || rise < 0) change += rise;
    }
    change += pay_back(by_contacts);
    taken_[world.report().step % taken_.size()] = taken;
    double kinetic = 0;
    for (const OfBody& body : after_.bodies) kinetic += body.kinetic;
    greatest_kinetic_ = std::max(greatest_kinetic_, kinetic);
    enter(change, world.report().step);
}

EnergyLedger::EnergyLedger() : inside_(std::make_unique<Inside>()) { }
EnergyLedger::~EnergyLedger() = default;
EnergyLedger::EnergyLedger(const EnergyLedger& other)
    : inside_(std::make_unique<Inside>(*other.inside_))
{ }
EnergyLedger& EnergyLedger::operator=(const EnergyLedger& other)
{
    inside_ = std::make_unique<Inside>(*other.inside_);
    return *this;
}
EnergyLedger::EnergyLedger(EnergyLedger&&) noexcept = default;
EnergyLedger& EnergyLedger::operator=(EnergyLedger&&) noexcept = default;

void EnergyLedger::before_step(const World& world) { inside_->before_step(world); }
void EnergyLedger::after_step(const World& world) { inside_->after_step(world); }
double EnergyLedger::gained() const { return inside_->gained_; }
std::uint64_t EnergyLedger::from_step() const { return inside_->from_step_; }
std::uint64_t EnergyLedger::to_step() const { return inside_->to_step_; }
double EnergyLedger::net() const { return inside_->net_; }
double EnergyLedger::greatest_kinetic() const { return inside_->greatest_kinetic_; }

}  // namespace throng
