#include "throng/contact_check.hpp"

#include "kernels/math/rotation.hpp"
#include "pipeline/contacts/contact_lists.hpp"
#include "pipeline/world/collider_overlaps.hpp"
#include "pipeline/world/contact_impulses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

// s, in which forces are told by the speed that they give.
constexpr double kFrame = 1.0 / 60;

bool is_cut_at_touches(const WorldState& state)
{
    return state.get<StepContext>().effects.meets(kEventDriven);
}

void sort_once_each(std::vector<BodyPair>& pairs)
{
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

BodyPair in_order(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

struct Placed {
    Vec3 center = Vec3::Zero();
    Quat orientation = Quat::Identity();
};

// One side of a contact: how its body moves, and moved in the step.
struct Side {
    Vec3 moved = Vec3::Zero();     // m, its center
    Mat3 turn = Mat3::Identity();  // since the step began
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
    Vec3 to_center = Vec3::Zero();  // m, from what it turns about
    double inverse_mass = 0;
    Mat3 inverse_inertia = Mat3::Zero();

    Vec3 velocity_at(const Vec3& anchor) const { return velocity + spin.cross(anchor); }
    // 1/kg, of a push along a direction.
    double inverse_mass_along(const Vec3& direction, const Vec3& anchor) const
    {
        const Vec3 arm = (to_center + anchor).cross(direction);
        return inverse_mass + arm.dot(inverse_inertia * arm);
    }
};

// A contact where it is at the step's end: its points on either side, from the centers of mass.
// Round sides look the same however they are turned.
struct Points {
    Vec3 normal;
    std::array<Vec3, 4> on_a, on_b;
    std::array<double, 4> separation = {}, force = {};  // m, N
    int count = 0;
    Vec3 friction;            // N on b, across the normal
    Vec3 middle_a, middle_b;  // where friction acts
    double load = 0;          // N
};

template <class Real>
Points points_of(const Contact<Real>& contact, int count, const Side& a, const Side& b, double time)
{
    Points points;
    points.normal = contact.normal.template cast<double>();
    points.count = count;
    points.middle_a = points.middle_b = Vec3::Zero();
    for (int k = 0; k < count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const auto& point = contact.points[at];
        const Vec3 anchor_a = point.anchor_a.template cast<double>();
        const Vec3 anchor_b = contact.anchor_b(k).template cast<double>();
        points.on_a[at] = contact.round_a > 0 ? anchor_a : Vec3(a.turn * anchor_a);
        points.on_b[at] = contact.round_b > 0 ? anchor_b : Vec3(b.turn * anchor_b);
        const Vec3 apart =
            (b.moved + points.on_b[at] - anchor_b) - (a.moved + points.on_a[at] - anchor_a);
        points.separation[at] = double{point.separation} + points.normal.dot(apart);
        points.force[at] = double{point.impulse} / time;
        points.load += points.force[at];
    }
    // As the solver has it: the middle of the points, of round sides that of what they bear.
    const bool by_load = (contact.round_a > 0 || contact.round_b > 0) && points.load > 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
        const double share = by_load ? points.force[k] / points.load : 1.0 / count;
        points.middle_a += share * points.on_a[k];
        points.middle_b += share * points.on_b[k];
    }
    const Vec3 friction = contact.friction.template cast<double>() / time;
    points.friction = friction - points.normal * points.normal.dot(friction);
    return points;
}

Vec3 across(const Vec3& normal, const Vec3& v) { return v - normal * normal.dot(v); }

// m/s, see ContactResiduals::complementarity().
double missed_along(const Points& points, const Side& a, const Side& b, double time, bool bounces)
{
    double greatest = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(points.count); ++k) {
        const Vec3 &on_a = points.on_a[k], &on_b = points.on_b[k];
        const double inverse_mass =
            a.inverse_mass_along(points.normal, on_a) + b.inverse_mass_along(points.normal, on_b);
        if (!(inverse_mass > 0)) continue;
        const double given = points.force[k] * inverse_mass * kFrame;
        const double speed = points.normal.dot(b.velocity_at(on_b) - a.velocity_at(on_a));
        const double separating = std::max(speed, points.separation[k] / time);
        if (bounces && separating > 0) continue;
        greatest = std::max(greatest, std::abs(std::min(given, separating)));
    }
    return greatest;
}

// m/s, see ContactResiduals::friction_cone().
double missed_across(const Points& points, const Side& a, const Side& b, double friction)
{
    const Vec3& normal = points.normal;
    const Vec3 sliding =
        across(normal, b.velocity_at(points.middle_b) - a.velocity_at(points.middle_a));
    const Vec3 direction = sliding.squaredNorm() > 0 ? sliding : points.friction;
    if (!(direction.squaredNorm() > 0)) return 0;
    const double inverse_mass = a.inverse_mass_along(direction.normalized(), points.middle_a)
        + b.inverse_mass_along(direction.normalized(), points.middle_b);
    if (!(inverse_mass > 0)) return 0;
    const double per_force = inverse_mass * kFrame;
    const Vec3 given = per_force * points.friction;
    const double most = per_force * friction * points.load;
    Vec3 wanted = given - sliding;
    if (wanted.norm() > most) wanted *= most / wanted.norm();
    // Held at each of its points, what slides and spins is held by less, in another direction.
    Vec3 at_points = Vec3::Zero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(points.count); ++k) {
        const Vec3 there =
            across(normal, b.velocity_at(points.on_b[k]) - a.velocity_at(points.on_a[k]));
        if (there.squaredNorm() > 0)
            at_points -= per_force * friction * points.force[k] * there.normalized();
    }
    return std::min(Vec3(given - wanted).norm(), Vec3(given - at_points).norm());
}

}  // namespace

class ContactResiduals::Inside {
public:
    void before_step(const World& world);
    void after_step(const World& world);

private:
    friend class ContactResiduals;  // which tells what was found

    Side side_of(const WorldState& state, std::uint32_t body) const;
    template <class Real>
    void look(const WorldState& state, const StepData<Real>& data);

    std::vector<Placed> begun_;  // by body
    double along_ = 0, across_ = 0;
    bool known_ = true;
};

void ContactResiduals::Inside::before_step(const World& world)
{
    const WorldState& state = state_of(world);
    const auto& states = state.get<BodyStates>();
    begun_.assign(states.kind.size(), {});
    for (std::uint32_t body = 0; body < begun_.size(); ++body)
        if (states.kind[body] != BodyKind::removed)
            begun_[body] = {state.center_of_mass(body), state.get<Poses>().orientation[body]};
}

Side ContactResiduals::Inside::side_of(const WorldState& state, std::uint32_t body) const
{
    Side side;
    const auto& states = state.get<BodyStates>();
    if (states.kind[body] == BodyKind::static_ || body >= begun_.size()) return side;
    const auto& masses = state.get<Masses>();
    const Quat& orientation = state.get<Poses>().orientation[body];
    side.moved = state.center_of_mass(body) - begun_[body].center;
    side.turn = (orientation * begun_[body].orientation.conjugate()).toRotationMatrix();
    side.velocity = state.velocity(body);
    side.spin = state.get<Velocities>().angular[body];
    if (!states.dynamic(body)) return side;
    side.to_center = state.center_of_mass(body) - state.get<Poses>().position[body];
    side.inverse_mass = masses.inverse_mass[body];
    side.inverse_inertia = in_world_axes(masses.inverse_inertia[body], orientation).matrix();
    return side;
}

template <class Real>
void ContactResiduals::Inside::look(const WorldState& state, const StepData<Real>& data)
{
    const auto& active = std::get<ActiveContacts>(data);
    const auto& states = state.get<BodyStates>();
    const double time = state.get<StepContext>().last_substep;
    const auto is_driven = [&](std::uint32_t body) {
        return states.carries(body) || state.get<PrescribedVelocities>().of(body) != nullptr;
    };
    for (std::size_t i = 0; i < active.entries.size(); ++i) {
        const ActiveContacts::Entry& entry = active.entries[i];
        const Contact<Real>& contact = contact_of(
            std::get<ConvexContacts<Real>>(data), std::get<MeshContacts<Real>>(data),
            std::get<SolidContacts<Real>>(data), std::get<JoinedContacts<Real>>(data), entry);
        const Side a = side_of(state, entry.body_a), b = side_of(state, entry.body_b);
        const Points points = points_of(contact, entry.points, a, b, time);
        const bool may_bounce = entry.restitution > 0;
        along_ = std::max(along_, missed_along(points, a, b, time, may_bounce));
        const double separating =
            points.normal.dot(b.velocity_at(points.middle_b) - a.velocity_at(points.middle_a));
        if (is_driven(entry.body_a) || is_driven(entry.body_b) || (may_bounce && separating > 0))
            continue;
        const double friction =
            active.materials.empty() ? double{entry.friction} : active.materials[i].friction;
        across_ = std::max(across_, missed_across(points, a, b, friction));
    }
}

void ContactResiduals::Inside::after_step(const World& world)
{
    const WorldState& state = state_of(world);
    along_ = across_ = 0;
    known_ = !is_cut_at_touches(state);
    if (!known_) along_ = across_ = std::numeric_limits<double>::infinity();
    if (!known_ || !(state.get<StepContext>().last_substep > 0)) return;
    std::visit(
        [&](const auto& chosen) {
            look<typename std::decay_t<decltype(chosen)>::Number>(state, chosen.data);
        },
        state.step);
}

ContactResiduals::ContactResiduals() : inside_(std::make_unique<Inside>()) { }
ContactResiduals::~ContactResiduals() = default;
ContactResiduals::ContactResiduals(ContactResiduals&&) noexcept = default;
ContactResiduals& ContactResiduals::operator=(ContactResiduals&&) noexcept = default;

void ContactResiduals::before_step(const World& world) { inside_->before_step(world); }
void ContactResiduals::after_step(const World& world) { inside_->after_step(world); }
double ContactResiduals::complementarity() const { return inside_->along_; }
double ContactResiduals::friction_cone() const { return inside_->across_; }
bool ContactResiduals::known() const { return inside_->known_; }

std::vector<BodyPair> contact_pairs(const World& world)
{
    const WorldState& state = state_of(world);
    std::vector<BodyPair> found;
    if (is_cut_at_touches(state)) return found;
    const auto& colliders = state.get<Colliders>();
    const auto& pairs = state.get<Pairs>();
    const auto add = [&](PairKey key) {
        found.push_back(in_order(colliders.body[first_of(key)], colliders.body[second_of(key)]));
    };
    // Contacts that were dropped as ghosts were found all the same.
    const auto look = [&]<class Real>(const StepData<Real>& data) {
        const auto& of_pair = std::get<ConvexContacts<Real>>(data).of_pair;
        for (std::size_t i = 0; i < of_pair.size(); ++i)
            if (of_pair[i].contact != PairState::kApart) add(pairs.keys[i]);
        for (const auto& entry : std::get<MeshContacts<Real>>(data).entries)
            add(pairs.keys[entry.pair]);
        for (const auto& entry : std::get<SolidContacts<Real>>(data).entries)
            add(pairs.keys[entry.pair]);
        for_each_sleeping_contact(std::get<SleepingPairs>(data),
                                  std::get<SleepingContacts<Real>>(data),
                                  [&](PairKey key, const Contact<Real>&) { add(key); });
    };
    std::visit(
        [&](const auto& chosen) {
            look.template operator()<typename std::decay_t<decltype(chosen)>::Number>(chosen.data);
        },
        state.step);
    sort_once_each(found);
    return found;
}

std::vector<BodyPair> overlapping_pairs(const World& world, double deeper_than)
{
    const WorldState& state = state_of(world);
    const auto& states = state.get<BodyStates>();
    const std::vector<std::uint32_t>& body = state.get<Colliders>().body;
    std::vector<BodyPair> pairs;
    for (const ColliderOverlap& overlap : find_collider_overlaps(state)) {
        const std::uint32_t a = body[overlap.collider_a], b = body[overlap.collider_b];
        if (overlap.depth > deeper_than && (states.dynamic(a) || states.dynamic(b)))
            pairs.push_back(in_order(a, b));
    }
    sort_once_each(pairs);
    return pairs;
}

std::vector<Vec3> unbalanced_forces(const World& world)
{
    const WorldState& state = state_of(world);
    const auto& states = state.get<BodyStates>();
    const auto& forces = state.get<Forces>();
    const auto& masses = state.get<Masses>();
    const double time = state.get<StepContext>().last_substep;
    std::vector<Vec3> left(states.kind.size(), Vec3::Zero());
    if (is_cut_at_touches(state)) {
        const std::vector<Vec3>& force = state.get<EventDrivenContacts>().force;
        std::copy_n(force.begin(), std::min(force.size(), left.size()), left.begin());
    } else if (time > 0)
        for_each_contact_impulse(state, [&](std::uint32_t a, std::uint32_t b, const auto& on_b) {
            const Vec3 force = on_b() / time;
            left[a] -= force;
            left[b] += force;
        });
    for (std::uint32_t body = 0; body < left.size(); ++body) {
        if (!states.dynamic(body) || masses.inverse_mass[body] == 0
            || forces.force_depends_on_state(body)
            || state.get<PrescribedVelocities>().of(body) != nullptr)
            left[body].setConstant(std::numeric_limits<double>::quiet_NaN());
        else
            left[body] += masses.mass[body] * world.gravity();
        if (body < forces.force.size()) left[body] += forces.force[body];
    }
    return left;
}

}  // namespace throng
