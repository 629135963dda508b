#include "pipeline/solvers/released_loads.hpp"

#include "kernels/math/numbers.hpp"
#include "kernels/solver/coloring.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

// A contact is left where its bodies part faster than by so many times what acts in a substep.
constexpr double kLeft = 2;
// Share of what a contact gives below which it is the digits that part its bodies.
constexpr double kDigits = 1e-3;
// Times that contacts are looked at, each, before it is left to the solver. A column takes two.
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

// Whether it is faster by more than a speed, seen from what goes by a common velocity.
template <class Real>
bool gains(const SolverBody<Real>& body, const Four<Real>& common, Real speed)
{
    const Four<Real> motion = four_at(body.motion), free = four_at(body.free);
    return ((motion - free) * (motion + free - 2 * common)).sum() > speed * speed;
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
    for (const Slice& slice : std::span(layout.slices).subspan(batch.first_slice, batch.slices))
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

struct Motion {
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  // m/s, rad/s
};

struct BodyMotion {
    Motion free, now;  // without contacts, and with all that they give
    double inverse_mass = 0;
    Mat3 inverse_inertia = Mat3::Zero();
    double acts = 0;  // m/s, that all but contacts give in a substep

    void push(const Vec3& impulse, const Vec3& arm, const Vec3& turning)
    {
        now.velocity += inverse_mass * impulse;
        now.spin += inverse_inertia * (arm.cross(impulse) + turning);
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
        contacts_of_.resize(bodies_.size());
        for (std::uint32_t i = 0; i < contacts_.size(); ++i)
            for (const std::int32_t solver_index : {contacts_[i].a, contacts_[i].b})
                if (layout_.movable(solver_index)) contacts_of_[place(solver_index)].push_back(i);
    }

    bool run(std::span<const std::uint32_t> thrown)
    {
        std::vector<std::uint32_t> waiting;
        std::vector<std::uint8_t> waits(contacts_.size(), 0);
        const auto look_at_contacts_of = [&](std::int32_t solver_index) {
            if (!layout_.movable(solver_index)) return;
            for (const std::uint32_t contact : contacts_of_[place(solver_index)]) {
                if (waits[contact] != 0) continue;
                waits[contact] = 1;
                waiting.push_back(contact);
            }
        };
        for (const std::uint32_t solver_index : thrown)
            look_at_contacts_of(static_cast<std::int32_t>(solver_index));
        const std::size_t most = kMostLooks * contacts_.size();
        for (std::size_t next = 0; next < waiting.size() && next < most; ++next) {
            PressedContact& contact = contacts_[waiting[next]];
            waits[waiting[next]] = 0;
            if (!release(contact)) continue;
            look_at_contacts_of(contact.a);
            look_at_contacts_of(contact.b);
        }
        bool any = false;
        for (const PressedContact& contact : contacts_) {
            if (contact.share == 1) continue;
            builder_.scale_impulses(contact.place, static_cast<Real>(contact.share));
            any = true;
        }
        return any;
    }

private:
    std::size_t place(std::int32_t solver_index) const
    {
        return static_cast<std::size_t>(solver_index) - first_;
    }

    BodyMotion body_of(std::int32_t solver_index) const
    {
        const auto at = static_cast<std::size_t>(solver_index);
        const SolverBody<Real>& body = constraints_.bodies[at];
        BodyMotion motion;
        const Real* const now = layout_.movable(solver_index) ? body.free : body.motion;
        motion.free = {vector_at(now), vector_at(now + 4)};
        motion.now = motion.free;
        const Real* const m = body.inertia;
        motion.inverse_mass = double{m[0]};
        motion.inverse_inertia =
            Sym3{double{m[1]}, double{m[2]}, double{m[3]}, double{m[4]}, double{m[5]}, double{m[6]}}
                .matrix();
        if (layout_.movable(solver_index)) {
            const std::uint32_t of = layout_.body_of_solver_index[at];
            motion.acts = (motion.free.velocity - before_.linear[of]).norm();
        }
        return motion;
    }

    void list_contacts()
    {
        for (const Slice& slice :
             std::span(layout_.slices).subspan(batch_.first_slice, batch_.slices))
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

    // Of one of the two bodies of a contact.
    struct Side {
        double now = 0, free = 0;  // m/s, away from the other
        double gives_way = 0;      // 1/kg
        double acts = std::numeric_limits<double>::infinity();

        double driven() const { return now - free; }
    };

    Side side_of(std::int32_t solver_index, const Vec3& away, const Vec3& arm) const
    {
        const bool moves = layout_.movable(solver_index);
        const BodyMotion& body = moves ? bodies_[place(solver_index)] : body_of(solver_index);
        const Vec3 turning = arm.cross(away);
        Side side;
        side.now = away.dot(body.now.velocity) + turning.dot(body.now.spin);
        side.free = away.dot(body.free.velocity) + turning.dot(body.free.spin);
        if (!moves) return side;
        side.gives_way = body.inverse_mass + turning.dot(body.inverse_inertia * turning);
        side.acts = body.acts;
        return side;
    }

    // Takes back what parts the two bodies of a contact, as far as it gives it. False where they do
    // not part.
    bool release(PressedContact& contact)
    {
        if (!(contact.share > 0)) return false;
        const Side a = side_of(contact.a, -contact.normal, contact.arm_a);
        const Side b = side_of(contact.b, contact.normal, contact.arm_b);
        const double part = a.now + b.now;
        if (!(part > kLeft * std::min(a.acts, b.acts))) return false;
        // Who is driven back at the other is not who leaves him.
        const double most = std::max(a.driven(), b.driven());
        const auto leaves = [&](const Side& side) {
            return most > 0 ? std::max(side.driven(), 0.0) / most : 1.0;
        };
        const double way = leaves(a) * a.gives_way + leaves(b) * b.gives_way;
        if (!(way > 0)) return false;
        const double taken = std::min(part / way / contact.gives, contact.share);
        if (!(taken > kDigits)) return false;
        push(contact, -taken);
        contact.share -= taken;
        return true;
    }

    const Layout& layout_;
    const Batch& batch_;
    const ConstraintBuilder<Real>& builder_;
    const Velocities& before_;
    const ContactConstraints<Real>& constraints_;
    std::size_t first_;  // of the batch, among the solver bodies
    std::vector<BodyMotion> bodies_;
    std::vector<PressedContact> contacts_;
    std::vector<std::vector<std::uint32_t>> contacts_of_;  // [bodies of the batch]
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
