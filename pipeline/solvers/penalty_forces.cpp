// Penalty forces: each point that overlaps is a spring with a damper, and all act at once. What
// strikes is thrown back first, by its restitution.
//
// Overlap under a load is the load over the stiffness. Friction is a spring with a damper across
// the normal that gives way at Coulomb's limit: what sticks comes to rest where the spring bears
// it, and stays. Rolling friction is a damper between the spins that gives way likewise, so that
// what should not roll creeps.
//
// Source: Cundall and Strack, A discrete numerical model for granular assemblies (1979).
#include "pipeline/solvers/impact_rounds.hpp"
#include "pipeline/solvers/island_solver.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Contacts that the rounds of impacts look at, in all, in a part of a substep; springs stop what
// still comes in then.
constexpr std::size_t kImpactContactsInPart = 1 << 14;

// Of auto: by how many radians it swings in a substep, and the share of critical damping where
// nothing bounces; together half of what a semi-implicit step bears.
constexpr double kSwing = 0.5, kDamped = 0.7;
// A substep is cut to this share of the limit; to that of springs that join bodies.
constexpr double kWithin = 0.9, kWithinSprings = 0.5;
// Of what slides, the share that friction's damper stops in a substep.
constexpr double kSlidingDamped = 0.5;

// What presses a spring in is seen by the load that it bore and by how fast the two go on closing;
// this many times as deep as both say it may be, for the load is that of a whole substep.
constexpr double kPressed = 3;
// So much of a shape's extent is looked at no further: swings near the limit of the step go by
// neither.
constexpr double kShallow = 1e-3;
// Steps that what nobody pressed in takes to part. It keeps the speed that it parts at.
constexpr double kStepsToPart = 4;

}  // namespace

// What a point is to the step.
struct IslandSolver::Give {
    double stiffness = 0, damping = 0;  // N/m, N s/m
    double longest = 0;                 // s, of a step that keeps it from growing
    std::uint32_t share = 1;            // of how many points what it bears is a part
};

// Whether the two overlap, or come to within that time: a spring that they fall into for a whole
// substep holds more than they bring with them.
bool IslandSolver::presses(std::size_t at, const StepContext& context, double ahead) const
{
    const double closing = context.gravity.norm() * ahead - approach(at, after_);
    return separations_[at] < std::max(0.0, closing) * ahead;
}

// Who bears how many points that overlap, or come to within that time.
void IslandSolver::count_touching(const StepContext& context, double ahead)
{
    pressed_.assign(bodies_.size(), 0);
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        if (!presses(i, context, ahead)) continue;
        for (const std::int32_t body_index : {contacts_[i].a, contacts_[i].b})
            if (body_index >= 0) ++pressed_[static_cast<std::size_t>(body_index)];
    }
}

// Points that share a body add up: each takes its part of what the step bears.
IslandSolver::Give
IslandSolver::give_of(std::size_t at, const SolverParameters& parameters, double time) const
{
    const IslandContact& contact = contacts_[at];
    std::uint32_t share = 1;
    for (const std::int32_t body_index : {contact.a, contact.b})
        if (body_index >= 0)
            share = std::max(share, pressed_[static_cast<std::size_t>(body_index)]);
    const double inverse_mass = inverse_mass_along(points_[at], contact.normal, after_) * share;
    if (!(inverse_mass > 0)) return {};
    Give give;
    give.stiffness = parameters.penalty_stiffness > 0
        ? parameters.penalty_stiffness
        : kSwing * kSwing / (time * time * inverse_mass);
    const double frequency = std::sqrt(give.stiffness * inverse_mass);
    const double damped = kDamped * (1 - contact.restitution);
    give.damping = parameters.penalty_damping >= 0 ? parameters.penalty_damping
                                                   : 2 * damped * frequency / inverse_mass;
    const double ratio = 0.5 * give.damping * inverse_mass / frequency;
    give.longest = 2 * (std::sqrt(1 + ratio * ratio) - ratio) / frequency;
    give.share = share;
    return give;
}

// Overlap that nothing pressed in was found as it is: made so, or come to beside what contacts had
// looked for. Its spring would give back what nobody put in; it is let go at the push limit.
void IslandSolver::find_unearned(const StepContext& context)
{
    // As the step begins: later substeps see on their way what presses, and would take what a part
    // of such a spring gives for a load that had pressed the rest of it in.
    for (std::size_t i = 0; i < unearned_.size(); ++i)
        unearned_[i] = std::min(unearned_[i], std::max(0.0, -separations_[i]));
    if (!unearned_.empty()) return;
    const double time = context.substep();
    unearned_.assign(contacts_.size(), 0);
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        if (!(separations_[i] < -kShallow * contacts_[i].extent)) continue;
        const double stiffness = give_of(i, parameters_, time).stiffness;
        if (!(stiffness > 0)) continue;
        const Vec3& normal = points_[i].normal;
        const double borne = normal.dot(points_[i].impulse) / (time * stiffness);
        const double speed = approach(i, after_);
        const double inverse_mass = inverse_mass_along(points_[i], contacts_[i].normal, after_);
        double pressed =
            kPressed * std::sqrt(borne * borne + speed * speed / (stiffness * inverse_mass));
        // Who bore nothing yet has come in since, and no further than he closes.
        if (!(borne > 0)) pressed = std::min(pressed, std::max(0.0, -speed * time));
        unearned_[i] = std::max(0.0, -separations_[i] - pressed);
    }
}

// What friction held as the step began, N.
void IslandSolver::find_held(double time)
{
    if (!held_.empty()) return;
    for (const DirectPoint& point : points_)
        held_.emplace_back((point.impulse - point.normal * point.normal.dot(point.impulse)) / time);
}

// A spring that holds what has slid since the two stick, with a damper that stops half of the
// sliding in a substep, all their points together, up to what friction bears under a push, N s.
void IslandSolver::resist_sliding(std::size_t at,
                                  double normal_force,
                                  double time,
                                  std::uint32_t share)
{
    DirectPoint& point = points_[at];
    const auto across = [&](const Vec3& v) { return Vec3(v - point.normal * point.normal.dot(v)); };
    const Vec3 sliding = across(relative_velocity(point, before_));
    const double inverse_mass = widest_inverse_mass(point, before_) * share;
    if (!(inverse_mass > 0)) return;
    const double most = point.friction * normal_force;
    const auto within = [&](const Vec3& impulse) -> Vec3 {
        const double size = std::sqrt(impulse.squaredNorm());
        return size > most ? Vec3(impulse * (most / size)) : impulse;
    };
    const Vec3 spring = across(held_[at]) * time - sliding * (kSwing * kSwing / inverse_mass);
    held_[at] = within(spring) / time;
    const Vec3 impulse = within(spring - sliding * (kSlidingDamped / inverse_mass));
    point.impulse += impulse;
    apply_impulse(point, impulse, after_);
}

// Dampers that stop half of the turning between two, likewise.
void IslandSolver::damp_turning(DirectPoint& point, double normal_force, std::uint32_t share)
{
    const Vec3 turning = relative_spin(point, before_);
    const double fast = std::sqrt(turning.squaredNorm());
    if (!(fast > 0)) return;
    const double inverse_mass = inverse_inertia_about(point, turning / fast, before_) * share;
    if (!(inverse_mass > 0)) return;
    const Vec3 torque =
        turning * (-std::min(0.5 / inverse_mass, point.rolling * normal_force / fast));
    point.torque += torque;
    apply_torque(point, torque, after_);
}

// What comes in faster than what rests may, and touches within that time, goes by the law of
// impacts: a spring of auto, which a few parts of a substep turn round, gives back by its damper
// and the step more or less than restitution has it. A spring that is asked for is what it is.
void IslandSolver::bounce_off(const SolverParameters& parameters, double time)
{
    if (parameters.penalty_stiffness > 0 || parameters.penalty_damping >= 0) return;
    double greatest = 0;
    for (std::size_t i = 0; i < contacts_.size(); ++i)
        greatest = std::max(greatest, -approach(i, after_));
    const double least = std::max(restitution_threshold_, Impacts::kRounding * greatest);
    if (!(greatest > least)) return;
    struck_ = after_;
    const std::size_t rounds = impact_rounds(kImpactContactsInPart, contacts_.size());
    for (std::size_t round = 0; round < rounds; ++round) {
        impacts_.points.clear();
        for (std::size_t i = 0; i < contacts_.size(); ++i) {
            const double speed = approach(i, struck_);
            const double resting = std::max(least, contacts_[i].least_speed);
            if (speed < -resting && separations_[i] + speed * time < 0) add_impact(i, resting);
        }
        if (impacts_.points.empty()) break;
        reflect(true, 1, least);
        for (const ImpactPoint& impact : impacts_.points) {
            const std::size_t at = impact.at;
            if (!(struck_impulse_[at] > 0)) continue;
            points_[at].impulse += points_[at].normal * struck_impulse_[at];
            apply_impact_friction(struck_impulse_[at], points_[at], struck_);
            // He leaves with his share of what he came with: what the spring gave back besides
            // would be too much. Of who is stopped its damper takes it.
            unearned_[at] = std::max(unearned_[at], -separations_[at] * contacts_[at].restitution);
        }
    }
    after_ = struck_;
}

void IslandSolver::throw_back(const StepContext& context, double time)
{
    place_points();
    bounce_off(parameters_, time);
    // The velocities before are those that took the bodies here: of the middle of the last part.
    carry_arms(-time / 2, context.dt);
}

// All forces are of the velocities before, so that no order of touches has a say.
void IslandSolver::apply_penalty_forces(const StepContext& context, double time)
{
    count_touching(context, 0);
    // What is too stiff for the cut, with those who came to press in the middle of a substep, gives
    // way as far as that bears.
    SolverParameters softened = parameters_;
    softened.penalty_stiffness = softened.penalty_damping = -1;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        const double pressed = -separations_[i] - unearned_[i];
        const double let_go = unearned_[i] / (kStepsToPart * context.dt);
        unearned_[i] -= std::min(let_go, parameters_.push_limit) * time;
        if (!(pressed > 0)) {
            held_[i].setZero();
            continue;
        }
        DirectPoint& point = points_[i];
        Give give = give_of(i, parameters_, time);
        if (give.longest < time) give = give_of(i, softened, time);
        const double force =
            std::max(0.0, give.stiffness * pressed - give.damping * approach(i, before_));
        const Vec3 impulse = point.normal * (force * time);
        point.impulse += impulse;
        apply_impulse(point, impulse, after_);
        if (point.friction > 0) resist_sliding(i, force * time, time, give.share);
        if (point.rolling > 0) damp_turning(point, force * time, give.share);
    }
    going_ = after_;
}

void IslandSolver::cut_substep(const StepContext& context, double time)
{
    place_points();
    turn_inertias();
    count_touching(context, time);
    find_unearned(context);
    find_held(time);
    double longest = time;
    if (state_forces_) longest = std::min(longest, kWithinSprings * state_forces_->longest_step());
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        points_[i].impulse = points_[i].torque = Vec3::Zero();
        if (!presses(i, context, time)) continue;
        const double bears = give_of(i, parameters_, time).longest;
        if (bears > 0 && bears < time) longest = std::min(longest, kWithin * bears);
    }
    cuts_ = static_cast<int>(
        std::min(std::ceil(time / longest), static_cast<double>(kMostPenaltyCuts)));
}

}  // namespace throng
