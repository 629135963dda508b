#include "kernels/dynamics/rigid_motion.hpp"

#include "kernels/dynamics/attraction.hpp"
#include "kernels/dynamics/free_rotation.hpp"
#include "kernels/math/numbers.hpp"
#include "kernels/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Of a list that may be shorter than the bodies.
template <class T>
T of(const std::vector<T>& list, std::uint32_t body, const T& none)
{
    return body < list.size() ? list[body] : none;
}

// Velocity after a drag whose rate times the span is z, and an acceleration that would add
// `gained` without it. 1 / (1 + z + z^2 / 2) in place of the exponential: second order, and no
// drag, however strong, turns a velocity round.
Vec3 dragged(const Vec3& velocity, const Vec3& gained, const Vec3& wind, double z)
{
    return velocity + (gained + z * (wind - velocity)) * ((1 + 0.5 * z) / (1 + z + 0.5 * z * z));
}

// The same for spinning, where the rate is a matrix.
Vec3 dragged(const Vec3& spin, const Vec3& gained, const Mat3& z)
{
    const Mat3 one = Mat3::Identity();
    const Mat3 slowed = one + z + 0.5 * Mat3(z * z);
    const Vec3 towards = gained - Vec3(z * spin);
    return spin + slowed.inverse() * Vec3((one + 0.5 * z) * towards);
}

}  // namespace

RigidMotion::Body RigidMotion::taken(std::uint32_t id, const Flights& flights) const
{
    const Masses& masses = facts_.masses;
    const Quat& pose = facts_.poses.orientation[id];
    Body body;
    body.body = id;
    body.inverse_mass = masses.inverse_mass[id];
    body.turns = rule_.turns && masses.inverse_inertia[id] != Sym3{};
    body.precesses = body.turns && masses.gyroscopic_kind[id] != 0
        && rule_.gyroscopic != RigidRule::Gyroscopic::off;
    body.by_momentum = rule_.momentum_on_pivots && body.turns && facts_.forces.on_pivot(id)
        && of(facts_.forces.linear_drag, id, 0.0) == 0
        && of(facts_.forces.angular_drag, id, 0.0) == 0;
    body.inverse_inertia = masses.inverse_inertia[id].matrix();
    const Sym3& inertia = masses.inertia[id];
    body.principal = masses.principal_of(id);
    if (body.by_momentum && !adds_rates(rule_.rotation)) {
        const int own = body.principal.axis_of_symmetry();
        const double beside =
            body.principal.moments[(own + 1) % 3] + body.principal.moments[(own + 2) % 3];
        body.own_axis = body.principal.axes.col(own);
        body.own_share = 1 / body.principal.moments[own] - 2 / beside;
    }
    const Vec3& spin = facts_.velocities.angular[id];
    const FlightMemory* memory = id < flights.memory.size() ? &flights.memory[id] : nullptr;
    if (memory != nullptr
        && (memory->shown_orientation.coeffs() != pose.coeffs() || memory->shown_spin != spin))
        memory = nullptr;
    body.orientation =
        memory != nullptr ? memory->orientation : write_orientation(rule_.rotation, pose);
    // Another law may have carried it last.
    if (memory != nullptr && memory->is_momentum == body.by_momentum) {
        body.spin = memory->spin;
        return body;
    }
    body.spin = pose.conjugate() * spin;
    if (body.by_momentum) body.spin = pose * Vec3(inertia.matrix() * body.spin);
    return body;
}

void RigidMotion::take(std::span<const std::uint32_t> bodies, const Flights& flights)
{
    bodies_.clear();
    for (const std::uint32_t body : bodies) bodies_.push_back(taken(body, flights));
    state_.assign(places() + speeds(), 0.0);
    moments_.resize(bodies_.size());
    wrenches_.resize(bodies_.size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Body& body = bodies_[i];
        double* const place = state_.data() + place_of(i);
        put(facts_.poses.position[body.body], place);
        if (adds_rates(rule_.rotation))
            std::copy_n(body.orientation.begin(), numbers_of(rule_.rotation), place + 3);
        put(facts_.velocities.linear[body.body], state_.data() + speed_of(i));
        put(body.spin, state_.data() + speed_of(i) + 3);
    }
}

// rad, that any body turns whose spin changes itself. A momentum does not.
double RigidMotion::furthest_turn(double span) const
{
    double fastest = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        if (bodies_[i].precesses && !bodies_[i].by_momentum)
            fastest = std::max(fastest, vector_at(state_.data() + speed_of(i) + 3).norm());
    return span * fastest;
}

void RigidMotion::advance(const IntegratorRow& integrator,
                          double time,
                          double span,
                          IntegratorScratch& scratch)
{
    const bool follows =
        std::isinf(integrator.furthest_turn) || furthest_turn(span) <= integrator.furthest_turn;
    const IntegratorRow& taken = follows ? integrator : chosen(Integrator::splitting, true);
    taken.advance(*this, time, span, scratch, state());
}

void RigidMotion::settle()
{
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (!bodies_[i].turns) continue;
        double* const turn = state_.data() + place_of(i) + 3;
        OrientationNumbers& orientation = bodies_[i].orientation;
        if (adds_rates(rule_.rotation)) {
            repair(rule_.rotation, turn);
            std::copy_n(turn, numbers_of(rule_.rotation), orientation.begin());
        } else if (const Vec3 change = vector_at(turn); !change.isZero(0) || turn[3] != 0) {
            const Body& body = bodies_[i];
            const Vec3 local = body.by_momentum
                ? Vec3(matrix_of(rule_.rotation, orientation.data()).transpose() * change)
                : change;
            turn_on(rule_.rotation, local, orientation.data());
            if (body.by_momentum)
                turn_on(rule_.rotation, turn[3] * body.own_axis, orientation.data());
            std::fill_n(turn, 4, 0.0);
        }
    }
}

RigidMotion::Outcome RigidMotion::outcome(std::size_t i) const
{
    const Body& body = bodies_[i];
    Outcome out;
    out.position = vector_at(state_.data() + place_of(i));
    out.linear = vector_at(state_.data() + speed_of(i));
    out.orientation = body.turns ? read_orientation(rule_.rotation, body.orientation.data())
                                 : facts_.poses.orientation[body.body];
    const Vec3 spin = vector_at(state_.data() + speed_of(i) + 3);
    if (body.by_momentum) {
        const Mat3 turn = out.orientation.toRotationMatrix();
        out.angular = turn * body_spin(i, turn, state_.data());
    } else {
        // What nothing has changed keeps its bits.
        out.angular =
            spin == body.spin ? facts_.velocities.angular[body.body] : Vec3(out.orientation * spin);
    }
    out.memory = {body.orientation, spin, body.by_momentum, out.orientation, out.angular};
    return out;
}

// Body axes to world axes.
Mat3 RigidMotion::turn_at(std::size_t i, const double* state) const
{
    const Body& body = bodies_[i];
    const double* const place = state + place_of(i);
    if (adds_rates(rule_.rotation)) return matrix_of(rule_.rotation, place + 3);
    const Mat3 before = matrix_of(rule_.rotation, body.orientation.data());
    const Vec3 change = vector_at(place + 3);
    if (change.isZero(0) && place[6] == 0) return before;
    const Mat3 further = exponential(change).toRotationMatrix();
    if (!body.by_momentum) return before * further;
    return further * before * exponential(place[6] * body.own_axis).toRotationMatrix();
}

// Angular velocity in body axes.
Vec3 RigidMotion::body_spin(std::size_t i, const Mat3& turn, const double* state) const
{
    const Vec3 spin = vector_at(state + speed_of(i) + 3);
    if (!bodies_[i].by_momentum) return spin;
    return bodies_[i].inverse_inertia * Vec3(turn.transpose() * spin);
}

RigidMotion::Moment RigidMotion::moment_at(std::size_t i, const double* state) const
{
    const Body& body = bodies_[i];
    Moment now;
    now.turn = turn_at(i, state);
    now.spin = now.turn * body_spin(i, now.turn, state);
    now.arm = now.turn * of(facts_.forces.pivot_to_center, body.body, Vec3(Vec3::Zero()));
    now.position = vector_at(state + place_of(i));
    now.velocity = vector_at(state + speed_of(i)) + now.spin.cross(now.arm);
    return now;
}

RigidMotion::Moment RigidMotion::moment_outside(std::uint32_t body, double time) const
{
    Moment now;
    if (body == kNoBody) {
        now.turn = Mat3::Identity();
        now.position = now.arm = now.velocity = now.spin = Vec3::Zero();
        return now;
    }
    now.spin = facts_.velocities.angular[body];
    now.turn = turned(facts_.poses.orientation[body], now.spin, time).toRotationMatrix();
    now.arm = now.turn * of(facts_.forces.pivot_to_center, body, Vec3(Vec3::Zero()));
    now.position = facts_.poses.position[body] + time * facts_.velocities.linear[body];
    now.velocity = facts_.velocities.linear[body] + now.spin.cross(now.arm);
    return now;
}

void RigidMotion::look(const double* state)
{
    for (std::size_t i = 0; i < bodies_.size(); ++i) moments_[i] = moment_at(i, state);
}

void RigidMotion::add_springs(std::size_t i, double time, Wrench& on) const
{
    const Forces& forces = facts_.forces;
    const std::uint32_t id = bodies_[i].body;
    if (!by_springs_ || id + 1 >= forces.first_spring.size()) return;
    for (std::uint32_t k = forces.first_spring[id]; k < forces.first_spring[id + 1]; ++k) {
        const SpringForce& spring = forces.springs[forces.spring_of[k]];
        const bool first = spring.a == id;
        const std::uint32_t other = first ? spring.b : spring.a;
        const auto among = std::lower_bound(
            bodies_.begin(), bodies_.end(), other,
            [](const Body& body, std::uint32_t wanted) { return body.body < wanted; });
        const bool inside = among != bodies_.end() && among->body == other;
        const Moment& here = moments_[i];
        const Moment there =
            inside ? moments_[std::size_t(among - bodies_.begin())] : moment_outside(other, time);
        const Vec3 lever_arm = here.turn * (first ? spring.at_a : spring.at_b);
        const Vec3 far_lever_arm = there.turn * (first ? spring.at_b : spring.at_a);
        const auto speed = [](const Moment& at, const Vec3& from) {
            return Vec3(at.velocity + at.spin.cross(from));
        };
        const Vec3 between =
            (there.position + there.arm + far_lever_arm) - (here.position + here.arm + lever_arm);
        const double distance = std::sqrt(between.squaredNorm());
        // Ends that meet are drawn nowhere: which way, none could say.
        if (!(distance > 0)) continue;
        const Vec3 along = between / distance;
        const double separating_speed =
            along.dot(speed(there, far_lever_arm) - speed(here, lever_arm));
        const double pull =
            spring.stiffness * (distance - spring.length) + spring.damping * separating_speed;
        on.force += pull * along;
        on.torque += lever_arm.cross(Vec3(pull * along));
    }
}

void RigidMotion::find_wrenches(double time, bool all_drag, std::size_t begin, std::size_t end)
{
    const Forces& forces = facts_.forces;
    for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t id = bodies_[i].body;
        const Moment& now = moments_[i];
        const double mass = mass_of(bodies_[i]);
        Wrench& on = wrenches_[i];
        on.force = of(forces.force, id, Vec3(Vec3::Zero()));
        on.torque = of(forces.torque, id, Vec3(Vec3::Zero()));
        if (all_drag || bodies_[i].by_momentum) {
            on.force += of(forces.linear_drag, id, 0.0) * (forces.wind - now.velocity);
            on.torque -= of(forces.angular_drag, id, 0.0) * now.spin;
        }
        for (const AttractorForce& attractor : forces.attractors) {
            const Vec3 towards = attractor.position - (now.position + now.arm);
            const double square = towards.squaredNorm();
            if (square > 0)
                on.force += attraction_pull(attractor, mass, square, rule_.substep) * towards;
        }
        if (forces.field) {
            const Pose center{now.position + now.arm, Quat(now.turn)};
            const Wrench more =
                forces.field({id, rule_.time + time, mass, center, now.velocity, now.spin});
            on.force += more.force;
            on.torque += more.torque;
        }
        add_springs(i, time, on);
        // From the center of mass to the position, which for most are one.
        if (now.arm.isZero(0)) continue;
        on.force += mass * rule_.gravity;
        on.torque += now.arm.cross(on.force);
    }
}

void RigidMotion::stand(std::size_t i, const Pose& pose, const Vec3& velocity, const Vec3& spin)
{
    Moment& now = moments_[i];
    now.turn = pose.orientation.toRotationMatrix();
    now.arm = now.turn * facts_.forces.pivot_to_center_of(bodies_[i].body);
    now.position = pose.position;
    now.velocity = velocity + spin.cross(now.arm);
    now.spin = spin;
}

void RigidMotion::find_accelerations(double time, std::size_t begin, std::size_t end)
{
    find_wrenches(time, false, begin, end);
}

// What is held for a span is what drag comes to over all of it: as it is at the beginning, a strong
// one would turn velocities round, and more each time.
RigidMotion::Acceleration RigidMotion::acceleration_of(std::size_t i, double span) const
{
    const Body& body = bodies_[i];
    const Moment& now = moments_[i];
    const Forces& forces = facts_.forces;
    if (of(forces.linear_drag, body.body, 0.0) == 0 && of(forces.angular_drag, body.body, 0.0) == 0)
        return {
            body.inverse_mass * wrenches_[i].force,
            now.turn
                * Vec3(body.inverse_inertia * Vec3(now.turn.transpose() * wrenches_[i].torque))};
    const Vec3 velocity = now.velocity - now.spin.cross(now.arm);
    const Vec3 spin = now.turn.transpose() * now.spin;
    double after[6];
    put(velocity, after);
    put(spin, after + 3);
    apply_forces(i, span, after);
    return {Vec3(vector_at(after) - velocity) / span - fall_of(body),
            now.turn * Vec3((vector_at(after + 3) - spin) / span)};
}

RigidMotion::Acceleration RigidMotion::mean_acceleration(std::size_t i, double span)
{
    look(state_.data());
    find_wrenches(0, false, i, i + 1);
    return acceleration_of(i, span);
}

RigidMotion::Going RigidMotion::going(std::size_t i) const
{
    const double* const state = state_.data();
    const Body& body = bodies_[i];
    const Mat3 turn = turn_at(i, state);
    Going going{vector_at(state + place_of(i)),
                turn,
                vector_at(state + speed_of(i)),
                turn * body_spin(i, turn, state),
                Mat3(turn * body.inverse_inertia) * turn.transpose(),
                Vec3::UnitZ(),
                1};
    if (precesses_evenly(body)) {
        const int axis = body.principal.axis_of_symmetry();
        going.axis = turn * Vec3(body.principal.axes.col(axis));
        going.carries = body.principal.moments[axis] / body.principal.moments[(axis + 1) % 3];
    }
    return going;
}

void RigidMotion::add_speed(std::size_t i, const Vec3& velocity, const Vec3& spin)
{
    double* const speed = state_.data() + speed_of(i);
    put(vector_at(speed) + velocity, speed);
    put(vector_at(speed + 3) + turn_at(i, state_.data()).transpose() * spin, speed + 3);
}

void RigidMotion::place_rates(const double* state, double* rates)
{
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const double* const place = state + place_of(i);
        const double* const speed = state + speed_of(i);
        double* const rate = rates + place_of(i);
        put(vector_at(speed), rate);
        const Body& body = bodies_[i];
        const Mat3 turn = body.by_momentum ? turn_at(i, state) : Mat3(Mat3::Identity());
        const Vec3 spin = body_spin(i, turn, state);
        if (adds_rates(rule_.rotation)) {
            rates_of(rule_.rotation, place + 3, spin, rate + 3);
            continue;
        }
        rate[6] = 0;
        if (!body.by_momentum) {
            put(rate_of_turn(vector_at(place + 3), spin), rate + 3);
            continue;
        }
        const Vec3 axis = turn * body.own_axis;
        rate[6] = body.own_share * axis.dot(vector_at(speed + 3));
        // From the left the series is that of the way back.
        put(rate_of_turn(-vector_at(place + 3), Vec3(turn * spin) - rate[6] * axis), rate + 3);
    }
}

void RigidMotion::speed_rates(double time, const double* state, double* rates)
{
    if (forced_) look(state);
    if (forced_) find_wrenches(time, true, 0, bodies_.size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Body& body = bodies_[i];
        const Mat3& turn = moments_[i].turn;
        Vec3 linear = fall_of(body), torque = Vec3::Zero();
        if (forced_) {
            linear += body.inverse_mass * wrenches_[i].force;
            torque = turn.transpose() * wrenches_[i].torque;
        }
        if (body.precesses) {
            const Vec3 spin = vector_at(state + speed_of(i) + 3);
            torque -= spin.cross(Vec3(facts_.masses.inertia[body.body].matrix() * spin));
        }
        put(linear, rates + i * 6);
        if (body.by_momentum) {
            put(Vec3::Zero(), rates + i * 6 + 3);
            add_momentum(i, 1, rates + i * 6 + 3);
            continue;
        }
        put(body.turns ? Vec3(body.inverse_inertia * torque) : Vec3(Vec3::Zero()),
            rates + i * 6 + 3);
    }
}

// What a torque adds to an angular momentum in a time.
void RigidMotion::add_momentum(std::size_t i, double span, double* momentum) const
{
    put(vector_at(momentum) + span * wrenches_[i].torque, momentum);
}

// Forces, and drag by itself, so that however strong it only slows.
void RigidMotion::apply_forces(std::size_t i, double span, double* speed) const
{
    const Body& body = bodies_[i];
    const Forces& forces = facts_.forces;
    const Mat3& turn = moments_[i].turn;
    const double drag = of(forces.linear_drag, body.body, 0.0);
    const Vec3 linear = fall_of(body) + body.inverse_mass * wrenches_[i].force;
    put(dragged(vector_at(speed), span * linear, forces.wind, span * drag * body.inverse_mass),
        speed);
    if (!body.turns) return;
    Vec3 torque = turn.transpose() * wrenches_[i].torque;
    Mat3 z = span * of(forces.angular_drag, body.body, 0.0) * body.inverse_inertia;
    // Drag on what swings about a pivot slows its turning.
    if (const Vec3& arm = moments_[i].arm; drag > 0 && !arm.isZero(0)) {
        torque += turn.transpose() * arm.cross(Vec3(drag * forces.wind));
        const Vec3 lever_arm = turn.transpose() * arm;
        const Mat3 one = Mat3::Identity();
        const Mat3 about = lever_arm.squaredNorm() * one - Mat3(lever_arm * lever_arm.transpose());
        z += span * drag * Mat3(body.inverse_inertia * about);
    }
    const Vec3 spin = vector_at(speed + 3), gained = span * Vec3(body.inverse_inertia * torque);
    put(z.isZero(0) ? Vec3(spin + gained) : dragged(spin, gained, z), speed + 3);
}

void RigidMotion::kick(double time, double span, double* state)
{
    if (forced_) look(state);
    if (forced_) find_wrenches(time, false, 0, bodies_.size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Body& body = bodies_[i];
        double* const speed = state + speed_of(i);
        if (body.by_momentum) {
            add_momentum(i, span, speed + 3);
        } else if (forced_) {
            apply_forces(i, span, speed);
        } else {
            put(vector_at(speed) + span * fall_of(body), speed);
        }
    }
}

void RigidMotion::gyrate(double span, double* state)
{
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (!bodies_[i].precesses || bodies_[i].by_momentum) continue;
        double* const spin = state + speed_of(i) + 3;
        const auto after = rule_.gyroscopic == RigidRule::Gyroscopic::implicit
            ? after_gyroscopic_torque_local
            : after_explicit_gyroscopic_torque_local;
        put(after(vector_at(spin), facts_.masses.inertia[bodies_[i].body], span), spin);
    }
}

// In how many parts what precesses goes by a turn, rad: its energy sways by what a part turns.
int RigidMotion::parts_of_turn(const Vec3& turn)
{
    constexpr double kWhole = 2, kPart = 0.5;  // what most do in a span, one part follows well
    constexpr int kMostParts = 64;
    const double angle = turn.norm();
    if (!(angle > kWhole)) return 1;
    return static_cast<int>(std::min<double>(std::ceil(angle / kPart), kMostParts));
}

void RigidMotion::drift_turning(std::size_t i, double span, double* state)
{
    const auto turn = [&](const Vec3& by) { turn_by(i, by, state); };
    const Mat3 now = bodies_[i].by_momentum ? turn_at(i, state) : Mat3(Mat3::Identity());
    const Vec3 by = span * body_spin(i, now, state);
    // What is symmetric goes exactly by one.
    const int parts = precesses_evenly(bodies_[i]) ? 1 : parts_of_turn(by);
    if (bodies_[i].precesses) return turn_momentum(i, span, parts, state, turn);
    turn(by);
}

void RigidMotion::turn_by(std::size_t i, const Vec3& turn, double* state)
{
    if (!adds_rates(rule_.rotation))
        return turn_on(rule_.rotation, turn, bodies_[i].orientation.data());
    double* const numbers = state + place_of(i) + 3;
    double rates[9];
    rates_of(rule_.rotation, numbers, turn, rates);
    for (int k = 0; k < numbers_of(rule_.rotation); ++k) numbers[k] += rates[k];
}

bool RigidMotion::precesses_evenly(const Body& body) const
{
    return body.precesses && body.principal.asymmetry(body.principal.axis_of_symmetry()) <= 1e-9;
}

// Calls back with the turns of a body that has its momentum, which turns likewise.
template <class Turn>
void RigidMotion::turn_momentum(std::size_t i, double span, int parts, double* state, Turn turn_by)
{
    const Body& body = bodies_[i];
    const Mat3 now = body.by_momentum ? turn_at(i, state) : Mat3(Mat3::Identity());
    const Vec3 spin = body_spin(i, now, state);
    const Mat3& axes = body.principal.axes;
    const Vec3& moments = body.principal.moments;
    Vec3 momentum = moments.cwiseProduct(Vec3(axes.transpose() * spin));
    turn_freely(free_rotation(moments), span, parts, momentum,
                [&](const Vec3& turn) { turn_by(Vec3(axes * turn)); });
    if (!body.by_momentum)
        put(axes * Vec3(momentum.cwiseQuotient(moments)), state + speed_of(i) + 3);
}

void RigidMotion::go(double span)
{
    double* const state = state_.data();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        double* const place = state + place_of(i);
        put(vector_at(place) + span * vector_at(state + speed_of(i)), place);
        if (!bodies_[i].turns) continue;
        if (precesses_evenly(bodies_[i]))
            drift_turning(i, span, state);
        else
            turn_by(i, span * vector_at(state + speed_of(i) + 3), state);
    }
}

void RigidMotion::precess(double span)
{
    constexpr int kMostParts = 64;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Body& body = bodies_[i];
        if (!body.precesses || precesses_evenly(body)) continue;
        const Vec3 spin = vector_at(state_.data() + speed_of(i) + 3);
        const Vec3 momentum = facts_.masses.inertia[body.body].matrix() * spin;
        const int parts = parts_of(free_rotation(body.principal.moments),
                                   std::sqrt(momentum.squaredNorm()), span, kMostParts);
        turn_momentum(i, span, parts > 0 ? parts : kMostParts, state_.data(), [](const Vec3&) {});
    }
}

void RigidMotion::drift(double span, double* state)
{
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        double* const place = state + place_of(i);
        put(vector_at(place) + span * vector_at(state + speed_of(i)), place);
        if (bodies_[i].turns) drift_turning(i, span, state);
    }
}

}  // namespace throng
