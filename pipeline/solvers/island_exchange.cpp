// Island exchange: an island taken from the step's data, and its answer given back.
#include "kernels/solver/driven_contacts.hpp"
#include "pipeline/forces/energy_limiter.hpp"
#include "pipeline/solvers/borne_bodies.hpp"
#include "pipeline/solvers/island_solver.hpp"

#include <algorithm>

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
    const double rest = double{contact.torsional_impulse}
        + points.front().normal.dot((middle_of(points) - middle).cross(friction));
    double spread = 0;
    for (std::size_t k = 0; k < points.size(); ++k)
        spread += double{contact.points[k].impulse}
            * points[k].normal.cross(points[k].arm_a - middle).squaredNorm();
    const double torsional_share = points.size() > 1 && spread > 0 ? rest / spread : 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        DirectPoint& point = points[k];
        const auto impulse = double{contact.points[k].impulse};
        const Vec3 round = point.normal.cross(point.arm_a - middle);
        point.impulse = point.normal * impulse + friction * (impulse / load)
            + round * (torsional_share * impulse);
        point.torque = in_double(contact.rolling) * (impulse / load);
    }
}

}  // namespace

template <class Real>
IslandSolver::IslandSolver(const IslandScene<Real>& scene, const Batch& batch)
{
    const Slice& slice = scene.layout.slices[batch.first_slice];
    parameters_ = scene.parameters;
    effort_ = scene.effort;
    left_ = effort_.steps * (2 + 2 * scene.context.substeps);
    up_ = up_of(scene.context.gravity);
    restitution_threshold_ = scene.context.resting_speed();
    spins_ = scene.context.response != Response::kinematic;
    take_bodies(scene, slice);
    take_forces(scene, slice);
    for (std::uint32_t i = 0; i < slice.contacts; ++i)
        take_contact(scene, slice, slice.first_contact + i);
    separations_.resize(contacts_.size());
    find_least_speeds(scene.context);
}

void IslandSolver::find_least_speeds(const StepContext& context)
{
    for (IslandContact& contact : contacts_) contact.least_speed = restitution_threshold_;
    if (!state_forces_) return;
    std::vector<Vec3> changes(bodies_.size(), Vec3::Zero());
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        if (after_[i].inverse_mass > 0) changes[i] = context.gravity * context.substep();
    for (const ForcedBody& forced : state_forces_->forced_bodies())
        changes[forced.at] = forced.pressing;
    const auto change_of = [&](std::int32_t body) -> Vec3 {
        return body < 0 ? Vec3(Vec3::Zero()) : changes[static_cast<std::size_t>(body)];
    };
    for (IslandContact& contact : contacts_)
        contact.least_speed = std::max(contact.least_speed,
                                       least_speed_of(contact.normal, change_of(contact.a),
                                                      change_of(contact.b), context.substeps));
}

template <class Real>
void IslandSolver::take_bodies(const IslandScene<Real>& scene, const Slice& slice)
{
    const Layout& layout = scene.layout;
    const auto add = [&](std::uint32_t solver_index, bool dynamic, bool advances) {
        IslandBody island_body;
        island_body.body = layout.body_of_solver_index[solver_index];
        island_body.dynamic = dynamic;
        island_body.advances = advances;
        const bool uneven = scene.facts.masses.gyroscopic_kind[island_body.body] != 0;
        island_body.precesses = dynamic && uneven && scene.context.has(Effect::gyroscopic);
        island_body.position = scene.poses.position[island_body.body];
        island_body.orientation = scene.poses.orientation[island_body.body];
        if (dynamic && scene.context.effects.meets(kForces)) {
            island_body.acceleration = scene.accelerations.linear[island_body.body];
            island_body.angular_acceleration = scene.accelerations.angular[island_body.body];
        }
        DirectBody body;
        body.velocity = scene.velocities.linear[island_body.body];
        body.spin = scene.velocities.angular[island_body.body];
        const bool turns = dynamic && scene.context.has(Effect::rotation);
        if (dynamic) body.inverse_mass = scene.facts.masses.inverse_mass[island_body.body];
        bodies_.push_back(island_body);
        after_.push_back(body);
        inertia_.push_back(scene.facts.masses.inertia[island_body.body]);
        inverse_inertia_.push_back(turns ? scene.facts.masses.inverse_inertia[island_body.body]
                                         : Sym3{});
    };
    for (std::uint32_t i = 0; i < slice.dynamic; ++i) add(slice.first_body + i, true, true);
    // Those that stay where they are while their surface moves come last.
    std::uint32_t kinematic_copies = slice.kinematic;
    for (std::uint32_t i = 0; i < slice.contacts; ++i) {
        const std::uint32_t lane = layout.lane[slice.first_contact + i];
        for (const std::int32_t solver_index :
             {layout.solver_index_a[lane], layout.solver_index_b[lane]})
            if (solver_index > 0 && !layout.movable(solver_index))
                kinematic_copies = std::max(kinematic_copies,
                                            static_cast<std::uint32_t>(solver_index)
                                                - slice.first_kinematic_copy + 1);
    }
    for (std::uint32_t i = 0; i < kinematic_copies; ++i)
        add(slice.first_kinematic_copy + i, false, i < slice.kinematic);
}

template <class Real>
void IslandSolver::take_forces(const IslandScene<Real>& scene, const Slice& slice)
{
    if (!scene.context.effects.meets(kFollowBodies)) return;
    std::vector<std::uint32_t> bodies;
    for (std::uint32_t i = 0; i < slice.dynamic; ++i) bodies.push_back(bodies_[i].body);
    state_forces_ = std::make_unique<StateDependentForces>(scene.context, scene.facts, bodies);
    if (state_forces_->forced_bodies().empty()) return state_forces_.reset();
    is_fed_ = bodies_.size() > slice.dynamic
        || std::any_of(bodies.begin(), bodies.end(),
                       [&](std::uint32_t body) { return is_fed(scene.facts.forces, body); });
    update_forced_bodies();
    state_forces_->find_changes();
    restitution_threshold_ =
        std::max(restitution_threshold_, 2 * state_forces_->least_change_of_step());
}

std::int32_t
IslandSolver::index_of(const Layout& layout, const Slice& slice, std::int32_t solver_index) const
{
    if (solver_index == 0) return -1;
    if (layout.movable(solver_index))
        return solver_index - static_cast<std::int32_t>(slice.first_body);
    return solver_index - static_cast<std::int32_t>(slice.first_kinematic_copy)
        + static_cast<std::int32_t>(slice.dynamic);
}

template <class Real>
void IslandSolver::take_contact(const IslandScene<Real>& scene,
                                const Slice& slice,
                                std::uint32_t place)
{
    const auto& entry = scene.active.entries[scene.layout.contacts[place]];
    const Contact<Real>& contact = scene.builder.contact_of(entry);
    const std::uint32_t lane = scene.layout.lane[place];
    const std::int32_t solver_a = scene.layout.solver_index_a[lane],
                       solver_b = scene.layout.solver_index_b[lane];
    IslandContact island_contact;
    island_contact.contact = place;
    island_contact.a = index_of(scene.layout, slice, solver_a);
    island_contact.b = index_of(scene.layout, slice, solver_b);
    island_contact.normal = in_double(contact.normal).normalized();
    island_contact.round_a = double{contact.round_a};
    island_contact.round_b = double{contact.round_b};
    const bool exact = !scene.active.materials.empty();
    const Surfaces::MaterialPair materials = exact
        ? scene.active.materials[scene.layout.contacts[place]]
        : Surfaces::MaterialPair{double{entry.friction}, double{entry.restitution},
                                 double{entry.rolling_friction}};
    const RollsFlat on_rim = scene.builder.rolls_on_rim(lane, contact);
    if (on_rim != RollsFlat::no)
        island_contact.rim = scene.builder.rim_of(on_rim == RollsFlat::a ? solver_b : solver_a);
    island_contact.rolls_flat = on_rim != RollsFlat::no
        ? on_rim
        : rolls_flat(contact, double{entry.extent}, scene.layout.movable(solver_a),
                     scene.layout.movable(solver_b));
    island_contact.center_offset = in_double(contact.center_offset);
    island_contact.restitution = materials.restitution;
    island_contact.extent = double{entry.extent};
    island_contact.tolerance = kTolerance<Real> * island_contact.extent;
    DirectPoint point;
    point.a = island_contact.a;
    point.b = island_contact.b;
    point.normal = island_contact.normal;
    point.friction = materials.friction;
    point.rolling = materials.rolling_friction;
    const auto drive = [&](std::int32_t solver_index) {
        return scene.layout.movable(solver_index) ? scene.prescribed.of(
                   scene.layout.body_of_solver_index[static_cast<std::size_t>(solver_index)])
                                                  : nullptr;
    };
    const PrescribedVelocity* const by_a = drive(solver_a);
    const PrescribedVelocity* const by_b = drive(solver_b);
    for (int k = 0; k < contact.count; ++k) {
        const auto& from = contact.points[static_cast<std::size_t>(k)];
        island_contact.point = static_cast<std::uint32_t>(k);
        island_contact.separation = double{from.separation};
        point.arm_a = in_double(from.anchor_a);
        point.arm_b = point.arm_a + island_contact.normal * island_contact.separation
            + island_contact.center_offset;
        island_contact.arm_a = point.arm_a - island_contact.normal * island_contact.round_a;
        island_contact.arm_b = point.arm_b + island_contact.normal * island_contact.round_b;
        if (by_a != nullptr || by_b != nullptr) walks_.push_back({contacts_.size(), by_a, by_b});
        contacts_.push_back(island_contact);
        points_.push_back(point);
    }
    const auto count = static_cast<std::size_t>(contact.count);
    guess(contact, std::span(points_).last(count));
}

template <class Real>
void IslandSolver::give_states(const IslandScene<Real>& scene,
                               const Slice& slice,
                               ContactConstraints<Real>& constraints) const
{
    using Settled = typename ContactConstraints<Real>::Settled;
    for (std::uint32_t i = 0; i < slice.dynamic; ++i) {
        const IslandBody& island_body = bodies_[i];
        const Vec3 position = scene.poses.position[island_body.body] + island_body.moved;
        Quat orientation = island_body.turned * island_body.orientation;
        orientation.coeffs() /= std::sqrt(orientation.squaredNorm());
        const bool sound = give_motion({position, orientation, after_[i].velocity, after_[i].spin},
                                       island_body.body, scene.poses, scene.velocities);
        constraints.settled[slice.first_body + i] = sound ? Settled::yes : Settled::lost;
    }
}

// Of the points from `first` on, which are those of the contact.
template <class Real>
void IslandSolver::give_impulses(std::size_t first, Contact<Real>& contact) const
{
    const auto points = std::span(points_).subspan(first, static_cast<std::size_t>(contact.count));
    const Vec3 middle = middle_of(points);
    Vec3 friction = Vec3::Zero(), rolling = Vec3::Zero();
    double torsional_sum = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const DirectPoint& point = points[k];
        const double normal = point.normal.dot(point.impulse);
        const Vec3 across = point.impulse - point.normal * normal;
        contact.points[k].impulse = static_cast<Real>(std::max(normal, 0.0));
        friction += across;
        rolling += point.torque;
        torsional_sum += point.normal.dot((point.arm_a - middle).cross(across));
    }
    contact.friction = friction.template cast<Real>();
    contact.rolling = rolling.template cast<Real>();
    contact.torsional_impulse = static_cast<Real>(points.size() > 1 ? torsional_sum : 0);
}

template <class Real>
void IslandSolver::finish(const IslandScene<Real>& scene,
                          const Batch& batch,
                          ContactConstraints<Real>& constraints) const
{
    give_states(scene, scene.layout.slices[batch.first_slice], constraints);
    for (std::size_t first = 0; first < contacts_.size();) {
        const std::uint32_t entry = scene.layout.contacts[contacts_[first].contact];
        Contact<Real>& contact = scene.builder.contact_of(scene.active.entries[entry]);
        give_impulses(first, contact);
        scene.builder.give_back(scene.active.entries[entry]);
        first += static_cast<std::size_t>(contact.count);
    }
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template IslandSolver::IslandSolver(const IslandScene<Real>&, const Batch&);                   \
    template void IslandSolver::finish(const IslandScene<Real>&, const Batch&,                     \
                                       ContactConstraints<Real>&) const;
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
