#include "pipeline/forces/state_dependent_forces.hpp"

#include "kernels/dynamics/energy.hpp"
#include "kernels/dynamics/spring_limit.hpp"
#include "kernels/math/rotation.hpp"
#include "pipeline/forces/rigid_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace throng {

namespace {

// Of the longest step of the semi-implicit rule: beyond that share the energy of a swing would be
// seen to go up and down by more than a hundredth, halves before and after taken together.
constexpr double kWithin = 0.1;

// rad, of an arm in a substep: one that goes further would be seen at so few places of its round
// that what its spring gives there and takes here need not be the same.
constexpr double kTurn = 0.3;

// Of a body that contacts hold against its springs: its speed, of what those give it in a step, and
// what contacts leave of what they give it in a substep.
constexpr double kStill = 0.125, kHeld = 0.5;

// J, of a body in motion, and of its springs.
double energy_at_hand(const RigidFacts& facts, std::uint32_t body)
{
    return kinetic_energy_of(body, facts.masses, facts.poses, facts.velocities)
        + springs_energy_of(body, facts.forces, facts.poses);
}

// rad/s, the fastest that an arm of their springs could go round by what there is of energy: who
// strikes something may turn by all of it in the middle of a step.
double fastest_arm(const RigidFacts& facts, std::span<const std::uint32_t> group)
{
    const Forces& forces = facts.forces;
    double fastest = 0;
    for (const std::uint32_t body : group) {
        const Mat3 inverse_mass = facts.masses.inverse_inertia[body].matrix();
        double greatest = 0;  // of an arm, 1/(kg m2): how easily it goes round
        for (std::uint32_t k = forces.first_spring[body]; k < forces.first_spring[body + 1]; ++k) {
            const SpringForce& spring = forces.springs[forces.spring_of[k]];
            const Vec3 arm =
                forces.pivot_to_center_of(body) + (spring.a == body ? spring.at_a : spring.at_b);
            const double square = arm.squaredNorm();
            if (square > 0)
                greatest = std::max(
                    greatest, inverse_mass.trace() - arm.dot(Vec3(inverse_mass * arm)) / square);
        }
        // Two directions across the arm share what that is.
        if (greatest > 0)
            fastest = std::max(fastest, std::sqrt(greatest * energy_at_hand(facts, body)));
    }
    return fastest;
}

// Whether a substep is too long for the springs of bodies that they join, or turns an arm too far.
bool too_long(const StepContext& context,
              const RigidFacts& facts,
              std::span<const std::uint32_t> group)
{
    const double span = context.substep();
    return span > kWithin * longest_step(facts.forces, facts.masses, group)
        || span * fastest_arm(facts, group) > kTurn;
}

}  // namespace

bool too_stiff(const StepContext& context,
               const RigidFacts& facts,
               std::span<const std::uint32_t> group)
{
    // Among penalty forces springs are taken as they are, in parts of a substep that bear them.
    return context.response != Response::penalty && too_long(context, facts, group);
}

// Whatever response contacts have: in flight nothing cuts a substep.
bool by_stiff_springs(const StepContext& context,
                      const RigidFacts& facts,
                      std::span<const std::uint32_t> group)
{
    return bears_stiff_springs(context.integrator) && too_long(context, facts, group);
}

StateDependentForces::StateDependentForces(const StepContext& context,
                                           const RigidFacts& facts,
                                           std::span<const std::uint32_t> bodies)
    : context_(context), rule_(rigid_rule(context)), facts_(facts), soft_law_(rule_, facts),
      stiff_law_(rule_, facts), longest_(std::numeric_limits<double>::infinity())
{
    list(bodies);
    const bool halves = chosen(context.integrator, true).which != Integrator::semi_implicit
        && context.response != Response::penalty;
    std::vector<std::uint32_t> soft, stiff;
    for (ForcedBody& forced : forced_bodies_) {
        auto& law = forced.stiff ? stiff : soft;
        forced.place = static_cast<std::uint32_t>(law.size());
        law.push_back(forced.body);
        forced.late = forced.falls_late = forced.stiff || halves;
        late_ = late_ || forced.late;
    }
    stiff_law_.leave_springs();
    const Flights none;
    soft_law_.take(soft, none);
    stiff_law_.take(stiff, none);
}

// Who there is, and whose springs are stiff.
void StateDependentForces::list(std::span<const std::uint32_t> bodies)
{
    const Forces& forces = facts_.forces;
    for (std::uint32_t at = 0; at < bodies.size(); ++at) {
        if (!forces.depends_on_state(bodies[at])) continue;
        forced_bodies_.emplace_back();
        forced_bodies_.back().body = bodies[at];
        forced_bodies_.back().at = at;
    }
    const auto before = [](const ForcedBody& a, const ForcedBody& b) { return a.body < b.body; };
    std::sort(forced_bodies_.begin(), forced_bodies_.end(), before);
    // Group by group, each in order of its bodies.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> joined;
    for (std::uint32_t i = 0; i < forced_bodies_.size(); ++i)
        if (const std::uint32_t body = forced_bodies_[i].body;
            body < forces.group_of.size() && forces.group_of[body] != kNoBody)
            joined.emplace_back(forces.group_of[body], i);
    std::sort(joined.begin(), joined.end());
    for (std::size_t first = 0, last = 0; first < joined.size(); first = last) {
        std::vector<std::uint32_t> members, ids;
        for (; last < joined.size() && joined[last].first == joined[first].first; ++last) {
            members.push_back(joined[last].second);
            ids.push_back(forced_bodies_[joined[last].second].body);
        }
        longest_ = std::min(longest_, throng::longest_step(forces, facts_.masses, ids));
        if (!too_stiff(context_, facts_, ids)) continue;
        for (const std::uint32_t i : members) forced_bodies_[i].stiff = true;
        stiff_.emplace_back(forces, facts_.masses, facts_.poses, facts_.velocities, ids);
        members_.push_back(members);
    }
}

// Of all followers, at a time. What damps sees the velocity that gravity has not changed yet, or it
// would bear up what is at rest.
void StateDependentForces::find_accelerations(double time, bool fallen)
{
    std::size_t stiff = 0;
    for (const ForcedBody& forced : forced_bodies_) {
        RigidMotion& law = forced.stiff ? stiff_law_ : soft_law_;
        const Vec3 velocity = fallen ? Vec3(forced.velocity - fall_of(forced)) : forced.velocity;
        law.stand(forced.place, forced.pose, velocity, forced.spin);
        stiff += forced.stiff ? 1 : 0;
    }
    soft_law_.find_accelerations(time, 0, forced_bodies_.size() - stiff);
    stiff_law_.find_accelerations(time, 0, stiff);
}

// What gravity does in a substep.
Vec3 StateDependentForces::fall_of(const ForcedBody& forced) const
{
    const bool falls = context_.has(Effect::gravity) && facts_.masses.inverse_mass[forced.body] > 0;
    return falls ? Vec3(span_ * context_.gravity) : Vec3(Vec3::Zero());
}

void StateDependentForces::find_changes()
{
    span_ = context_.substep();
    find_accelerations(0, false);
    for (ForcedBody& forced : forced_bodies_) {
        RigidMotion& law = forced.stiff ? stiff_law_ : soft_law_;
        forced.change = span_ * law.acceleration_of(forced.place, span_).linear + fall_of(forced);
        forced.pressing = forced.change;
    }
    if (!stiff() || !context_.has(Effect::restitution)) return;
    const auto count = std::count_if(forced_bodies_.begin(), forced_bodies_.end(),
                                     [](const ForcedBody& forced) { return forced.stiff; });
    stiff_law_.leave_springs(false);
    stiff_law_.find_accelerations(0, 0, static_cast<std::size_t>(count));
    stiff_law_.leave_springs();
    for (ForcedBody& forced : forced_bodies_)
        if (forced.stiff)
            forced.pressing =
                span_ * stiff_law_.acceleration_of(forced.place, span_).linear + fall_of(forced);
}

double StateDependentForces::least_change_of_step() const
{
    double least = std::numeric_limits<double>::infinity();
    for (const ForcedBody& forced : forced_bodies_) least = std::min(least, forced.change.norm());
    return least * context_.substeps;
}

double StateDependentForces::energy_of_springs() const
{
    const Forces& forces = facts_.forces;
    const auto forced_of = [&](std::uint32_t body) -> const ForcedBody* {
        const auto before = [](const ForcedBody& a, std::uint32_t b) { return a.body < b; };
        const auto found =
            std::lower_bound(forced_bodies_.begin(), forced_bodies_.end(), body, before);
        return found != forced_bodies_.end() && found->body == body ? &*found : nullptr;
    };
    const auto pose_of = [&](std::uint32_t body) {
        const ForcedBody* const forced = forced_of(body);
        return forced != nullptr ? forced->pose : facts_.poses.at(body);
    };
    double energy = 0;
    for (const ForcedBody& forced : forced_bodies_) {
        if (!forces.has_springs(forced.body)) continue;
        const std::uint32_t end = forces.first_spring[forced.body + 1];
        for (std::uint32_t k = forces.first_spring[forced.body]; k < end; ++k) {
            const SpringForce& spring = forces.springs[forces.spring_of[k]];
            if (spring.a == forced.body || forced_of(spring.a) == nullptr)
                energy += spring_energy(spring, forces, pose_of);
        }
    }
    return energy;
}

// Whether contacts hold a body against its springs, too.
bool StateDependentForces::is_held(const ForcedBody& forced) const
{
    const double pull = Vec3(forced.change - fall_of(forced)).norm();
    const double speed = kStill * pull * context_.dt / span_;
    return forced.grips && forced.left <= kHeld * pull
        && kinetic_energy_of(forced.body, facts_.masses, facts_.poses, facts_.velocities)
        <= facts_.masses.mass[forced.body] * speed * speed / 2;
}

void StateDependentForces::bear()
{
    late_ = false;
    for (ForcedBody& forced : forced_bodies_) {
        if (forced.borne && !forced.stiff) {
            forced.falls_late = false;
            forced.late = forced.late && facts_.forces.has_springs(forced.body) && !is_held(forced);
        }
        late_ = late_ || forced.late;
    }
}

void StateDependentForces::begin(double time, double span)
{
    time_ = time;
    span_ = span;
    find_accelerations(time, true);
    for (ForcedBody& forced : forced_bodies_) {
        const double share = forced.late ? 0.5 * span : span;
        const auto pull =
            (forced.stiff ? stiff_law_ : soft_law_).acceleration_of(forced.place, share);
        forced.gained = share * pull.linear;
        if (forced.falls_late) forced.gained -= 0.5 * fall_of(forced);
        forced.gained_spin = share * pull.angular;
    }
    look_stiff();
    for (std::size_t i = 0; i < stiff_.size(); ++i) give_stiff(i, stiff_[i].begin(time, span));
}

void StateDependentForces::again()
{
    clear();
    look_stiff_speeds();
    for (std::size_t i = 0; i < stiff_.size(); ++i) give_stiff(i, stiff_[i].again());
}

void StateDependentForces::end()
{
    find_accelerations(time_ + span_, false);
    clear();
    for (ForcedBody& forced : forced_bodies_) {
        if (!forced.late) continue;
        const auto pull =
            (forced.stiff ? stiff_law_ : soft_law_).acceleration_of(forced.place, 0.5 * span_);
        forced.gained = 0.5 * span_ * pull.linear;
        if (forced.falls_late) forced.gained += 0.5 * fall_of(forced);
        forced.gained_spin = 0.5 * span_ * pull.angular;
    }
    look_stiff_speeds();
    for (std::size_t i = 0; i < stiff_.size(); ++i) give_stiff(i, stiff_[i].end());
}

// Stiff springs see what else has acted already.
void StateDependentForces::look_stiff()
{
    for (std::size_t i = 0; i < stiff_.size(); ++i)
        for (std::size_t k = 0; k < members_[i].size(); ++k) {
            const ForcedBody& forced = forced_bodies_[members_[i][k]];
            SpringBody& body = stiff_[i].bodies()[k];
            body.position = forced.pose.position;
            body.turn = forced.pose.orientation.toRotationMatrix();
            body.axis = forced.axis;
            body.carries = forced.carries;
            body.inverse_inertia = Mat3::Zero();
            if (context_.has(Effect::rotation))
                body.inverse_inertia = in_world_axes(facts_.masses.inverse_inertia[forced.body],
                                                     forced.pose.orientation)
                                           .matrix();
        }
    look_stiff_speeds();
}

void StateDependentForces::look_stiff_speeds()
{
    for (std::size_t i = 0; i < stiff_.size(); ++i)
        for (std::size_t k = 0; k < members_[i].size(); ++k) {
            const ForcedBody& forced = forced_bodies_[members_[i][k]];
            SpringBody& body = stiff_[i].bodies()[k];
            body.velocity = forced.velocity + forced.gained;
            body.spin = forced.spin + forced.gained_spin;
        }
}

void StateDependentForces::give_stiff(std::size_t group, std::span<const StiffSprings::Six> change)
{
    for (std::size_t k = 0; k < change.size(); ++k) {
        ForcedBody& forced = forced_bodies_[members_[group][k]];
        forced.gained += change[k].linear;
        forced.gained_spin += change[k].angular;
    }
}

void StateDependentForces::clear()
{
    for (ForcedBody& forced : forced_bodies_) forced.gained = forced.gained_spin = Vec3::Zero();
}

}  // namespace throng
