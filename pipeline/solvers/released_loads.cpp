#include "pipeline/solvers/released_loads.hpp"

#include "kernels/math/numbers.hpp"
#include "kernels/solver/coloring.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

// A contact is left where its bodies part faster than by so many times what acts in a substep.
constexpr double kLeft = 2;
// Share of what contacts give below which it is the digits that part their bodies.
constexpr double kDigits = 1e-3;
// Times that bodies are looked at, each, before it is left to the solver. A column takes two.
constexpr std::size_t kMostLooks = 16;

// Who is made faster by more than so many times what gravity gives in a substep, and what most
// bodies move by among one another, may be thrown: of an island of some, and of one of many, which
// takes longer to do anew, and where somebody always falls in.
constexpr int kThrown = 4, kThrownOfMany = 16;
// Bodies of an island that tell what most do.
constexpr std::size_t kTelling = 255;

// The middle one of some numbers.
template <class Real>
Real median(std::vector<Real>& numbers)
{
    const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
    std::nth_element(numbers.begin(), middle, numbers.end());
    return *middle;
}

template <class Real>
using Four = Eigen::Array<Real, 4, 1>;  // of which the last is 0
template <class Real>
Four<Real> four_at(const Real* numbers)
{
    return Eigen::Map<const Four<Real>>(numbers);
}

// Whether it is faster by more than a speed, and more than twice as fast, seen from what goes by a
// common velocity.
template <class Real>
bool gains(const SolverBody<Real>& body, const Four<Real>& common, Real speed)
{
    const Four<Real> motion = four_at(body.motion) - common, free = four_at(body.free) - common;
    const Real before = free.square().sum();
    return motion.square().sum() > before + std::max(speed * speed, 3 * before);
}

// What most bodies of an island go by without contacts, and how fast most do seen from there.
template <class Real>
std::pair<Four<Real>, Real> most_of(std::span<const SolverBody<Real>> island)
{
    const std::size_t every = island.size() / kTelling + 1;
    std::vector<Real> numbers;
    const auto median_of = [&](const auto& number) {
        numbers.clear();
        for (std::size_t i = 0; i < island.size(); i += every)
            numbers.push_back(number(four_at(island[i].free)));
        return median(numbers);
    };
    Four<Real> common = Four<Real>::Zero();
    for (int k = 0; k < 3; ++k)
        common[k] = median_of([k](const Four<Real>& free) { return free[k]; });
    return {common,
            median_of([&](const Four<Real>& free) { return (free - common).matrix().norm(); })};
}

// Of each island of a batch what it stands on, a place among the solver bodies: 0 where it touches
// anything that stands still, else what moves by itself and it touches, first in order.
std::vector<std::size_t> grounds_of(const Layout& layout, const Batch& batch)
{
    std::vector<std::size_t> grounds(batch.islands, 0);
    if (!batch.calls.driven) return grounds;
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    grounds.assign(batch.islands, kNone);
    for (const Slice& slice : layout.slices_of(batch))
        for (std::size_t i = slice.first_contact; i < slice.first_contact + slice.contacts; ++i) {
            std::int32_t moved = layout.solver_index_a[layout.lane[i]],
                         ground = layout.solver_index_b[layout.lane[i]];
            if (!layout.movable(moved)) std::swap(moved, ground);
            if (!layout.movable(moved) || layout.movable(ground)) continue;
            std::size_t& of_island = grounds[layout.island_of(batch, moved)];
            if (of_island == kNone || ground == 0) of_island = static_cast<std::size_t>(ground);
        }
    std::replace(grounds.begin(), grounds.end(), kNone, std::size_t{0});
    return grounds;
}

struct PushedBody {
    Vec3 free_velocity = Vec3::Zero(), free_spin = Vec3::Zero();  // m/s, rad/s, without contacts
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();            // with all that they give
    double inverse_mass = 0;
    Mat3 inverse_inertia = Mat3::Zero();
    // m/s, that all but contacts give in a substep; infinite of who moves by himself.
    double acts = std::numeric_limits<double>::infinity();

    void push(const Vec3& impulse, const Vec3& arm, const Vec3& turning)
    {
        velocity += inverse_mass * impulse;
        spin += inverse_inertia * (arm.cross(impulse) + turning);
    }
    // m/s, of a point; and what contacts give of that.
    Vec3 velocity_at(const Vec3& arm) const { return velocity + spin.cross(arm); }
    Vec3 given_at(const Vec3& arm) const
    {
        return velocity_at(arm) - free_velocity - free_spin.cross(arm);
    }
};

// A contact as one point, in the middle of what presses.
struct PressedContact {
    std::size_t place = 0;  // among the contacts of the layout
    std::int32_t a = 0, b = 0;
    Vec3 normal = Vec3::UnitZ(), arm_a = Vec3::Zero(), arm_b = Vec3::Zero();
    double gives = 0;                                     // N s, along the normal
    Vec3 impulse = Vec3::Zero(), turning = Vec3::Zero();  // N s, N m s: all of it, on b
    double share = 1;                                     // that is left of it
};

template <class Real>
class ReleasedLoads {
public:
    ReleasedLoads(const Layout& layout,
                  const Batch& batch,
                  const ConstraintBuilder<Real>& builder,
                  const Velocities& before,
                  const ContactConstraints<Real>& constraints)
        : layout_(layout), batch_(batch), builder_(builder), before_(before),
          constraints_(constraints), first_(layout.island_begin[batch.first_island]),
          bodies_(layout.island_begin[batch.first_island + batch.islands] - first_)
    {
        for (std::size_t i = 0; i < bodies_.size(); ++i)
            bodies_[i] = body_of(static_cast<std::int32_t>(first_ + i));
        list_contacts();
        waits_.assign(bodies_.size(), 0);
        contacts_of_.resize(bodies_.size());
        for (std::uint32_t i = 0; i < contacts_.size(); ++i)
            for (const std::int32_t solver_index : {contacts_[i].a, contacts_[i].b})
                if (layout_.movable(solver_index)) contacts_of_[place(solver_index)].push_back(i);
    }

    // Round by round, all that are looked at in one as the round before has left it: so what lies
    // evenly goes on to do so.
    bool run(std::span<const std::uint32_t> thrown)
    {
        for (const std::uint32_t solver_index : thrown)
            queue_around(static_cast<std::int32_t>(solver_index));
        const std::size_t most = kMostLooks * bodies_.size();
        for (std::size_t looks = 0; !next_.empty() && looks < most;) {
            std::vector<std::size_t> now;
            now.swap(next_);
            looks += now.size();
            std::vector<std::pair<std::uint32_t, double>> taken;
            for (const std::size_t body : now) {
                waits_[body] = 0;
                find_taken(body, taken);
            }
            for (const auto& [contact, share] : taken) {
                push(contacts_[contact], -share * contacts_[contact].share);
                contacts_[contact].share *= 1 - share;
                queue_around(contacts_[contact].a);
                queue_around(contacts_[contact].b);
            }
        }
        // Of whom nothing was taken is thrown by something else, as a blow.
        const auto gave = [&](std::uint32_t solver_index) {
            const auto& contacts = contacts_of_[solver_index - first_];
            return std::any_of(contacts.begin(), contacts.end(),
                               [&](std::uint32_t contact) { return contacts_[contact].share < 1; });
        };
        if (std::none_of(thrown.begin(), thrown.end(), gave)) return false;
        for (const PressedContact& contact : contacts_)
            if (contact.share < 1)
                builder_.scale_impulses(contact.place, static_cast<Real>(contact.share));
        return true;
    }

private:
    void queue(std::int32_t solver_index)
    {
        if (!layout_.movable(solver_index) || waits_[place(solver_index)] != 0) return;
        waits_[place(solver_index)] = 1;
        next_.push_back(place(solver_index));
    }
    // And whomever it touches: who was thrown may be the one whom somebody else leaves.
    void queue_around(std::int32_t solver_index)
    {
        if (!layout_.movable(solver_index)) return;
        queue(solver_index);
        for (const std::uint32_t contact : contacts_of_[place(solver_index)]) {
            queue(contacts_[contact].a);
            queue(contacts_[contact].b);
        }
    }

    std::size_t place(std::int32_t solver_index) const
    {
        return static_cast<std::size_t>(solver_index) - first_;
    }
    std::int32_t solver_index_of(std::size_t place) const
    {
        return static_cast<std::int32_t>(first_ + place);
    }

    PushedBody body_of(std::int32_t solver_index) const
    {
        const auto at = static_cast<std::size_t>(solver_index);
        const SolverBody<Real>& from = constraints_.bodies[at];
        const bool moves = layout_.movable(solver_index);
        const Real* const free = moves ? from.free : from.motion;
        PushedBody body;
        body.velocity = body.free_velocity = vector_at(free);
        body.spin = body.free_spin = vector_at(free + 4);
        if (!moves) return body;
        body.inverse_mass = double{from.inertia[0]};
        body.inverse_inertia = tensor_at(from.inertia + 1).matrix();
        const Vec3& before = before_.linear[layout_.body_of_solver_index[at]];
        body.acts = (body.free_velocity - before).norm();
        return body;
    }
    PushedBody now(std::int32_t solver_index) const
    {
        return layout_.movable(solver_index) ? bodies_[place(solver_index)] : body_of(solver_index);
    }

    void list_contacts()
    {
        for (const Slice& slice : layout_.slices_of(batch_))
            for (std::size_t i = slice.first_contact; i < slice.first_contact + slice.contacts; ++i)
                list(i);
    }

    void list(std::size_t at)
    {
        const Contact<Real>& kept = builder_.contact_at(at);
        PressedContact contact;
        Vec3 middle = Vec3::Zero();
        for (int k = 0; k < kept.count; ++k) {
            const double impulse{kept.points[static_cast<std::size_t>(k)].impulse};
            contact.gives += impulse;
            middle += impulse * kept.anchor_b(k).template cast<double>();
        }
        if (!(contact.gives > 0)) return;
        const std::size_t lane = layout_.lane[at];
        contact.place = at;
        contact.a = layout_.solver_index_a[lane];
        contact.b = layout_.solver_index_b[lane];
        contact.normal = kept.normal.template cast<double>();
        contact.arm_b = middle / contact.gives;
        contact.arm_a = contact.arm_b - kept.center_offset.template cast<double>();
        contact.impulse = contact.gives * contact.normal + kept.friction.template cast<double>();
        contact.turning =
            kept.rolling.template cast<double>() + double{kept.torsional_impulse} * contact.normal;
        push(contact, 1);
        contacts_.push_back(contact);
    }

    void push(const PressedContact& contact, double share)
    {
        if (layout_.movable(contact.a))
            bodies_[place(contact.a)].push(-share * contact.impulse, contact.arm_a,
                                           -share * contact.turning);
        if (layout_.movable(contact.b))
            bodies_[place(contact.b)].push(share * contact.impulse, contact.arm_b,
                                           share * contact.turning);
    }

    // m/s, of b's point seen from a's.
    Vec3 part_of(const PressedContact& contact) const
    {
        return now(contact.b).velocity_at(contact.arm_b)
            - now(contact.a).velocity_at(contact.arm_a);
    }

    // Whether and why the two bodies of a contact part.
    enum class Leaving : std::uint8_t { no, anyway, driven };

    // anyway: contacts drive neither of them away from the other. driven: this one more than that.
    Leaving leaving_of(const PressedContact& contact, std::size_t body) const
    {
        if (!(contact.share > 0)) return Leaving::no;
        const PushedBody a = now(contact.a), b = now(contact.b);
        const double part = contact.normal.dot(part_of(contact));
        if (!(part > kLeft * std::min(a.acts, b.acts))) return Leaving::no;
        const double a_driven = -contact.normal.dot(a.given_at(contact.arm_a)),
                     b_driven = contact.normal.dot(b.given_at(contact.arm_b));
        if (!(a_driven > 0 || b_driven > 0)) return Leaving::anyway;
        const bool is_a = contact.a == solver_index_of(body);
        const bool more = is_a ? a_driven >= b_driven : b_driven >= a_driven;
        return more ? Leaving::driven : Leaving::no;
    }

    // What is to be taken from the contacts that a body is driven away, as a share of what they
    // still give: that which leaves it the least energy, seen from those that it is driven away
    // from. Of contacts whose bodies part anyway all.
    void find_taken(std::size_t at, std::vector<std::pair<std::uint32_t, double>>& taken) const
    {
        std::vector<std::uint32_t> driving;
        double power = 0;
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // N s, N m s
        for (const std::uint32_t i : contacts_of_[at]) {
            const PressedContact& contact = contacts_[i];
            const Leaving leaving = leaving_of(contact, at);
            if (leaving == Leaving::anyway) taken.emplace_back(i, 1);
            if (leaving != Leaving::driven) continue;
            driving.push_back(i);
            const bool is_a = contact.a == solver_index_of(at);
            const double sign = is_a ? -contact.share : contact.share;
            const Vec3& arm = is_a ? contact.arm_a : contact.arm_b;
            power += contact.share * contact.impulse.dot(part_of(contact));
            force += sign * contact.impulse;
            torque += sign * (arm.cross(contact.impulse) + contact.turning);
        }
        const PushedBody& body = bodies_[at];
        const double twice_energy =
            body.inverse_mass * force.squaredNorm() + torque.dot(body.inverse_inertia * torque);
        const double share = twice_energy > 0 ? std::min(power / twice_energy, 1.0) : 0;
        if (!(share > kDigits)) return;
        for (const std::uint32_t contact : driving) taken.emplace_back(contact, share);
    }

    const Layout& layout_;
    const Batch& batch_;
    const ConstraintBuilder<Real>& builder_;
    const Velocities& before_;
    const ContactConstraints<Real>& constraints_;
    std::size_t first_;  // of the batch, among the solver bodies
    std::vector<PushedBody> bodies_;
    std::vector<PressedContact> contacts_;
    std::vector<std::vector<std::uint32_t>> contacts_of_;  // [bodies of the batch]
    std::vector<std::size_t> next_;                        // bodies to be looked at
    std::vector<std::uint8_t> waits_;                      // [bodies of the batch] are among them
};

}  // namespace

template <class Real>
std::vector<std::uint32_t> find_thrown(const Layout& layout,
                                       const Batch& batch,
                                       double falls,
                                       const ContactConstraints<Real>& constraints)
{
    std::vector<std::uint32_t> thrown;
    const int times = batch.contacts > kBatchContacts ? kThrownOfMany : kThrown;
    const Real least = static_cast<Real>(times * falls);
    const std::vector<std::size_t> grounds = grounds_of(layout, batch);
    for (std::size_t i = 0; i < batch.islands; ++i) {
        const std::uint32_t first = layout.island_begin[batch.first_island + i];
        const std::uint32_t end = layout.island_begin[batch.first_island + i + 1];
        const auto island = std::span(constraints.bodies).subspan(first, end - first);
        const Four<Real> still = four_at(constraints.bodies[grounds[i]].motion);
        if (std::none_of(island.begin(), island.end(),
                         [&](const SolverBody<Real>& body) { return gains(body, still, least); }))
            continue;
        const auto [common, most] = most_of(island);
        const Real speed = std::max(least, static_cast<Real>(times) * most);
        // Seen from the ground as well: of those that fall together whoever lands gains otherwise.
        for (std::uint32_t k = 0; k < island.size(); ++k)
            if (gains(island[k], still, least) && gains(island[k], common, speed))
                thrown.push_back(first + k);
    }
    return thrown;
}

template <class Real>
bool release_loads(const Layout& layout,
                   const Batch& batch,
                   const ConstraintBuilder<Real>& builder,
                   const Velocities& before,
                   std::span<const std::uint32_t> thrown,
                   const ContactConstraints<Real>& constraints)
{
    return ReleasedLoads<Real>(layout, batch, builder, before, constraints).run(thrown);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template std::vector<std::uint32_t> find_thrown<Real>(const Layout&, const Batch&, double,     \
                                                          const ContactConstraints<Real>&);        \
    template bool release_loads<Real>(const Layout&, const Batch&, const ConstraintBuilder<Real>&, \
                                      const Velocities&, std::span<const std::uint32_t>,           \
                                      const ContactConstraints<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
