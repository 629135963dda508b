#include "pipeline/solvers/island_solver.hpp"

#include "kernels/math/rotation.hpp"
#include "kernels/solver/carried_points.hpp"
#include "kernels/solver/driven_contacts.hpp"

namespace throng {

namespace {

// The share of the overlap that a substep takes away.
constexpr double kPartShare = 0.5;
constexpr int kPartTries = 3;
// How often contacts and stiff springs take turns in a substep: each sees what the other gave the
// time before.
constexpr int kSpringTurns = 4;
// Share of the steps of a solve that each still has when those of the whole step are spent.
constexpr int kFewSteps = 6;

}  // namespace

double rounding_of_work(std::span<const DirectPoint> points,
                        std::span<const DirectBody> before,
                        std::span<const DirectBody> after)
{
    double size = 0;
    for (const DirectPoint& point : points) {
        const double speed = relative_velocity(point, before).norm();
        size =
            std::max(size, point.impulse.norm() * (speed + relative_velocity(point, after).norm()));
    }
    return Impacts::kRounding * size;
}

Vec3 IslandSolver::arm_now(const Vec3& arm, std::int32_t index, const Vec3& round) const
{
    if (index < 0) return arm + round;
    return bodies_[static_cast<std::size_t>(index)].turned * arm + round;
}

Vec3 IslandSolver::moved(std::int32_t index) const
{
    return index < 0 ? Vec3(Vec3::Zero()) : bodies_[static_cast<std::size_t>(index)].moved;
}

// By the arms that place_points() last found.
double IslandSolver::separation_now(std::size_t at) const
{
    const IslandContact& contact = contacts_[at];
    const DirectPoint& point = points_[at];
    const Vec3 by_a =
        moved(contact.a) + point.arm_a - contact.arm_a - Vec3(contact.normal * contact.round_a);
    const Vec3 by_b =
        moved(contact.b) + point.arm_b - contact.arm_b + Vec3(contact.normal * contact.round_b);
    return contact.separation + contact.normal.dot(by_b - by_a);
}

// Arms and separations by where the bodies are now; of rims by where they are that time ahead.
void IslandSolver::place_points(double ahead)
{
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        const IslandContact& contact = contacts_[i];
        DirectPoint& point = points_[i];
        if (contact.rolls_flat != RollsFlat::no
            && place_rolling(contact, ahead, point, separations_[i]))
            continue;
        point.normal = contact.normal;
        const Vec3 round_a = contact.normal * contact.round_a,
                   round_b = -contact.normal * contact.round_b;
        point.arm_a = arm_now(contact.arm_a, contact.a, round_a);
        point.arm_b = arm_now(contact.arm_b, contact.b, round_b);
        separations_[i] = separation_now(i);
    }
    find_walks();
}

// False where the flat side goes too far.
bool IslandSolver::place_rolling(const IslandContact& contact,
                                 double ahead,
                                 DirectPoint& point,
                                 double& separation) const
{
    const auto turned = [&](std::int32_t index) -> Quat {
        return index < 0 ? Quat(Quat::Identity()) : bodies_[static_cast<std::size_t>(index)].turned;
    };
    const Vec3 offset = contact.center_offset + moved(contact.a) - moved(contact.b);
    const MovedContact now{contact.normal,  contact.arm_a,      contact.arm_b,    contact.round_a,
                           contact.round_b, contact.rolls_flat, contact.rim,      true,
                           offset,          turned(contact.a),  turned(contact.b)};
    const auto spin = [&](std::int32_t index) -> Vec3 {
        return index < 0 ? Vec3(Vec3::Zero()) : after_[static_cast<std::size_t>(index)].spin;
    };
    // Who may bounce does so as the substep begins.
    const bool goes_on = ahead > 0 && !(contact.restitution > 0);
    const PlacedContact placed = goes_on && contact.rim.radius > 0
        ? place_ahead(now, spin(contact.a), spin(contact.b), ahead)
        : place(now);
    point.normal = placed.normal;
    point.arm_a = placed.arm_a;
    point.arm_b = placed.arm_b;
    separation = placed.separation;
    if (contact.rim.radius > 0) return !is_far(now, placed);
    const Quat& flat = contact.rolls_flat == RollsFlat::a ? now.turn_a : now.turn_b;
    return flat.vec().norm() <= kFarthestFlatTurn / 2 && placed.rolled <= kFarthestFlatRoll;
}

// Who is driven walks on what bears it: see driven_contacts.hpp. By the arms as they are.
void IslandSolver::find_walks()
{
    for (const IslandWalk& walk : walks_) {
        const IslandContact& contact = contacts_[walk.contact];
        DirectPoint& point = points_[walk.contact];
        const auto rolls = [&](bool is_b) {
            const auto index = static_cast<std::size_t>(is_b ? contact.b : contact.a);
            return (is_b ? contact.round_b : contact.round_a) > 0
                && !(inverse_inertia_[index] == Sym3{});
        };
        const auto velocity = [&](bool is_b) -> Vec3 {
            const std::int32_t index = is_b ? contact.b : contact.a;
            if (index < 0) return Vec3::Zero();
            const DirectBody& body = after_[static_cast<std::size_t>(index)];
            if (!spins_) return body.velocity;
            return body.velocity + body.spin.cross(is_b ? point.arm_b : point.arm_a);
        };
        point.walk = walk_of(walk.by_a, walk.by_b, point.normal, up_, rolls, velocity);
    }
}

// Who is carried by a surface that turns by itself meets it where the middle of the coming time
// finds the two, as the carried contacts of the other solvers do (SurfaceVelocityWide).
void IslandSolver::carry_arms(double half, double dt)
{
    const auto carried_by = [&](std::int32_t carrier, std::int32_t carried) {
        if (carrier < 0) return false;
        const DirectBody& body = after_[static_cast<std::size_t>(carrier)];
        const InverseMass other = carried < 0
            ? InverseMass{}
            : inverse_mass_of(after_[static_cast<std::size_t>(carried)]);
        return carries(body.spin, inverse_mass_of(body), other, dt);
    };
    const auto side = [&](std::int32_t index, const Vec3& core) -> CarriedSide {
        if (index < 0) return {};
        const auto at = static_cast<std::size_t>(index);
        return carried_side(bodies_[at].moved, bodies_[at].turned, after_[at], core, half);
    };
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        const IslandContact& contact = contacts_[i];
        const bool by_a = carried_by(contact.a, contact.b);
        if (!by_a && !carried_by(contact.b, contact.a)) continue;
        points_[i].arm_a = contact.arm_a + contact.normal * contact.round_a;
        points_[i].arm_b = contact.arm_b - contact.normal * contact.round_b;
        throng::carry_arms(side(contact.a, contact.arm_a), side(contact.b, contact.arm_b),
                           goes_with_b(contact.round_a, contact.round_b, by_a), points_[i]);
    }
    find_walks();
}

// Into world axes, as the bodies are turned now.
void IslandSolver::turn_inertias()
{
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (!bodies_[i].dynamic) continue;
        after_[i].inverse_inertia =
            in_world_axes(inverse_inertia_[i], bodies_[i].turned * bodies_[i].orientation);
    }
}

// The spin that a body has after the substep with nothing but what turns it in the air.
Vec3 IslandSolver::turned_freely(std::size_t at,
                                 const Vec3& spin,
                                 const StepContext& context,
                                 double time) const
{
    const IslandBody& island_body = bodies_[at];
    const Vec3 pushed = spin + island_body.angular_acceleration * time;
    if (!island_body.precesses || context.gyroscopic == Gyroscopic::off) return pushed;
    const auto torque = context.gyroscopic == Gyroscopic::implicit
        ? after_gyroscopic_torque
        : after_explicit_gyroscopic_torque;
    return torque(pushed, inertia_[at], island_body.turned * island_body.orientation, time);
}

// What a substep does to the bodies besides contacts.
void IslandSolver::move_freely(const StepContext& context, double time)
{
    before_ = after_;
    turn_inertias();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const IslandBody& island_body = bodies_[i];
        DirectBody& body = after_[i];
        if (!island_body.dynamic) continue;
        if (context.has(Effect::gravity) && body.inverse_mass > 0)
            body.velocity += context.gravity * time;
        body.velocity += island_body.acceleration * time;
        body.spin = turned_freely(i, body.spin, context, time);
    }
    begin_state_forces(time);
    free_ = after_;
}

void IslandSolver::update_forced_bodies()
{
    for (ForcedBody& forced : state_forces_->forced_bodies()) {
        const IslandBody& island_body = bodies_[forced.at];
        forced.pose = {island_body.position + island_body.moved,
                       island_body.turned * island_body.orientation};
        forced.velocity = after_[forced.at].velocity;
        forced.spin = after_[forced.at].spin;
    }
}

void IslandSolver::move_forced_bodies(std::vector<DirectBody>& bodies) const
{
    for (const ForcedBody& forced : state_forces_->forced_bodies()) {
        bodies[forced.at].velocity += forced.gained;
        bodies[forced.at].spin += forced.gained_spin;
    }
}

void IslandSolver::begin_state_forces(double time)
{
    if (!state_forces_) return;
    update_forced_bodies();
    state_forces_->begin(elapsed_, time);
    move_forced_bodies(after_);
}

// False where nothing acts after bodies moved.
bool IslandSolver::end_state_forces()
{
    if (!state_forces_ || !state_forces_->late()) return false;
    update_forced_bodies();
    state_forces_->end();
    move_forced_bodies(after_);
    return true;
}

// The speed at which those apart come to touch as the substep ends: below 0; of others 0.
double IslandSolver::closing_in(std::size_t at, double time) const
{
    return -std::max(separations_[at], 0.0) / time;
}

// Contacts, and stiff springs with them, which have the last word: see solve_batch.cpp.
void IslandSolver::hold_contacts(const StepContext&, double time)
{
    for (std::size_t i = 0; i < points_.size(); ++i) points_[i].least = closing_in(i, time);
    solve(after_, points_);
    if (!state_forces_ || !state_forces_->stiff()) return;
    for (int turn = 1;; ++turn) {
        update_forced_bodies();
        state_forces_->again();
        if (turn == kSpringTurns) return move_forced_bodies(after_);
        move_forced_bodies(free_);
        after_ = free_;
        solve(after_, points_);
    }
}

// What acts after bodies moved, contacts answer then.
void IslandSolver::answer_late_forces(const StepContext&, double time)
{
    if (!end_state_forces()) return;
    place_points();
    others_ = points_;
    for (std::size_t i = 0; i < others_.size(); ++i) {
        others_[i].least = closing_in(i, time);
        others_[i].impulse = others_[i].torque = Vec3::Zero();
    }
    solve(after_, others_);
    for (std::size_t i = 0; i < points_.size(); ++i) {
        points_[i].impulse += others_[i].impulse;
        points_[i].torque += others_[i].torque;
    }
}

void IslandSolver::solve(std::vector<DirectBody>& bodies, std::vector<DirectPoint>& points)
{
    asked_ = bodies;
    residual_ = std::max(residual_, ask(bodies, points));
    take_back_energy(bodies, points);
}

// Points that throw nobody back give no energy. Where a solve left off too early they may have: of
// somebody heavy on somebody light all that there is, at a residual that tells nothing of it. Of
// its impulses so much stays then as leaves the least.
void IslandSolver::take_back_energy(std::vector<DirectBody>& bodies,
                                    std::vector<DirectPoint>& points) const
{
    const auto throws_back = [](const DirectPoint& point) { return point.least > 0; };
    if (std::any_of(points.begin(), points.end(), throws_back)) return;
    const double work = work_of(points, asked_, bodies);
    if (!(work > rounding_of_work(points, asked_, bodies))) return;
    const double at_first = work_of(points, asked_, asked_);
    leave_share(std::clamp(at_first / (2 * (at_first - work)), 0.0, 1.0), asked_, points, bodies);
}

// The residual of one more solve. Those of a step together may take as many steps as two a
// substep, and two more, may at most; from then on each has a few.
double IslandSolver::ask(std::vector<DirectBody>& bodies, std::vector<DirectPoint>& points)
{
    DirectEffort effort = effort_;
    effort.steps = std::clamp(left_, (effort.steps + kFewSteps - 1) / kFewSteps, effort.steps);
    const DirectAnswer answer = solver_.solve(bodies, points, effort);
    left_ -= std::min(left_, answer.steps);
    return answer.residual;
}

// Speed along the normal, of b against a.
double IslandSolver::approach(std::size_t at, std::span<const DirectBody> bodies) const
{
    return relative_normal_velocity(points_[at], bodies);
}

// Who overlaps is moved apart in this substep, on top of what else it does.
void IslandSolver::push_out_of_overlap(const StepContext& context, double time)
{
    const double most = parameters_.push_limit;
    going_ = after_;
    bool any = false;
    others_ = points_;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        if (!(separations_[i] < -contacts_[i].tolerance)) continue;
        any = true;
        others_[i].least = std::min(most, -separations_[i] * kPartShare / time);
    }
    if (!any || !(most > 0)) return;
    push_as_far_as_goes();
    leave_push_to_springs(context, time);
}

// Who is wedged between what does not move cannot part from all of it: each point is then asked
// for what a try at the whole came to, which can be had. What is still asked for in vain is no law
// of contact that was missed, and no residual: at rest it would be all there is to compare with.
void IslandSolver::push_as_far_as_goes()
{
    const int most = effort_.pivots ? kPartTries : 1;
    for (int tries = 1;; ++tries) {
        going_ = free_;
        const double residual = ask(going_, others_);
        if (residual <= kDirectResidual || tries >= most) return;
        for (std::size_t i = 0; i < others_.size(); ++i)
            others_[i].least = std::min(others_[i].least, std::max(0.0, approach(i, going_)));
    }
}

void IslandSolver::advance_bodies(const StepContext&, double time)
{
    elapsed_ += time;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (!bodies_[i].advances) continue;
        bodies_[i].moved += going_[i].velocity * time;
        const Quat turn = exponential(going_[i].spin * time);
        bodies_[i].turned = turn * bodies_[i].turned;
        // Turned otherwise than it spins, it keeps the spin that it has in its own axes: of a
        // needle whose spin stayed where it was a share would become tumbling.
        if (bodies_[i].precesses && after_[i].spin != going_[i].spin)
            after_[i].spin = turn * after_[i].spin;
    }
}

// Where contacts are now. Those of the direct solver turn with who is carried, to the middle of the
// substep.
void IslandSolver::place_contacts(const StepContext& context, double time)
{
    const bool impulses = context.response == Response::impulse;
    place_points(impulses ? time / 2 : 0);
    if (impulses) carry_arms(time / 2, context.dt);
}

// What a substep goes through, in order. Who bounces does so as it begins, and goes on as he
// leaves: stopped where he touches, he would lose the rest of the substep's way, and with it
// height.
std::span<const IslandSolver::IslandPass> IslandSolver::passes_of(Response response)
{
    using enum Effect;
    using enum When;
    static constexpr IslandPass kDirect[] = {
        pass<&IslandSolver::place_contacts>({contact}, each_substep),
        pass<&IslandSolver::open_energy_limiter>({springs}, each_substep),
        pass<&IslandSolver::move_freely>({contact}, each_substep),
        pass<&IslandSolver::hold_contacts>({contact}, each_substep),
        pass<&IslandSolver::apply_restitution>({restitution}, each_substep),
        pass<&IslandSolver::push_out_of_overlap>({contact}, each_substep),
        pass<&IslandSolver::advance_bodies>({contact}, each_substep),
        pass<&IslandSolver::answer_late_forces>(kFollowBodies, each_substep),
        pass<&IslandSolver::close_energy_limiter>({springs}, each_substep),
    };
    static constexpr IslandPass kPenalty[] = {
        pass<&IslandSolver::cut_substep>({contact}, each_substep),
        pass<&IslandSolver::throw_back>({contact}, each_part),
        pass<&IslandSolver::move_freely>({contact}, each_part),
        pass<&IslandSolver::apply_penalty_forces>({contact}, each_part),
        pass<&IslandSolver::advance_bodies>({contact}, each_part),
    };
    static constexpr IslandPass kKinematic[] = {
        pass<&IslandSolver::place_contacts>({contact}, each_substep),
        pass<&IslandSolver::move_freely>({contact}, each_substep),
        pass<&IslandSolver::stop_approaches>({contact}, each_iteration),
        pass<&IslandSolver::advance_bodies>({contact}, each_substep),
        pass<&IslandSolver::stop_late_approaches>(kFollowBodies, each_iteration),
        pass<&IslandSolver::push_out>({contact}, each_iteration),
    };
    switch (response) {
    case Response::penalty:
        return kPenalty;
    case Response::kinematic:
        return kKinematic;
    case Response::impulse:
        break;
    }
    return kDirect;
}

void IslandSolver::substep(const StepContext& context)
{
    const std::span<const IslandPass> passes = passes_of(context.response);
    const auto run = [&](bool parts, double time) {
        for (const IslandPass& pass : passes)
            if ((pass.when == When::each_part) == parts
                && pass.called_for_by.meets(context.effects))
                (this->*pass.run)(context, time);
    };
    cuts_ = 1;
    run(false, context.substep());
    const int cuts = cuts_;
    most_cuts_ = std::max(most_cuts_, cuts);
    for (int cut = 0; cut < cuts; ++cut) run(true, context.substep() / cuts);
}

std::vector<PassRow> direct_passes() { return rows_of(IslandSolver::passes_of(Response::impulse)); }
std::vector<PassRow> penalty_passes()
{
    return rows_of(IslandSolver::passes_of(Response::penalty));
}
std::vector<PassRow> kinematic_passes()
{
    return rows_of(IslandSolver::passes_of(Response::kinematic));
}

}  // namespace throng
