#include "pipeline/forces/energy_limiter.hpp"

#include "kernels/math/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

// What is gained up to this share of the kinetic energy that bodies have among them is let be.
constexpr double kLetBe = 1e-4;

constexpr std::uint32_t kNoGroup = 0xffffffffu;

// Bodies that a blow goes through.
constexpr std::size_t kFewestInBlow = 3;

template <class Real>
Vec3 in_double(const Real* v)
{
    return {double{v[0]}, double{v[1]}, double{v[2]}};
}

template <class Real>
void scale_lane(Lane16<Real>& number, std::size_t lane, Real share)
{
    number.at[lane] *= share;
}

}  // namespace

bool is_fed(const Forces& forces, std::uint32_t body)
{
    const auto has = [&](const std::vector<Vec3>& of_bodies) {
        return body < of_bodies.size() && !of_bodies[body].isZero(0);
    };
    return forces.field || !forces.attractors.empty() || has(forces.force) || has(forces.torque)
        || forces.on_pivot(body) || (!forces.linear_drag.empty() && !forces.wind.isZero(0));
}

double share_kept(double gained, double among_them, double rounding)
{
    if (!(gained > kLetBe * among_them + rounding)) return 1;
    return gained < among_them ? std::sqrt(1 - gained / among_them) : 0;
}

template <class Real>
bool may_gain(std::span<const SolverBody<Real>> bodies, bool one_island, double speed)
{
    // As four numbers, of which the last is 0: this is asked about everybody in every substep.
    const auto more = [](const SolverBody<Real>& body) {
        using Four = Eigen::Map<const Eigen::Array<Real, 4, 1>>;
        const Four motion(body.motion), free(body.free);
        return ((motion - free) * (motion + free)).sum();
    };
    const Real least = static_cast<Real>(speed * speed);
    std::size_t gainers = 0;
    for (const SolverBody<Real>& body : bodies) gainers += more(body) > least ? 1 : 0;
    if (gainers < kFewestInBlow || !one_island) return gainers >= kFewestInBlow;
    double gained = 0;
    for (const SolverBody<Real>& body : bodies)
        if (body.inertia[0] > 0) gained += double{more(body) - least} / double{body.inertia[0]};
    return gained > 0;
}

template bool may_gain<float>(std::span<const SolverBody<float>>, bool, double);
template bool may_gain<double>(std::span<const SolverBody<double>>, bool, double);

// Bodies of a batch, by which of them touch or are joined.
template <class Real>
class EnergyLimiter<Real>::Sets {
public:
    Sets(const Layout& layout, const Batch& batch, const StateDependentForces* springs)
        : layout_(layout), springs_(springs)
    {
        const auto slices = layout.slices_of(batch);
        first_ = slices.front().first_body;
        bodies_ = slices.back().first_body + slices.back().dynamic - first_;
        from_ = layout.blocks_of(slices.front()).begin * kBlock;
        to_ = layout.blocks_of(slices.back()).end * kBlock;
        sets_.reset(bodies_);
        for (std::size_t lane = from_; lane < to_; ++lane) {
            const std::int32_t a = layout.solver_index_a[lane], b = layout.solver_index_b[lane];
            if (layout.movable(a) && layout.movable(b)) sets_.join(place(a), place(b));
        }
        if (springs != nullptr)
            for (const auto& joined : springs->joined())
                for (const std::uint32_t other : joined) sets_.join(of(joined[0]), of(other));
        group_of_.assign(bodies_, kNoGroup);
    }

    void list_springs(std::vector<Group>& groups)
    {
        for (std::uint32_t i = 0; i < springs_->joined().size(); ++i)
            group_with(of(springs_->joined()[i][0]), groups).springs.push_back(i);
    }

    // Of at least so many bodies.
    void list_touching(std::size_t fewest, std::vector<Group>& groups)
    {
        std::vector<std::uint32_t> sizes(bodies_);
        for (std::uint32_t at = 0; at < bodies_; ++at)
            if (++sizes[sets_.find(at)] == fewest) group_with(at, groups);
    }

    void list_members(const RigidFacts& facts, std::vector<Group>& groups)
    {
        for (std::uint32_t at = 0; at < bodies_; ++at) {
            const std::uint32_t place = group_of_[sets_.find(at)];
            if (place == kNoGroup) continue;
            Group& group = groups[place];
            const std::uint32_t body = layout_.body_of_solver_index[first_ + at];
            const double inverse_mass = facts.masses.inverse_mass[body];
            const Sym3 inertia =
                in_world_axes(facts.masses.inertia[body], facts.poses.orientation[body]);
            group.members.push_back(
                {first_ + at, inverse_mass > 0 ? 1 / inverse_mass : 0, inertia.matrix()});
            group.fed = group.fed || throng::is_fed(facts.forces, body);
            group.floats = group.floats && inverse_mass > 0;
            group.turns = group.turns || inverse_mass == 0;
            group.weighs += facts.masses.mass[body];
        }
    }

    void list_lanes(std::vector<Group>& groups)
    {
        for (std::size_t lane = from_; lane < to_; ++lane) {
            const std::int32_t a = layout_.solver_index_a[lane], b = layout_.solver_index_b[lane];
            const bool a_moves = layout_.movable(a), b_moves = layout_.movable(b);
            if (!a_moves && !b_moves) continue;
            const std::uint32_t place_of_group = group_of_[sets_.find(place(a_moves ? a : b))];
            if (place_of_group == kNoGroup) continue;
            Group& group = groups[place_of_group];
            group.lanes.push_back(static_cast<std::uint32_t>(lane));
            if (a_moves && b_moves) continue;
            group.floats = false;
            group.driven = group.driven || (a_moves ? b : a) > 0;
        }
    }

private:
    Group& group_with(std::uint32_t at, std::vector<Group>& groups)
    {
        std::uint32_t& group = group_of_[sets_.find(at)];
        if (group == kNoGroup) {
            group = static_cast<std::uint32_t>(groups.size());
            groups.emplace_back();
        }
        return groups[group];
    }
    std::uint32_t place(std::int32_t solver_index) const
    {
        return static_cast<std::uint32_t>(solver_index) - first_;
    }
    std::uint32_t of(std::uint32_t forced) const
    {
        return layout_.solver_index[springs_->forced_bodies()[forced].body] - first_;
    }

    const Layout& layout_;
    const StateDependentForces* springs_;
    std::uint32_t first_ = 0, bodies_ = 0;  // among the solver bodies
    std::size_t from_ = 0, to_ = 0;         // lanes
    DisjointSets sets_;
    std::vector<std::uint32_t> group_of_;  // [bodies] of the first of a set
};

template <class Real>
EnergyLimiter<Real>::EnergyLimiter(const Layout& layout,
                                   const Batch& batch,
                                   const RigidFacts& facts,
                                   const StateDependentForces* springs,
                                   Whose whose,
                                   const Vec3& fall)
    : springs_(springs), calls_(batch.calls), fall_(fall)
{
    Sets sets(layout, batch, springs);
    if (springs != nullptr) sets.list_springs(groups_);
    if (whose != Whose::on_springs)
        sets.list_touching(whose == Whose::stacked ? kFewestInBlow : 1, groups_);
    sets.list_members(facts, groups_);
    sets.list_lanes(groups_);
    std::erase_if(groups_, [&](const Group& group) {
        return group.driven || (whose == Whose::turning && !group.turns);
    });
    for (Group& group : groups_) group.watched = whose != Whose::stacked;
}

template <class Real>
double EnergyLimiter<Real>::kinetic_of(const Group& group,
                                       const ContactConstraints<Real>& constraints)
{
    double twice = 0;
    for (const Member& member : group.members) {
        const SolverBody<Real>& body = constraints.bodies[member.solver_index];
        const Vec3 spin = in_double(body.motion + 4);
        twice += member.mass * in_double(body.motion).squaredNorm();
        twice += spin.dot(member.inertia * spin);
    }
    return twice / 2;
}

template <class Real>
double EnergyLimiter<Real>::given_by_contacts(const Group& group,
                                              const ContactConstraints<Real>& constraints)
{
    double twice = 0;
    for (const Member& member : group.members) {
        const SolverBody<Real>& body = constraints.bodies[member.solver_index];
        const Vec3 velocity = in_double(body.motion), spin = in_double(body.motion + 4);
        const Vec3 free = in_double(body.free), free_spin = in_double(body.free + 4);
        twice += member.mass * (velocity - free).dot(velocity + free)
            + (spin - free_spin).dot(member.inertia * (spin + free_spin));
    }
    return twice / 2;
}

template <class Real>
void EnergyLimiter<Real>::open(const ContactConstraints<Real>& constraints)
{
    for (Group& group : groups_) {
        if (group.springs.empty()) continue;
        group.kinetic = kinetic_of(group, constraints);
        for (Member& member : group.members)
            member.before = in_double(constraints.bodies[member.solver_index].motion);
    }
}

// Along the impulses the kinetic energy is what it is without them + along s + square s^2.
template <class Real>
typename EnergyLimiter<Real>::WarmStart
EnergyLimiter<Real>::warm_start_of(const Group& group, const ContactConstraints<Real>& constraints)
{
    double along = 0, square = 0;
    for (const Member& member : group.members) {
        const SolverBody<Real>& body = constraints.bodies[member.solver_index];
        const Vec3 velocity = in_double(body.free), spin = in_double(body.free + 4);
        const Vec3 given = in_double(body.motion) - velocity;
        const Vec3 turned = in_double(body.motion + 4) - spin;
        const Vec3 momentum = member.inertia * turned;
        along += member.mass * given.dot(velocity) + momentum.dot(spin);
        square += (member.mass * given.squaredNorm() + momentum.dot(turned)) / 2;
    }
    const bool less = 2 * square + along > 0;
    return {less ? std::clamp(-along / (2 * square), 0.0, 1.0) : 1, along + square};
}

template <class Real>
void EnergyLimiter<Real>::scale(const Group& group,
                                Real share,
                                ContactConstraints<Real>& constraints) const
{
    const bool at_points =
        calls_.effects.has(Effect::friction) && !constraints.point_frictions.empty();
    for (const Member& member : group.members) {
        SolverBody<Real>& body = constraints.bodies[member.solver_index];
        for (int k = 0; k < 8; ++k)
            body.motion[k] = body.free[k] + share * (body.motion[k] - body.free[k]);
    }
    for (const std::uint32_t place : group.lanes) {
        const std::size_t at = place / kBlock, lane = place % kBlock;
        ContactConstraintWide<Real>& block = constraints.blocks[at];
        for (auto& impulse : block.friction_impulse) scale_lane(impulse, lane, share);
        scale_lane(block.torsional_impulse, lane, share);
        for (std::size_t k = 0; k < static_cast<std::size_t>(block.points); ++k) {
            const std::size_t point = block.first_point + k;
            scale_lane(constraints.points[point].impulse, lane, share);
            if (!at_points) continue;
            for (auto& impulse : constraints.point_frictions[point].impulse)
                scale_lane(impulse, lane, share);
        }
        if (!calls_.effects.has(Effect::rolling_friction)) continue;
        for (auto& impulse : constraints.rolling_frictions[at].impulse)
            scale_lane(impulse, lane, share);
    }
}

template <class Real>
void EnergyLimiter<Real>::take_share(ContactConstraints<Real>& constraints) const
{
    for (const Group& group : groups_) {
        const double share = warm_start_of(group, constraints).share;
        if (share < 1) scale(group, static_cast<Real>(share), constraints);
    }
}

template <class Real>
void EnergyLimiter<Real>::take_share_of_blow(double speed,
                                             std::pair<std::size_t, std::size_t> island,
                                             ContactConstraints<Real>& constraints)
{
    for (Group& group : groups_) {
        const std::uint32_t first = group.members.front().solver_index;
        if (first < island.first || first >= island.second) continue;
        group.watched = true;
        if (group.members.size() < kFewestInBlow) continue;
        const WarmStart start = warm_start_of(group, constraints);
        if (start.gained > group.mass() * speed * speed / 2)
            scale(group, static_cast<Real>(start.share), constraints);
    }
}

template <class Real>
void EnergyLimiter<Real>::open_free(ContactConstraints<Real>& constraints)
{
    for (Group& group : groups_) {
        for (Member& member : group.members) {
            const SolverBody<Real>& body = constraints.bodies[member.solver_index];
            member.free = in_double(body.free);
            member.free_spin = in_double(body.free + 4);
        }
        const WarmStart start = warm_start_of(group, constraints);
        if (counts(group, start.gained)) scale(group, static_cast<Real>(start.share), constraints);
    }
}

template <class Real>
void EnergyLimiter<Real>::add_to_free(const ContactConstraints<Real>& constraints, double times)
{
    for (Group& group : groups_) {
        for (Member& member : group.members) {
            const SolverBody<Real>& body = constraints.bodies[member.solver_index];
            member.free += times * in_double(body.motion);
            member.free_spin += times * in_double(body.motion + 4);
        }
    }
}

template <class Real>
bool EnergyLimiter<Real>::is_fed(const Group& group) const
{
    return group.fed || calls_.effects.has(Effect::drive)
        || std::any_of(group.springs.begin(), group.springs.end(),
                       [&](std::uint32_t i) { return springs_->springs_of(i).are_drawn(); });
}

// J, in motion and in springs, but for what gravity gave: half of the velocity before, half after.
template <class Real>
double EnergyLimiter<Real>::gained(const Group& group,
                                   double kinetic,
                                   const ContactConstraints<Real>& constraints) const
{
    double gained = kinetic - group.kinetic;
    for (const std::uint32_t i : group.springs) gained += springs_->springs_of(i).stored();
    for (const Member& member : group.members)
        gained -= member.mass
            * fall_.dot(member.before + in_double(constraints.bodies[member.solver_index].motion))
            / 2;
    return gained;
}

// What nothing holds keeps its momentum.
template <class Real>
Vec3 EnergyLimiter<Real>::common_velocity(const Group& group,
                                          const ContactConstraints<Real>& constraints) const
{
    Vec3 momentum = Vec3::Zero();
    const bool tied = std::any_of(group.springs.begin(), group.springs.end(), [&](std::uint32_t i) {
        return springs_->springs_of(i).are_tied();
    });
    if (tied || !group.floats) return momentum;
    double mass = 0;
    for (const Member& member : group.members) {
        momentum += member.mass * in_double(constraints.bodies[member.solver_index].motion);
        mass += member.mass;
    }
    return momentum / mass;
}

// With contacts and without, so that what contacts gave stays what it was.
template <class Real>
void EnergyLimiter<Real>::take_energy(const Group& group,
                                      double kinetic,
                                      double taken,
                                      ContactConstraints<Real>& constraints) const
{
    const Vec3 common = common_velocity(group, constraints);
    // What all of them go by together is not there to be taken.
    const double among_them = kinetic - group.mass() * common.squaredNorm() / 2;
    const double share =
        share_kept(taken, among_them, kinetic * std::numeric_limits<Real>::epsilon());
    if (!(share < 1)) return;
    for (const Member& member : group.members) {
        SolverBody<Real>& body = constraints.bodies[member.solver_index];
        for (int k = 0; k < 3; ++k) {
            const Real linear =
                static_cast<Real>((1 - share) * (common[k] - double{body.motion[k]}));
            const Real angular = static_cast<Real>((share - 1) * double{body.motion[4 + k]});
            for (Real* const motion : {body.motion, body.free}) {
                motion[k] += linear;
                motion[4 + k] += angular;
            }
        }
    }
}

template <class Real>
void EnergyLimiter<Real>::close(ContactConstraints<Real>& constraints) const
{
    for (const Group& group : groups_) {
        if (group.springs.empty() || is_fed(group)) continue;
        const double kinetic = kinetic_of(group, constraints);
        take_energy(group, kinetic, gained(group, kinetic, constraints), constraints);
    }
}

template <class Real>
void EnergyLimiter<Real>::limit_contacts(double slowest,
                                         const std::function<bool(std::uint32_t)>& wanted,
                                         ContactConstraints<Real>& constraints) const
{
    for (const Group& group : groups_) {
        if (!group.watched || !wanted(group.members.front().solver_index)) continue;
        const double given = given_by_contacts(group, constraints);
        if (!(given > 0)) continue;
        const double kinetic = kinetic_of(group, constraints);
        if (kinetic > group.mass() * slowest * slowest / 2)
            take_energy(group, kinetic, given, constraints);
    }
}

template <class Real>
void EnergyLimiter<Real>::close_free(ContactConstraints<Real>& constraints) const
{
    for (const Group& group : groups_) {
        double free = 0;
        for (const Member& member : group.members)
            free += (member.mass * member.free.squaredNorm()
                     + member.free_spin.dot(member.inertia * member.free_spin))
                / 2;
        const double kinetic = kinetic_of(group, constraints), gained = kinetic - free;
        if (counts(group, gained)) take_energy(group, kinetic, gained, constraints);
    }
}

// By more than gravity gives in a substep.
template <class Real>
bool EnergyLimiter<Real>::counts(const Group& group, double gained) const
{
    return gained > group.weighs * fall_.squaredNorm() / 2;
}

template class EnergyLimiter<float>;
template class EnergyLimiter<double>;

}  // namespace throng
