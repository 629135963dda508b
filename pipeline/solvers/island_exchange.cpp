// Island exchange: an island taken from the step's data, and its answer given back.
#include "kernels/solver/driven_contacts.hpp"
#include "pipeline/solvers/whole_island.hpp"

namespace throng {

namespace {

// Overlap that is let be, as a share of the lesser shape: what the numbers of contacts resolve.
template <class Real>
constexpr double kTolerance = sizeof(Real) == 4 ? 2e-7 : 1e-9;

template <class Real>
Vec3 in_double(const Vec3T<Real>& v)
{
    return v.template cast<double>();
}

// About which a contact's twist is told, as an arm of a.
Vec3 middle_of(std::span<const DirectPoint> points)
{
    Vec3 middle = Vec3::Zero();
    for (const DirectPoint& point : points)
        middle += point.arm_a / static_cast<double>(points.size());
    return middle;
}

// The impulses of the last step as those of points: friction and twist shared as the points bear.
// The twist is told about their plain middle, and given back about the middle of the load.
template <class Real>
void guess(const Contact<Real>& contact, std::span<DirectPoint> points)
{
    double load = 0;
    Vec3 middle = Vec3::Zero();
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto impulse = double{contact.points[k].impulse};
        load += impulse;
        middle += points[k].arm_a * impulse;
    }
    if (!(load > 0)) return;
    middle /= load;
    const Vec3 friction = in_double(contact.friction);
    const double rest = double{contact.twist}
        + points.front().normal.dot((middle_of(points) - middle).cross(friction));
    double spread = 0;
    for (std::size_t k = 0; k < points.size(); ++k)
        spread += double{contact.points[k].impulse}
            * points[k].normal.cross(points[k].arm_a - middle).squaredNorm();
    const double twist = points.size() > 1 && spread > 0 ? rest / spread : 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        DirectPoint& point = points[k];
        const auto impulse = double{contact.points[k].impulse};
        const Vec3 round = point.normal.cross(point.arm_a - middle);
        point.impulse =
            point.normal * impulse + friction * (impulse / load) + round * (twist * impulse);
        point.torque = in_double(contact.rolling) * (impulse / load);
    }
}

}  // namespace

template <class Real>
WholeIsland::WholeIsland(const DirectScene<Real>& scene, const Batch& batch)
{
    const Slice& slice = scene.layout.slices[batch.first_slice];
    effort_ = scene.effort;
    left_ = effort_.steps * (2 + scene.conditions.settings.substeps);
    up_ = up_of(scene.conditions.gravity);
    spins_ = scene.conditions.settings.response != Response::kinematic;
    take_bodies(scene, slice);
    take_forces(scene, slice);
    for (std::uint32_t i = 0; i < slice.contacts; ++i)
        take_contact(scene, slice, slice.first_contact + i);
    gaps_.resize(touches_.size());
}

template <class Real>
void WholeIsland::take_bodies(const DirectScene<Real>& scene, const Slice& slice)
{
    const Layout& layout = scene.layout;
    const auto add = [&](std::uint32_t slot, bool dynamic, bool advances) {
        IslandSeat seat;
        seat.body = layout.body_of_slot[slot];
        seat.dynamic = dynamic;
        seat.advances = advances;
        const bool uneven = scene.facts.masses.spins_unevenly[seat.body] != 0;
        seat.precesses = dynamic && uneven && scene.conditions.has(Effect::gyroscopic);
        seat.position = scene.poses.position[seat.body];
        seat.orientation = scene.poses.orientation[seat.body];
        if (dynamic && scene.conditions.effects.meets(kForces)) {
            seat.pull = scene.pulls.linear[seat.body];
            seat.twist = scene.pulls.angular[seat.body];
        }
        DirectBody body;
        body.velocity = scene.velocities.linear[seat.body];
        body.spin = scene.velocities.angular[seat.body];
        const bool turns = dynamic && scene.conditions.has(Effect::rotation);
        if (dynamic) body.inverse_mass = scene.facts.masses.inverse_mass[seat.body];
        seats_.push_back(seat);
        after_.push_back(body);
        inertia_.push_back(scene.facts.masses.inertia[seat.body]);
        inverse_inertia_.push_back(turns ? scene.facts.masses.inverse_inertia[seat.body] : Sym3{});
    };
    for (std::uint32_t i = 0; i < slice.dynamic; ++i) add(slice.first_body + i, true, true);
    // Those that stay where they are while their surface moves come last.
    std::uint32_t visitors = slice.kinematic;
    for (std::uint32_t i = 0; i < slice.contacts; ++i) {
        const std::uint32_t lane = layout.lane[slice.first_contact + i];
        for (const std::int32_t slot : {layout.slot_a[lane], layout.slot_b[lane]})
            if (slot > 0 && !layout.movable(slot))
                visitors =
                    std::max(visitors, static_cast<std::uint32_t>(slot) - slice.first_visitor + 1);
    }
    for (std::uint32_t i = 0; i < visitors; ++i)
        add(slice.first_visitor + i, false, i < slice.kinematic);
}

template <class Real>
void WholeIsland::take_forces(const DirectScene<Real>& scene, const Slice& slice)
{
    const Set<Effect> follow = {Effect::forces, Effect::springs, Effect::attractors, Effect::pivot};
    if (!scene.conditions.effects.meets(follow)) return;
    std::vector<std::uint32_t> bodies;
    for (std::uint32_t i = 0; i < slice.dynamic; ++i) bodies.push_back(seats_[i].body);
    following_ = std::make_unique<FollowingForces>(scene.conditions, scene.facts, bodies);
    if (following_->followers().empty()) following_.reset();
}

std::int32_t WholeIsland::seat_of(const Layout& layout, const Slice& slice, std::int32_t slot) const
{
    if (slot == 0) return -1;
    if (layout.movable(slot)) return slot - static_cast<std::int32_t>(slice.first_body);
    return slot - static_cast<std::int32_t>(slice.first_visitor)
        + static_cast<std::int32_t>(slice.dynamic);
}

template <class Real>
void WholeIsland::take_contact(const DirectScene<Real>& scene,
                               const Slice& slice,
                               std::uint32_t place)
{
    const auto& entry = scene.active.entries[scene.layout.contacts[place]];
    const Contact<Real>& contact = scene.maker.contact_of(entry);
    const std::uint32_t lane = scene.layout.lane[place];
    IslandTouch touch;
    touch.contact = place;
    touch.a = seat_of(scene.layout, slice, scene.layout.slot_a[lane]);
    touch.b = seat_of(scene.layout, slice, scene.layout.slot_b[lane]);
    touch.normal = in_double(contact.normal).normalized();
    touch.round_a = double{contact.round_a};
    touch.round_b = double{contact.round_b};
    const bool exact = !scene.active.meetings.empty();
    const Surfaces::Meeting meeting = exact
        ? scene.active.meetings[scene.layout.contacts[place]]
        : Surfaces::Meeting{double{entry.friction}, double{entry.restitution},
                            double{entry.rolling_friction}};
    touch.restitution = meeting.restitution;
    touch.extent = double{entry.extent};
    touch.tolerance = kTolerance<Real> * touch.extent;
    DirectPoint point;
    point.a = touch.a;
    point.b = touch.b;
    point.normal = touch.normal;
    point.friction = meeting.friction;
    point.rolling = meeting.rolling_friction;
    const auto drive = [&](std::int32_t slot) {
        return scene.layout.movable(slot)
            ? scene.drives.of(scene.layout.body_of_slot[static_cast<std::size_t>(slot)])
            : nullptr;
    };
    const DriveVelocity* const by_a = drive(scene.layout.slot_a[lane]);
    const DriveVelocity* const by_b = drive(scene.layout.slot_b[lane]);
    for (int k = 0; k < contact.count; ++k) {
        const auto& from = contact.points[static_cast<std::size_t>(k)];
        touch.point = static_cast<std::uint32_t>(k);
        touch.gap = double{from.separation};
        point.arm_a = in_double(from.from_a);
        point.arm_b = point.arm_a + touch.normal * touch.gap + in_double(contact.between);
        touch.arm_a = point.arm_a - touch.normal * touch.round_a;
        touch.arm_b = point.arm_b + touch.normal * touch.round_b;
        if (by_a != nullptr || by_b != nullptr) walks_.push_back({touches_.size(), by_a, by_b});
        touches_.push_back(touch);
        points_.push_back(point);
    }
    const auto count = static_cast<std::size_t>(contact.count);
    guess(contact, std::span(points_).last(count));
}

template <class Real>
void WholeIsland::give_states(const DirectScene<Real>& scene,
                              const Slice& slice,
                              Rows<Real>& rows) const
{
    using Settled = typename Rows<Real>::Settled;
    for (std::uint32_t i = 0; i < slice.dynamic; ++i) {
        const IslandSeat& seat = seats_[i];
        const Vec3 position = scene.poses.position[seat.body] + seat.moved;
        Quat orientation = seat.turned * seat.orientation;
        orientation.coeffs() /= std::sqrt(orientation.squaredNorm());
        const bool sound = holdable(position, orientation, after_[i].velocity, after_[i].spin);
        rows.settled[slice.first_body + i] = sound ? Settled::yes : Settled::lost;
        if (!sound) continue;
        scene.poses.position[seat.body] = position;
        scene.poses.orientation[seat.body] = orientation;
        scene.velocities.linear[seat.body] = after_[i].velocity;
        scene.velocities.angular[seat.body] = after_[i].spin;
    }
}

// Of the points from `first` on, which are those of the contact.
template <class Real>
void WholeIsland::give_impulses(std::size_t first, Contact<Real>& contact) const
{
    const auto points = std::span(points_).subspan(first, static_cast<std::size_t>(contact.count));
    const Vec3 middle = middle_of(points);
    Vec3 friction = Vec3::Zero(), rolling = Vec3::Zero();
    double twist = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const DirectPoint& point = points[k];
        const double normal = point.normal.dot(point.impulse);
        const Vec3 across = point.impulse - point.normal * normal;
        contact.points[k].impulse = static_cast<Real>(std::max(normal, 0.0));
        friction += across;
        rolling += point.torque;
        twist += point.normal.dot((point.arm_a - middle).cross(across));
    }
    contact.friction = friction.template cast<Real>();
    contact.rolling = rolling.template cast<Real>();
    contact.twist = static_cast<Real>(points.size() > 1 ? twist : 0);
}

template <class Real>
void WholeIsland::finish(const DirectScene<Real>& scene, const Batch& batch, Rows<Real>& rows) const
{
    give_states(scene, scene.layout.slices[batch.first_slice], rows);
    for (std::size_t first = 0; first < touches_.size();) {
        const std::uint32_t entry = scene.layout.contacts[touches_[first].contact];
        Contact<Real>& contact = scene.maker.contact_of(scene.active.entries[entry]);
        give_impulses(first, contact);
        first += static_cast<std::size_t>(contact.count);
    }
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template WholeIsland::WholeIsland(const DirectScene<Real>&, const Batch&);                     \
    template void WholeIsland::finish(const DirectScene<Real>&, const Batch&, Rows<Real>&) const;
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
