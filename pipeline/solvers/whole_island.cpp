#include "pipeline/solvers/whole_island.hpp"

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

Vec3 WholeIsland::arm_now(const Vec3& arm, std::int32_t seat, const Vec3& round) const
{
    if (seat < 0) return arm + round;
    return seats_[static_cast<std::size_t>(seat)].turned * arm + round;
}

// By the arms that place_points() last found.
double WholeIsland::gap_now(std::size_t at) const
{
    const auto moved = [&](std::int32_t seat) -> Vec3 {
        return seat < 0 ? Vec3(Vec3::Zero()) : seats_[static_cast<std::size_t>(seat)].moved;
    };
    const IslandTouch& touch = touches_[at];
    const DirectPoint& point = points_[at];
    const Vec3 by_a =
        moved(touch.a) + point.arm_a - touch.arm_a - Vec3(touch.normal * touch.round_a);
    const Vec3 by_b =
        moved(touch.b) + point.arm_b - touch.arm_b + Vec3(touch.normal * touch.round_b);
    return touch.gap + touch.normal.dot(by_b - by_a);
}

// Arms and gaps by where the bodies are now.
void WholeIsland::place_points()
{
    for (std::size_t i = 0; i < touches_.size(); ++i) {
        const IslandTouch& touch = touches_[i];
        DirectPoint& point = points_[i];
        const Vec3 round_a = touch.normal * touch.round_a, round_b = -touch.normal * touch.round_b;
        point.arm_a = arm_now(touch.arm_a, touch.a, round_a);
        point.arm_b = arm_now(touch.arm_b, touch.b, round_b);
        gaps_[i] = gap_now(i);
    }
    find_walks();
}

// Who is driven walks on what bears it: see driven_contacts.hpp. By the arms as they are.
void WholeIsland::find_walks()
{
    for (const IslandWalk& walk : walks_) {
        const IslandTouch& touch = touches_[walk.touch];
        DirectPoint& point = points_[walk.touch];
        const auto rolls = [&](bool is_b) {
            const auto seat = static_cast<std::size_t>(is_b ? touch.b : touch.a);
            return (is_b ? touch.round_b : touch.round_a) > 0
                && !(inverse_inertia_[seat] == Sym3{});
        };
        const auto velocity = [&](bool is_b) -> Vec3 {
            const std::int32_t seat = is_b ? touch.b : touch.a;
            if (seat < 0) return Vec3::Zero();
            const DirectBody& body = after_[static_cast<std::size_t>(seat)];
            if (!spins_) return body.velocity;
            return body.velocity + body.spin.cross(is_b ? point.arm_b : point.arm_a);
        };
        point.walk = walk_of(walk.by_a, walk.by_b, point.normal, up_, rolls, velocity);
    }
}

// Who is carried by a surface that turns by itself meets it where the middle of the coming time
// finds the two, as the carried contacts of the other solvers do (CarryRows).
void WholeIsland::carry_arms(double half, double dt)
{
    const auto carried_by = [&](std::int32_t carrier, std::int32_t carried) {
        if (carrier < 0) return false;
        const DirectBody& body = after_[static_cast<std::size_t>(carrier)];
        const Ease other =
            carried < 0 ? Ease{} : ease_of(after_[static_cast<std::size_t>(carried)]);
        return carries(body.spin, ease_of(body), other, dt);
    };
    const auto side = [&](std::int32_t seat, const Vec3& core) -> CarriedSide {
        if (seat < 0) return {};
        const auto at = static_cast<std::size_t>(seat);
        return carried_side(seats_[at].moved, seats_[at].turned, after_[at], core, half);
    };
    for (std::size_t i = 0; i < touches_.size(); ++i) {
        const IslandTouch& touch = touches_[i];
        const bool by_a = carried_by(touch.a, touch.b);
        if (!by_a && !carried_by(touch.b, touch.a)) continue;
        points_[i].arm_a = touch.arm_a + touch.normal * touch.round_a;
        points_[i].arm_b = touch.arm_b - touch.normal * touch.round_b;
        throng::carry_arms(side(touch.a, touch.arm_a), side(touch.b, touch.arm_b),
                           goes_with_b(touch.round_a, touch.round_b, by_a), points_[i]);
    }
    find_walks();
}

// Into world axes, as the bodies are turned now.
void WholeIsland::turn_inertias()
{
    for (std::size_t i = 0; i < seats_.size(); ++i) {
        if (!seats_[i].dynamic) continue;
        after_[i].inverse_inertia =
            in_world_axes(inverse_inertia_[i], seats_[i].turned * seats_[i].orientation);
    }
}

// What a substep does to the bodies besides contacts.
void WholeIsland::move_freely(const Conditions& conditions, double time)
{
    before_ = after_;
    turn_inertias();
    for (std::size_t i = 0; i < seats_.size(); ++i) {
        const IslandSeat& seat = seats_[i];
        DirectBody& body = after_[i];
        if (!seat.dynamic) continue;
        if (conditions.has(Effect::gravity) && body.inverse_mass > 0)
            body.velocity += conditions.gravity * time;
        body.velocity += seat.pull * time;
        body.spin += seat.twist * time;
        if (!seat.precesses || conditions.settings.gyroscopic == Gyroscopic::off) continue;
        const auto torque = conditions.settings.gyroscopic == Gyroscopic::implicit
            ? after_gyroscopic_torque
            : after_explicit_gyroscopic_torque;
        body.spin = torque(body.spin, inertia_[i], seat.turned * seat.orientation, time);
    }
    begin_following(time);
    free_ = after_;
}

void WholeIsland::look_at_followers()
{
    for (Follower& follower : following_->followers()) {
        const IslandSeat& seat = seats_[follower.at];
        follower.pose = {seat.position + seat.moved, seat.turned * seat.orientation};
        follower.velocity = after_[follower.at].velocity;
        follower.spin = after_[follower.at].spin;
    }
}

void WholeIsland::move_followers(std::vector<DirectBody>& bodies) const
{
    for (const Follower& follower : following_->followers()) {
        bodies[follower.at].velocity += follower.gained;
        bodies[follower.at].spin += follower.gained_spin;
    }
}

void WholeIsland::begin_following(double time)
{
    if (!following_) return;
    look_at_followers();
    following_->begin(elapsed_, time);
    move_followers(after_);
}

// False where nothing acts after bodies moved.
bool WholeIsland::end_following()
{
    if (!following_ || !following_->late()) return false;
    look_at_followers();
    following_->end();
    move_followers(after_);
    return true;
}

// Contacts, and stiff springs with them, which have the last word: see solve_batch.cpp.
void WholeIsland::hold_contacts(double time)
{
    for (std::size_t i = 0; i < points_.size(); ++i)
        points_[i].least = -std::max(gaps_[i], 0.0) / time;
    solve(after_, points_);
    if (!following_ || !following_->stiff()) return;
    for (int turn = 1;; ++turn) {
        look_at_followers();
        following_->again();
        if (turn == kSpringTurns) return move_followers(after_);
        move_followers(free_);
        after_ = free_;
        solve(after_, points_);
    }
}

// What acts after bodies moved, contacts answer then.
void WholeIsland::answer_late_forces(const Conditions& conditions)
{
    if (!end_following()) return;
    place_points();
    others_ = points_;
    for (std::size_t i = 0; i < others_.size(); ++i) {
        others_[i].least = -std::max(gaps_[i], 0.0) / conditions.substep();
        others_[i].impulse = others_[i].torque = Vec3::Zero();
    }
    solve(after_, others_);
    for (std::size_t i = 0; i < points_.size(); ++i) {
        points_[i].impulse += others_[i].impulse;
        points_[i].torque += others_[i].torque;
    }
}

void WholeIsland::solve(std::vector<DirectBody>& bodies, std::vector<DirectPoint>& points)
{
    residual_ = std::max(residual_, ask(bodies, points));
}

// The residual of one more solve. Those of a step together may take as many steps as one a
// substep, and two more, may at most; from then on each has a few.
double WholeIsland::ask(std::vector<DirectBody>& bodies, std::vector<DirectPoint>& points)
{
    DirectEffort effort = effort_;
    effort.steps = std::clamp(left_, (effort.steps + kFewSteps - 1) / kFewSteps, effort.steps);
    const DirectAnswer answer = solver_.solve(bodies, points, effort);
    left_ -= std::min(left_, answer.steps);
    return answer.residual;
}

// Speed along the normal, of b against a.
double WholeIsland::approach(std::size_t at, std::span<const DirectBody> bodies) const
{
    return speed_apart(points_[at], bodies);
}

// Who overlaps is moved apart in this substep, on top of what else it does.
bool WholeIsland::part(const Conditions& conditions)
{
    const double time = conditions.substep(), most = conditions.settings.push_limit;
    bool any = false;
    others_ = points_;
    for (std::size_t i = 0; i < touches_.size(); ++i) {
        if (!(gaps_[i] < -touches_[i].tolerance)) continue;
        any = true;
        others_[i].least = std::min(most, -gaps_[i] * kPartShare / time);
    }
    if (!any || !(most > 0)) return false;
    push_as_far_as_goes();
    return true;
}

// Who is wedged between what does not move cannot part from all of it: each point is then asked
// for what a try at the whole came to, which can be had. What is still asked for in vain is no law
// of contact that was missed, and no residual: at rest it would be all there is to compare with.
void WholeIsland::push_as_far_as_goes()
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

void WholeIsland::advance(double time)
{
    elapsed_ += time;
    for (std::size_t i = 0; i < seats_.size(); ++i) {
        if (!seats_[i].advances) continue;
        seats_[i].moved += going_[i].velocity * time;
        const Quat turn = exponential(going_[i].spin * time);
        seats_[i].turned = turn * seats_[i].turned;
        // Turned otherwise than it spins, it keeps the spin that it has in its own axes: of a
        // needle whose spin stayed where it was a share would become tumbling.
        if (seats_[i].precesses && after_[i].spin != going_[i].spin)
            after_[i].spin = turn * after_[i].spin;
    }
}

void WholeIsland::substep(const Conditions& conditions)
{
    if (conditions.settings.response == Response::penalty) return penalise(conditions);
    if (conditions.settings.response == Response::kinematic) return separate(conditions);
    const double time = conditions.substep();
    place_points();
    carry_arms(time / 2, conditions.settings.dt);
    move_freely(conditions, time);
    hold_contacts(time);
    going_ = after_;
    part(conditions);
    if (bounce(conditions)) points_ = others_;
    advance(time);
    answer_late_forces(conditions);
}

}  // namespace throng
