#include "kernels/dynamics/stiff_springs.hpp"

#include "kernels/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Newton steps at most; most springs take two or three, those that turn far in a step ten. Each is
// halved so often where it leads away.
constexpr int kNewtonSteps = 30, kHalvings = 6;
// Of the energy of what springs give: below that nothing is missing; and to what share of what it
// was each of Newton's steps brings it.
constexpr double kFound = 1e-18, kSolved = 1e-8;
// Shares of what a spring would give that goes on as it began, tried where Newton's steps fail.
constexpr double kShares[] = {1, 0.5, 0.25, 0.125, 0};
// By how much where an end is may be off, of how far out it is.
constexpr double kRounding = 0x1p-50;
// How many times what its bodies resist with one holds that cannot be followed.
constexpr double kHeld = 1e6;
// Steps of conjugate gradients a body and besides: as many as there are numbers would do but for
// rounding.
constexpr std::size_t kStepsOfBody = 12, kStepsBeside = 60;

using Six = StiffSprings::Six;

double dot(const Six& a, const Six& b) { return a.linear.dot(b.linear) + a.angular.dot(b.angular); }

double dot(std::span<const Six> a, std::span<const Six> b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
    return sum;
}

void add(double share, std::span<const Six> from, std::span<Six> to)
{
    for (std::size_t i = 0; i < to.size(); ++i) {
        to[i].linear += share * from[i].linear;
        to[i].angular += share * from[i].angular;
    }
}

}  // namespace

StiffSprings::StiffSprings(const Forces& forces,
                           const Masses& masses,
                           const Poses& poses,
                           const Velocities& velocities,
                           std::span<const std::uint32_t> group)
    : forces_(forces), masses_(masses), poses_(poses), velocities_(velocities)
{
    for (const std::uint32_t body : group) {
        bodies_.emplace_back();
        bodies_.back().body = body;
        bodies_.back().inverse_mass = masses.inverse_mass[body];
    }
    turns_.reserve(bodies_.size());
    for (auto* const list : {&without_, &going_, &impulse_, &given_, &before_, &missing_, &step_,
                             &step_momentum_, &answer_, &change_})
        list->resize(bodies_.size());
}

// An end that is on none of the bodies.
Vec3 StiffSprings::outer_end(std::uint32_t body, const Vec3& at, double time) const
{
    if (body == kNoBody) return at;
    const Quat now = turned(poses_.orientation[body], velocities_.angular[body], time);
    return poses_.position[body] + time * velocities_.linear[body]
        + now * Vec3(forces_.pivot_to_center_of(body) + at);
}

StiffSprings::Row StiffSprings::row_of(const SpringForce& spring, double time) const
{
    Row row;
    row.spring = &spring;
    row.outer = Vec3::Zero();
    const auto end = [&](std::uint32_t id, const Vec3& at, double sign, std::int32_t& place,
                         Vec3& arm) -> Vec3 {
        const auto found = std::lower_bound(
            bodies_.begin(), bodies_.end(), id,
            [](const SpringBody& body, std::uint32_t wanted) { return body.body < wanted; });
        if (found != bodies_.end() && found->body == id) {
            place = static_cast<std::int32_t>(found - bodies_.begin());
            arm = found->turn * Vec3(forces_.pivot_to_center_of(id) + at);
            return found->position + arm;
        }
        arm = Vec3::Zero();
        const Vec3 now = outer_end(id, at, time);
        row.outer += sign * (outer_end(id, at, time + span_) - now);
        return now;
    };
    const Vec3 a = end(spring.a, spring.at_a, -1, row.a, row.arm_a);
    row.from = end(spring.b, spring.at_b, 1, row.b, row.arm_b) - a;
    return row;
}

// What a spring gives if the bodies go on as they do.
void StiffSprings::stretch(Row& row) const
{
    const auto moved = [&](std::int32_t place, const Vec3& arm, Vec3& end,
                           Mat3& lever_arm) -> Vec3 {
        if (place < 0) return Vec3::Zero();
        const auto i = static_cast<std::size_t>(place);
        end = turns_[i].after(arm);
        lever_arm = turns_[i].lever_arm(arm);
        return span_ * going_[i].linear + (end - arm);
    };
    const Vec3 by_a = moved(row.a, row.arm_a, row.end_a, row.lever_a);
    const Vec3 by_b = moved(row.b, row.arm_b, row.end_b, row.lever_b);
    row.to = row.from + row.outer + (by_b - by_a);
    const Vec3 &to = row.to, both = row.from + to;
    const double first = std::sqrt(row.from.squaredNorm()), last = std::sqrt(to.squaredNorm());
    const double mean = 0.5 * (first + last), half = 0.5 * span_, length = row.spring->length;
    row.elastic = row.damping = Vec3::Zero();
    row.stiffness.setZero();
    row.stored = row.spring->stiffness * (last - first) * (mean - length);
    // Ends that meet are drawn nowhere: which way, none could say.
    if (!(mean > 0)) {
        if (length == 0) row.stiffness = half * half * row.spring->stiffness * Mat3::Identity();
        return;
    }
    const Vec3 along = both / (2 * mean);
    row.elastic = half * row.spring->stiffness * (mean - length) * along;
    row.damping = 0.5 * row.spring->damping * (last - first) * along;
    // Across itself a spring holds by as much as it is drawn out; one that is pressed in gives way,
    // which is left out: it only tells Newton's step how far to go.
    const double across = std::max(0.0, 1 - length / mean), square = both.squaredNorm();
    const double k = half * half * row.spring->stiffness;
    row.stiffness = k * across * Mat3::Identity();
    if (square > 0)
        row.stiffness += (k * (1 - across) + half * row.spring->damping)
            * Mat3(both * both.transpose()) / square;
}

Vec3 StiffSprings::speed_between(const Row& row, std::span<const Six> speeds) const
{
    const auto speed = [&](std::int32_t place, const Mat3& lever_arm) -> Vec3 {
        if (place < 0) return Vec3::Zero();
        const Six& of = speeds[static_cast<std::size_t>(place)];
        return of.linear + lever_arm.transpose() * of.angular;
    };
    return speed(row.b, row.lever_b) - speed(row.a, row.lever_a);
}

// An impulse on a, and its opposite on b.
void StiffSprings::apply_impulse(const Row& row, const Vec3& impulse, std::span<Six> on) const
{
    const auto give = [&](std::int32_t place, const Mat3& lever_arm, double sign) {
        if (place < 0) return;
        Six& to = on[static_cast<std::size_t>(place)];
        to.linear += sign * impulse;
        to.angular += sign * Vec3(lever_arm * impulse);
    };
    give(row.a, row.lever_a, 1);
    give(row.b, row.lever_b, -1);
}

// What an impulse does to the velocities of a body.
Six StiffSprings::eased(std::size_t i, const Six& impulse) const
{
    return {bodies_[i].inverse_mass * impulse.linear, bodies_[i].inverse_inertia * impulse.angular};
}

// How easily an end of a spring gives way, summed over three directions, 1/kg.
double StiffSprings::inverse_mass_at(std::int32_t place, const Mat3& lever_arm) const
{
    if (place < 0) return 0;
    const SpringBody& body = bodies_[static_cast<std::size_t>(place)];
    return 3 * body.inverse_mass
        + (lever_arm.transpose() * Mat3(body.inverse_inertia * lever_arm)).trace();
}

// What springs give if the bodies go on as they do.
void StiffSprings::stretch_all()
{
    turns_.clear();
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        turns_.emplace_back(going_[i].angular, bodies_[i].axis, bodies_[i].carries, span_);
    for (Row& row : rows_) stretch(row);
}

// The velocities that the impulses come to, and what springs give then.
void StiffSprings::follow()
{
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Six gained = eased(i, impulse_[i]);
        going_[i] = {without_[i].linear + gained.linear, without_[i].angular + gained.angular};
    }
    stretch_all();
}

// Impulses that springs would give and have not. Returns the energy of it; none where it is hardly
// any beside that of what they gave, or no more than what rounding of places makes.
double StiffSprings::find_missing()
{
    double given = 0, rounding = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        missing_[i] = {-impulse_[i].linear, -impulse_[i].angular};
        given += dot(impulse_[i], eased(i, impulse_[i]));
    }
    for (const Row& row : rows_) {
        apply_impulse(row, row.elastic + row.damping, missing_);
        for (const std::int32_t place : {row.a, row.b}) {
            if (place < 0) continue;
            const SpringBody& body = bodies_[static_cast<std::size_t>(place)];
            const double off = kRounding * row.spring->stiffness * span_
                * std::sqrt(body.position.squaredNorm() + row.from.squaredNorm());
            rounding +=
                off * off * inverse_mass_at(place, place == row.a ? row.lever_a : row.lever_b);
        }
    }
    double lacking = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        lacking += dot(missing_[i], eased(i, missing_[i]));
    return lacking > std::max(rounding, kFound * given) ? lacking : 0 * lacking;
}

// (masses + rows' stiffness rows) change = missing, in the measure of the masses. Masses may be
// without end, so momenta are carried along beside the velocities.
void StiffSprings::conjugate_gradients()
{
    const std::size_t n = bodies_.size(), most = kStepsOfBody * n + kStepsBeside;
    std::vector<Six>& eased_missing = change_;
    const auto inverse_mass = [&] {
        for (std::size_t i = 0; i < n; ++i) eased_missing[i] = eased(i, missing_[i]);
    };
    inverse_mass();
    step_ = eased_missing;
    step_momentum_ = missing_;
    double square = dot(missing_, eased_missing);
    const double enough = kSolved * square;
    for (std::size_t k = 0; k < most && square > enough; ++k) {
        answer_ = step_momentum_;
        for (const Row& row : rows_)
            apply_impulse(row, -(row.stiffness * speed_between(row, step_)), answer_);
        const double share = square / dot(step_, answer_);
        if (!std::isfinite(share)) return;
        add(share, step_momentum_, impulse_);
        add(-share, answer_, missing_);
        inverse_mass();
        const double before = square;
        square = dot(missing_, eased_missing);
        for (std::size_t i = 0; i < n; ++i) {
            const double kept = square / before;
            step_[i].linear = eased_missing[i].linear + kept * step_[i].linear;
            step_[i].angular = eased_missing[i].angular + kept * step_[i].angular;
            step_momentum_[i].linear = missing_[i].linear + kept * step_momentum_[i].linear;
            step_momentum_[i].angular = missing_[i].angular + kept * step_momentum_[i].angular;
        }
    }
}

// What is missing at the impulses there are, as springs would have it that go on as they are now:
// to follow a velocity that a stiff one turns round within the step would lead through its other
// end.
void StiffSprings::foresee()
{
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Six gained = eased(i, impulse_[i]);
        change_[i] = {without_[i].linear + gained.linear, without_[i].angular + gained.angular};
        missing_[i] = {-impulse_[i].linear, -impulse_[i].angular};
    }
    std::fill(going_.begin(), going_.end(), Six{});
    stretch_all();
    for (Row& row : rows_) {
        const Vec3 ahead = row.stiffness * speed_between(row, change_);
        apply_impulse(row, row.elastic + row.damping + ahead, missing_);
    }
}

// Newton's steps, from the impulses there are. False where they lead nowhere.
bool StiffSprings::find_on()
{
    follow();
    double lacking = find_missing();
    for (int step = 0; step < kNewtonSteps; ++step) {
        if (!(lacking > 0)) return lacking == 0;
        before_ = impulse_;
        conjugate_gradients();
        double now = 0;
        for (int half = 0; half <= kHalvings; ++half) {
            if (half > 0)
                for (std::size_t i = 0; i < impulse_.size(); ++i) {
                    impulse_[i].linear = 0.5 * (impulse_[i].linear + before_[i].linear);
                    impulse_[i].angular = 0.5 * (impulse_[i].angular + before_[i].angular);
                }
            follow();
            now = find_missing();
            if (now < lacking) break;
        }
        if (!(now < lacking)) return false;
        lacking = now;
    }
    return lacking == 0;
}

// J, in motion and in springs, less what it was; by how bodies go on now.
double StiffSprings::gained_energy() const
{
    double gained = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Six sum{going_[i].linear + without_[i].linear,
                      going_[i].angular + without_[i].angular};
        gained += 0.5 * dot(impulse_[i], sum);
    }
    return gained + stored();
}

// Some of what springs would give that go on as they began, so much that nothing is gained.
bool StiffSprings::guess()
{
    std::fill(impulse_.begin(), impulse_.end(), Six{});
    foresee();
    conjugate_gradients();
    before_ = impulse_;
    for (const double share : kShares) {
        for (std::size_t i = 0; i < impulse_.size(); ++i)
            impulse_[i] = {share * before_[i].linear, share * before_[i].angular};
        follow();
        if (gained_energy() <= 0) return true;
    }
    return false;
}

// What cannot be followed is held for the step: ends that hardly move to one another take up
// little.
void StiffSprings::hold()
{
    std::fill(impulse_.begin(), impulse_.end(), Six{});
    std::fill(going_.begin(), going_.end(), Six{});
    std::fill(missing_.begin(), missing_.end(), Six{});
    stretch_all();
    for (Row& row : rows_) {
        const double inverse_mass =
            inverse_mass_at(row.a, row.lever_a) + inverse_mass_at(row.b, row.lever_b);
        row.stiffness = (inverse_mass > 0 ? kHeld / inverse_mass : 0) * Mat3::Identity();
        apply_impulse(row, row.stiffness * speed_between(row, without_), missing_);
    }
    conjugate_gradients();
    const auto sound = [](const Six& six) {
        return six.linear.allFinite() && six.angular.allFinite();
    };
    // Else somebody is about to be lost: the others are not drawn along.
    if (!std::all_of(impulse_.begin(), impulse_.end(), sound))
        std::fill(impulse_.begin(), impulse_.end(), Six{});
    slow_down();
}

// How bodies go on together that nothing outside holds.
Vec3 StiffSprings::common_velocity() const
{
    Vec3 momentum = Vec3::Zero();
    double mass = 0;
    if (are_tied()) return momentum;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (!(bodies_[i].inverse_mass > 0)) return Vec3::Zero();
        mass += 1 / bodies_[i].inverse_mass;
        momentum += without_[i].linear / bodies_[i].inverse_mass;
    }
    return momentum / mass;
}

// What bodies turn by takes ends on all the same. So all of them go the slower the more of what
// springs would take up nobody has to give, down to standing still beside one another.
void StiffSprings::slow_down()
{
    before_ = impulse_;
    const Vec3 common = common_velocity();
    for (const double share : kShares) {
        for (std::size_t i = 0; i < impulse_.size(); ++i) {
            const Six stop = stopping(i, common);
            impulse_[i] = {share * before_[i].linear + (1 - share) * stop.linear,
                           share * before_[i].angular + (1 - share) * stop.angular};
        }
        follow();
        if (gained_energy() <= 0) return;
    }
}

// What it takes to stop a body but for the motion it has in common with others.
Six StiffSprings::stopping(std::size_t i, const Vec3& common) const
{
    const SpringBody& body = bodies_[i];
    const Vec3 spin = body.turn.transpose() * without_[i].angular;
    const Vec3 momentum = masses_.inertia[body.body].matrix() * spin;
    const double mass = body.inverse_mass > 0 ? 1 / body.inverse_mass : 0;
    return {mass * (common - without_[i].linear), -Vec3(body.turn * momentum)};
}

void StiffSprings::find()
{
    std::fill(impulse_.begin(), impulse_.end(), Six{});
    foresee();
    conjugate_gradients();
    found_ = find_on();
    if (found_) return;
    std::fill(impulse_.begin(), impulse_.end(), Six{});
    found_ = find_on();
    if (!found_ && !guess()) hold();
}

std::span<const Six> StiffSprings::changes(std::span<const Six> impulses)
{
    for (std::size_t i = 0; i < bodies_.size(); ++i) change_[i] = eased(i, impulses[i]);
    return change_;
}

std::span<const Six> StiffSprings::begin(double time, double span)
{
    time_ = time;
    span_ = span;
    rows_.clear();
    for (const SpringBody& body : bodies_)
        for (std::uint32_t k = forces_.first_spring[body.body];
             k < forces_.first_spring[body.body + 1]; ++k) {
            const SpringForce& spring = forces_.springs[forces_.spring_of[k]];
            // Of two that are both here the first one tells.
            const Row row = row_of(spring, time);
            const bool told = row.a >= 0 && row.b >= 0 && body.body == std::max(spring.a, spring.b)
                && spring.a != spring.b;
            if (!told) rows_.push_back(row);
        }
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        without_[i] = {bodies_[i].velocity, bodies_[i].spin};
    find();
    given_ = impulse_;
    return changes(impulse_);
}

std::span<const Six> StiffSprings::again()
{
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Six gained = eased(i, given_[i]);
        without_[i] = {bodies_[i].velocity - gained.linear, bodies_[i].spin - gained.angular};
    }
    impulse_ = given_;
    found_ = found_ && find_on();
    if (!found_) find();
    missing_ = impulse_;
    add(-1, given_, missing_);
    given_ = impulse_;
    return changes(missing_);
}

// What dampers take after places changed, of what bodies have then: implicit too.
void StiffSprings::damp_end()
{
    bool any = false;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        without_[i] = {bodies_[i].velocity, bodies_[i].spin};
    std::fill(impulse_.begin(), impulse_.end(), Six{});
    for (Row& row : rows_) {
        const double square = row.to.squaredNorm(), c = 0.5 * span_ * row.spring->damping;
        any = any || c > 0;
        row.stiffness.setZero();
        if (square > 0) row.stiffness = c / square * Mat3(row.to * row.to.transpose());
        row.lever_a = still_lever_arm(row.end_a);
        row.lever_b = still_lever_arm(row.end_b);
        apply_impulse(row, row.stiffness * speed_between(row, without_), missing_);
    }
    if (any)
        conjugate_gradients();
    else
        impulse_ = missing_;
}

double StiffSprings::stored() const
{
    double stored = 0;
    for (const Row& row : rows_) stored += row.stored;
    return stored;
}

bool StiffSprings::are_tied() const
{
    return std::any_of(rows_.begin(), rows_.end(),
                       [](const Row& row) { return row.a < 0 || row.b < 0; });
}

bool StiffSprings::are_drawn() const
{
    return std::any_of(rows_.begin(), rows_.end(),
                       [](const Row& row) { return !row.outer.isZero(0); });
}

double StiffSprings::furthest_turn() const
{
    double furthest = 0;
    for (const Row& row : rows_) {
        if (row.a >= 0)
            furthest =
                std::max(furthest, turns_[static_cast<std::size_t>(row.a)].angle_of(row.arm_a));
        if (row.b >= 0)
            furthest =
                std::max(furthest, turns_[static_cast<std::size_t>(row.b)].angle_of(row.arm_b));
    }
    return furthest;
}

// What of the dampers' first half is to act once more after places changed, as a share, lest
// anything is gained: dampers that act before alone turn velocities that springs were to work
// along. Of the energy that comes in by a share s, with e and d of either half and u between,
//
//   (1 + s) d u - (1 - s) e d / m - (1 - s^2) d^2 / 2m,
//
// the first is what they take; the second may be more than that, and is nothing once s is 1.
double StiffSprings::damping_again()
{
    std::fill(step_.begin(), step_.end(), Six{});
    for (const Row& row : rows_) apply_impulse(row, row.damping, step_);
    double taken = 0, turned = 0, square = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Six answer = eased(i, step_[i]);
        taken += dot(step_[i], going_[i]);
        turned += dot(missing_[i], answer);
        square += dot(step_[i], answer);
    }
    const double gained = taken - turned - square / 2, slope = taken + turned;
    if (!(gained > 0)) return 0;
    const double root = slope * slope - 2 * square * gained;
    return std::clamp(2 * gained / (std::sqrt(std::max(root, 0.0)) - slope), 0.0, 1.0);
}

std::span<const Six> StiffSprings::end()
{
    std::fill(missing_.begin(), missing_.end(), Six{});
    if (!found_) return changes(missing_);
    for (const Row& row : rows_) apply_impulse(row, row.elastic, missing_);
    add(damping_again(), step_, missing_);
    // In axes that are carried along they turn a body after it moved as they did before.
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        missing_[i].angular = turns_[i].carried() * missing_[i].angular;
        Mat3& inverse_mass = bodies_[i].inverse_inertia;
        inverse_mass = turns_[i].carried() * Mat3(inverse_mass * turns_[i].carried().transpose());
    }
    damp_end();
    return changes(impulse_);
}

}  // namespace throng
