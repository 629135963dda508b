// Measures: what a state is worth, from geometry and velocities alone.
//
// Nothing the solver believes goes in: overlaps are found afresh on the poses as they are.
#include "kernels/dynamics/energy.hpp"
#include "kernels/math/hash.hpp"
#include "kernels/math/rotation.hpp"
#include "pipeline/contacts/recycled_manifolds.hpp"
#include "pipeline/solvers/escalation.hpp"
#include "pipeline/world/collider_overlaps.hpp"
#include "pipeline/world/world_state.hpp"

#include <algorithm>

namespace throng {

namespace {

void measure_overlaps(const WorldState& state, Measures& measures)
{
    double sum = 0;
    for (const ColliderOverlap& overlap : find_collider_overlaps(state)) {
        ++measures.overlapping_pairs;
        sum += overlap.depth;
        measures.greatest_overlap = std::max(measures.greatest_overlap, overlap.depth);
    }
    if (measures.overlapping_pairs > 0)
        measures.mean_overlap = sum / static_cast<double>(measures.overlapping_pairs);
}

}  // namespace

Measures World::measure() const
{
    const Door::Entry entry(state_->door, "measure", Door::Use::looks);
    Measures measures;
    measure_overlaps(*state_, measures);
    const auto& masses = state_->get<Masses>();
    const auto& states = state_->get<BodyStates>();
    const auto& poses = state_->get<Poses>();
    const auto& velocities = state_->get<Velocities>();
    for (std::uint32_t body = 0; body < states.kind.size(); ++body) {
        if (!states.dynamic(body)) continue;
        const Vec3 v = state_->velocity(body);
        const Vec3& w = velocities.angular[body];
        const Vec3 spin = in_world_axes(masses.inertia[body], poses.orientation[body]).matrix() * w;
        measures.kinetic_energy += kinetic_energy_of(body, masses, poses, velocities);
        measures.potential_energy -=
            masses.mass[body] * gravity().dot(state_->center_of_mass(body));
        measures.momentum += masses.mass[body] * v;
        measures.angular_momentum += masses.mass[body] * poses.position[body].cross(v) + spin;
    }
    measures.potential_energy +=
        potential_of(state_->get<Forces>(), masses, poses, state_->get<StepContext>().substep());
    return measures;
}

namespace {

// All that the next step begins with.
class StateHash {
public:
    explicit StateHash(const WorldState& state) : state_(state) { }

    std::string text()
    {
        add_bodies();
        add_strains();
        // Where a method of choice will begin, which may show in the last bits of what it finds.
        for (const MethodMemory& memory : state_.get<MethodPairs>().of_pair) {
            add_vector(memory.axis);
            for (std::size_t i = 0; i < 4; ++i)
                hash_.add(std::uint64_t{memory.a[i]} << 32 | memory.b[i]);
            hash_.add(std::uint64_t{memory.count} << 32 | memory.kind);
        }
        std::visit(
            [&](const auto& chosen) {
                using Real =
                    std::conditional_t<std::is_same_v<std::decay_t<decltype(chosen)>, Step<float>>,
                                       float, double>;
                add_contacts<Real>(chosen.data);
            },
            state_.step);
        return hash_.text();
    }

private:
    void add_bodies()
    {
        const auto& poses = state_.get<Poses>();
        const auto& velocities = state_.get<Velocities>();
        const auto& states = state_.get<BodyStates>();
        for (std::size_t body = 0; body < states.kind.size(); ++body) {
            hash_.add(std::uint64_t{static_cast<std::uint8_t>(states.kind[body])});
            if (states.kind[body] == BodyKind::removed) continue;
            add_pose(poses.position[body], poses.orientation[body]);
            add_vector(velocities.linear[body]);
            add_vector(velocities.angular[body]);
            hash_.add(std::uint64_t{states.awake[body]});
            hash_.add(states.sleep_time[body]);
        }
    }

    void add_strains()
    {
        const auto& overloaded = state_.get<OverloadedIslands>();
        for (const std::uint32_t body : overloaded.strained) {
            if (!is_overloaded(overloaded.of(body))) continue;
            hash_.add(std::uint64_t{body});
            hash_.add(overloaded.of(body));
        }
    }

    template <class Real, class Data>
    void add_contacts(const Data& data)
    {
        const auto& pairs = std::get<Pairs>(data);
        const auto& convex = std::get<ConvexContacts<Real>>(data);
        for (std::size_t i = 0; i < convex.of_pair.size(); ++i) {
            const Contact<Real>* const contact = convex.at(i);
            if (contact == nullptr) continue;
            add_contact(pairs.keys[i], *contact);
            if (convex.recycles
                && is_recycled(kind_of(first_of(pairs.keys[i])), kind_of(second_of(pairs.keys[i]))))
                add_found(convex.found[convex.of_pair[i].contact]);
        }
        const auto add_many = [&](const ManyContacts<Real>& many) {
            for (const auto& entry : many.entries) {
                hash_.add(std::uint64_t{entry.part});
                add_contact(pairs.keys[entry.pair], entry.contact);
            }
            for (const auto& found : many.found.pairs)
                for (std::uint32_t k = 0; k < found.count; ++k)
                    add_found(CachedManifold<double>{many.found.manifolds[found.first + k].manifold,
                                                     found.b_in_a, found.speculative_margin});
        };
        add_many(std::get<MeshContacts<Real>>(data));
        add_many(std::get<SolidContacts<Real>>(data));
    }

    template <class Contact>
    void add_contact(std::uint64_t key, const Contact& contact)
    {
        if (contact.count == 0) return;
        hash_.add(key);
        for (int k = 0; k < contact.count; ++k) {
            const auto& point = contact.points[static_cast<std::size_t>(k)];
            hash_.add(std::uint64_t{point.feature});
            hash_.add(point.impulse);
        }
        add_vector(contact.friction);
        hash_.add(contact.torsional_impulse);
        add_vector(contact.rolling);
    }

    // What a contact will be told from as long as its pair hardly moves.
    template <class Found>
    void add_found(const Found& found)
    {
        hash_.add(found.speculative_margin);
        add_pose(found.b_in_a.position, found.b_in_a.orientation);
        add_vector(found.manifold.normal);
        for (int k = 0; k < found.manifold.count; ++k) {
            const auto& point = found.manifold.points[static_cast<std::size_t>(k)];
            add_vector(point.position);
            hash_.add(point.separation);
            hash_.add(std::uint64_t{point.feature});
        }
    }

    template <class Position, class Orientation>
    void add_pose(const Position& position, const Orientation& orientation)
    {
        add_vector(position);
        for (int k = 0; k < 4; ++k) hash_.add(orientation.coeffs()[k]);
    }
    template <class Vector>
    void add_vector(const Vector& v)
    {
        for (int k = 0; k < 3; ++k) hash_.add(v[k]);
    }
    ShapeKind kind_of(std::uint32_t collider) const
    {
        return state_.get<Colliders>().shape[collider].kind;
    }

    const WorldState& state_;
    Hash hash_;
};

}  // namespace

std::string World::state_hash() const
{
    const Door::Entry entry(state_->door, "state_hash", Door::Use::looks);
    // All pairs in one order, whoever sleeps.
    state_->settle();
    state_->call_all_pairs();
    return StateHash(*state_).text();
}

std::size_t World::memory_bytes() const
{
    const auto bytes = [](const auto&... arrays) {
        return (std::size_t{0} + ... + (arrays.capacity() * sizeof(arrays[0])));
    };
    const auto& p = state_->get<Poses>();
    const auto& v = state_->get<Velocities>();
    const auto& m = state_->get<Masses>();
    const auto& s = state_->get<BodyStates>();
    const auto& c = state_->get<Colliders>();
    const auto& b = state_->get<Bounds>();
    const auto& shapes = state_->get<Shapes>();
    std::size_t sum =
        bytes(p.position, p.orientation, v.linear, v.angular, m.mass, m.inverse_mass, m.inertia,
              m.inverse_inertia, s.kind, s.awake, s.sleep_time, s.sleeping_island, c.body, c.shape,
              c.local, c.material, c.inner_extent, c.outer_radius, b.boxes, b.speculative_margin,
              b.placed, b.near, b.half[0], b.half[1], b.half[2], b.round, b.form, b.scratch.flags,
              shapes.boxes, shapes.spheres, state_->center, state_->names, state_->generation);
    std::visit(
        [&](const auto& chosen) {
            using Real =
                std::conditional_t<std::is_same_v<std::decay_t<decltype(chosen)>, Step<float>>,
                                   float, double>;
            const auto& pairs = std::get<Pairs>(chosen.data);
            const auto& convex = std::get<ConvexContacts<Real>>(chosen.data);
            const auto& constraints = std::get<ContactConstraints<Real>>(chosen.data);
            const auto& methods = std::get<MethodPairs>(chosen.data);
            const auto& joined = std::get<JoinedContacts<Real>>(chosen.data);
            const auto add_many = [&](const ManyContacts<Real>& many) {
                sum += bytes(many.entries, many.before, many.found.pairs, many.found.manifolds,
                             many.found_before.pairs, many.found_before.manifolds);
            };
            add_many(std::get<MeshContacts<Real>>(chosen.data));
            add_many(std::get<SolidContacts<Real>>(chosen.data));
            const auto& sleeping = std::get<SleepingPairs>(chosen.data);
            const auto& asleep = std::get<SleepingContacts<Real>>(chosen.data);
            const auto& resting = std::get<RestingBodies>(chosen.data);
            sum += bytes(resting.borne, resting.scratch.now, resting.scratch.may);
            for (const auto& held : sleeping.of_island) sum += bytes(held.refs);
            for (const auto& [body, held] : sleeping.of_still) sum += bytes(held.refs);
            sum += bytes(sleeping.kept, sleeping.free, sleeping.of_island, asleep.of_kept,
                         asleep.contacts, asleep.found, asleep.free_contacts, asleep.memories);
            sum += bytes(pairs.keys, pairs.from, pairs.scratch.found, pairs.asked, convex.of_pair,
                         convex.contacts, convex.free, convex.astray, convex.scratch.gathered,
                         convex.scratch.order, convex.found, convex.scratch.found_gathered,
                         convex.apart_until, convex.travels.placed, convex.travels.traveled,
                         convex.travels.approach, methods.of_pair, methods.bounds,
                         methods.scratch.fallbacks, std::get<ActiveContacts>(chosen.data).entries,
                         constraints.blocks, constraints.points, constraints.restitutions,
                         constraints.rolling_frictions, constraints.surface_velocities,
                         constraints.turning_arms, constraints.prescribed, constraints.bodies,
                         constraints.inertias, constraints.rims, joined.contacts, joined.sources,
                         joined.scratch.candidates, joined.scratch.joined, joined.scratch.touches);
        },
        state_->step);
    return sum;
}

}  // namespace throng
