// Random contacts: bodies, contacts between them and the constraints they make, for tests of the
// solver.
#pragma once

#include "kernels/math/rotation.hpp"
#include "kernels/solver/contact_packing.hpp"
#include "kernels/solver/solve_kernels.hpp"
#include "tests/kernels/solver/plain_contact.hpp"

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace throng::given {

/// What a block is to be made of.
struct BlockWish {
    int lanes = kBlock;    // in use, from lane 0
    int points = 4;        // greatest number a contact
    bool still = true;     // some contacts with the still body, some with a kinematic one
    bool impulses = true;  // contacts start with some
    double greatest_separation = 0.02;  // m; overlaps go as far
    bool turns = true;                  // what is prepared: whether bodies turn
    bool restitutions = true;           // and whether there is restitution
    bool rolls = true;                  // and rolling friction
    bool round = true;                  // some sides are round
    bool pivots = false;                // some bodies turn without being moved
    bool uneven = true;      // the points of a contact do not lie in a plane across the normal
    bool one_place = false;  // the two sides meet in one place: angular momentum is kept
    bool friction_at_points = false;  // friction at every point
    bool pyramid = false;             // and within a pyramid

    bool friction_at_points_or_pyramid() const { return friction_at_points || pyramid; }
};

// Where the block stands among others, and its points, which no kernel may touch.
inline constexpr std::size_t kPlace = 1;
inline constexpr std::uint32_t kFirstPoint = 3;
inline constexpr std::int32_t kKinematic = 2 * kBlock + 1;  // place among the bodies

/// A block among blocks, with its bodies: the still one, two a lane, the kinematic one.
template <class Real>
struct BlockCase {
    ContactConstraints<Real> constraints;
    std::vector<Vec3> positions;                 // of the bodies, m
    std::vector<Contact<Real>> contacts;         // [lanes]
    std::vector<ContactParameters<Real>> terms;  // [lanes]
    bool turns = true;
    bool uncut = false;  // friction starts from all that is held

    ContactConstraintsView<Real> view() { return ContactConstraintsView<Real>::of(constraints); }
    ContactConstraintWide<Real>& block() { return constraints.blocks[kPlace]; }
    const ContactConstraintWide<Real>& block() const { return constraints.blocks[kPlace]; }
    ContactPointWide<Real>& point(int k)
    {
        return constraints.points[kFirstPoint + static_cast<unsigned>(k)];
    }
    const ContactPointWide<Real>& point(int k) const
    {
        return constraints.points[kFirstPoint + static_cast<unsigned>(k)];
    }
    SolverBody<Real>& body_a(std::size_t lane)
    {
        return constraints.bodies[static_cast<std::size_t>(block().a[lane])];
    }
    SolverBody<Real>& body_b(std::size_t lane)
    {
        return constraints.bodies[static_cast<std::size_t>(block().b[lane])];
    }
    bool writes_a(std::size_t lane) const { return (block().writes_a >> lane & 1) != 0; }
    bool writes_b(std::size_t lane) const { return (block().writes_b >> lane & 1) != 0; }

    void prepare(const SolveKernels<Real>& kernels)
    {
        PackedContacts<Real> packed;
        std::memset(static_cast<void*>(&packed), 0xff, sizeof(packed));
        for (int lane = 0; lane < kBlock; ++lane) {
            const auto at = static_cast<std::size_t>(lane);
            if (at < contacts.size())
                pack_contact(contacts[at], terms[at], lane, packed);
            else
                pack_empty_lane(lane, packed);
        }
        kernels.prepare(packed, kPlace, view(), turns);
        for (std::size_t lane = 0; uncut && lane < contacts.size(); ++lane)
            pack_unclamped_friction(contacts[lane], static_cast<int>(lane), block());
    }
    void warm_start(const SolveKernels<Real>& kernels, const SolverIteration<Real>& iteration)
    {
        const auto start = constraints.point_frictions.empty() ? kernels.warm_start
                                                               : kernels.warm_start_point_friction;
        start(view(), kPlace, kPlace + 1, iteration);
    }
    void solve(const SolveKernels<Real>& kernels, const SolverIteration<Real>& iteration)
    {
        const auto visited =
            constraints.point_frictions.empty() ? kernels.solve : kernels.solve_point_friction;
        visited(view(), kPlace, kPlace + 1, iteration);
    }
    bool apply_restitution(const SolveKernels<Real>& kernels,
                           const SolverIteration<Real>& iteration)
    {
        const auto struck = constraints.point_frictions.empty()
            ? kernels.apply_restitution
            : kernels.apply_restitution_point_friction;
        return struck(view(), kPlace, kPlace + 1, iteration);
    }
};

/// Makes room for a block of contacts of up to some points. All of it is not a number, so that
/// whoever reads what nobody wrote gives himself away.
template <class Real>
void make_points(int points, const BlockWish& wish, BlockCase<Real>& made)
{
    const auto poison = [](auto& constraints, std::size_t count) {
        constraints.resize(count);
        if (count > 0)
            std::memset(static_cast<void*>(constraints.data()), 0xff,
                        count * sizeof(constraints[0]));
    };
    const std::size_t all = kFirstPoint + static_cast<std::size_t>(points) + 2;
    poison(made.constraints.blocks, kPlace + 2);
    poison(made.constraints.points, all);
    poison(made.constraints.restitutions, wish.restitutions ? kPlace + 2 : 0);
    poison(made.constraints.rolling_frictions, wish.rolls ? kPlace + 2 : 0);
    poison(made.constraints.point_frictions, wish.friction_at_points_or_pyramid() ? all : 0);
    made.block().points = points;
    made.block().first_point = kFirstPoint;
    made.block().writes_a = made.block().writes_b = 0;
    made.block().axis_turns_a = made.block().axis_turns_b = 0;
    for (std::size_t lane = 0; lane < kBlock; ++lane)
        made.block().a[lane] = made.block().b[lane] = 0;
}

inline Vec3 random_vector(std::mt19937& random, double size)
{
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vec3(x, y, z) * size;
}

inline double random_number(std::mt19937& random, double least, double most)
{
    return std::uniform_real_distribution<double>(least, most)(random);
}

/// A body of some kilograms that moves, turns, and has done so since the step began.
template <class Real>
SolverBody<Real> random_body(std::mt19937& random)
{
    SolverBody<Real> body = {};
    const auto set = [&](Real* to, const Vec3& from) {
        for (int k = 0; k < 3; ++k) to[k] = static_cast<Real>(from[k]);
    };
    set(body.motion, random_vector(random, 1));
    set(body.motion + 4, random_vector(random, 3));
    set(body.free, random_vector(random, 1));
    set(body.free + 4, random_vector(random, 3));
    set(body.delta_pose, random_vector(random, 0.01));
    const Quat turn = exponential(random_vector(random, 0.1));
    set(body.delta_pose + 4, turn.vec());
    body.delta_pose[7] = static_cast<Real>(turn.w());

    const double mass = std::exp(random_number(random, -2, 2));
    const double x = random_number(random, 0.3, 1), y = random_number(random, 0.3, 1),
                 z = random_number(random, 0.3, 1);
    const Sym3 inverse{3 / (mass * (y * y + z * z)),
                       3 / (mass * (x * x + z * z)),
                       3 / (mass * (x * x + y * y)),
                       0,
                       0,
                       0};
    const Sym3 six = in_world_axes(inverse, exponential(random_vector(random, 2)));
    const double numbers[7] = {1 / mass, six.xx, six.yy, six.zz, six.xy, six.xz, six.yz};
    for (int k = 0; k < 7; ++k) body.inertia[k] = static_cast<Real>(numbers[k]);
    return body;
}

/// A contact of two bodies in the middle between them.
template <class Real>
Contact<Real> random_contact(std::mt19937& random,
                             const Vec3& position_a,
                             const Vec3& position_b,
                             const BlockWish& wish)
{
    Contact<Real> contact;
    const Vec3 normal = random_vector(random, 1).normalized();
    contact.normal = normal.cast<Real>();
    contact.count = 1 + static_cast<int>(random() % static_cast<unsigned>(wish.points));
    const Vec3 middle = (position_a + position_b) / 2;
    for (int k = 0; k < contact.count; ++k) {
        auto& point = contact.points[static_cast<std::size_t>(k)];
        Vec3 off = random_vector(random, 0.4);
        off -= normal * normal.dot(off);
        if (wish.uneven) off += normal * random_number(random, -0.02, 0.02);
        point.anchor_a = (middle + off - position_a).cast<Real>();
        point.separation = static_cast<Real>(
            random_number(random, -wish.greatest_separation, wish.greatest_separation));
        point.impulse =
            wish.impulses && k != 2 ? static_cast<Real>(random_number(random, 0, 2)) : 0;
        point.feature = static_cast<std::uint32_t>(10 + k);
    }
    if (wish.round) {
        if (random() % 3 == 0) contact.round_a = static_cast<Real>(random_number(random, 0, 0.5));
        if (random() % 3 == 0) contact.round_b = static_cast<Real>(random_number(random, 0, 0.5));
    }
    double clearance = 0;
    for (int k = 0; k < contact.count; ++k)
        clearance += double{contact.points[static_cast<std::size_t>(k)].separation}
            * share_of_center(contact, k);
    const Vec3 apart = wish.one_place ? Vec3(normal * clearance) : Vec3(Vec3::Zero());
    contact.center_offset = (position_a - position_b - apart).cast<Real>();
    if (wish.impulses) {
        Vec3 friction = random_vector(random, 0.2);
        friction -= normal * normal.dot(friction);
        contact.friction = friction.cast<Real>();
        if (contact.count > 1)
            contact.torsional_impulse = static_cast<Real>(random_number(random, -0.1, 0.1));
        contact.rolling = random_vector(random, 0.05).cast<Real>();
    }
    return contact;
}

template <class Real>
ContactParameters<Real> random_terms(std::mt19937& random)
{
    ContactParameters<Real> terms;
    terms.friction = static_cast<Real>(random_number(random, 0, 1));
    terms.restitution = random() % 3 == 0 ? 0 : static_cast<Real>(random_number(random, 0, 1));
    terms.rolling_friction = static_cast<Real>(random_number(random, 0, 0.05));
    terms.softness = softness<Real>(40, 10, 1.0 / 240);
    terms.deep = random() % 2 == 0 ? Real(0) : Real(0.005);
    return terms;
}

/// A block whose contacts are yet to be prepared.
template <class Real>
BlockCase<Real> packed_block(std::mt19937& random, const BlockWish& wish)
{
    BlockCase<Real> made;
    made.turns = wish.turns;
    made.uncut = wish.pyramid;
    SolverBody<Real> still = {};
    still.delta_pose[7] = 1;
    auto& bodies = made.constraints.bodies;
    bodies.push_back(still);
    for (int i = 0; i < 2 * kBlock; ++i) {
        bodies.push_back(random_body<Real>(random));
        if (i % 3 == 1) bodies.back().inertia[7] = 1;  // gravity in halves
        if (wish.pivots && random() % 3 != 0) {
            bodies.back().inertia[0] = 0;
            for (int k = 0; k < 3; ++k) bodies.back().motion[k] = bodies.back().delta_pose[k] = 0;
        }
    }
    SolverBody<Real> kinematic = random_body<Real>(random);
    for (Real& number : kinematic.inertia) number = 0;
    bodies.push_back(kinematic);
    for (std::size_t i = 0; i < bodies.size(); ++i)
        made.positions.push_back(random_vector(random, 0.5));

    struct Sides {
        std::int32_t a, b;
        unsigned side;
    };
    std::vector<Sides> sides;
    int points = 1;
    for (int lane = 0; lane < wish.lanes; ++lane) {
        Sides at{1 + 2 * lane, 2 + 2 * lane, wish.still ? static_cast<unsigned>(random() % 4) : 0};
        const std::int32_t replaced = random() % 2 == 0 ? 0 : kKinematic;
        if (at.side == 1) at.a = replaced;
        if (at.side == 2) at.b = replaced;
        sides.push_back(at);
        made.contacts.push_back(
            random_contact<Real>(random, made.positions[static_cast<std::size_t>(at.a)],
                                 made.positions[static_cast<std::size_t>(at.b)], wish));
        Contact<Real>& contact = made.contacts.back();
        // Straight below the center of whoever cannot be moved: there it has no lever arm, and
        // bears nothing.
        if (wish.pivots && at.side == 1 && random() % 2 == 0)
            for (int k = 0; k < contact.count; ++k) {
                auto& point = contact.points[static_cast<std::size_t>(k)];
                const Vec3T<Real> arm = -contact.normal * Real(0.3);
                point.anchor_a = arm - contact.center_offset - contact.normal * point.separation;
                point.impulse = 0;
            }
        made.terms.push_back(random_terms<Real>(random));
        points = std::max(points, contact.count);
    }
    make_points(points, wish, made);
    for (std::size_t lane = 0; lane < sides.size(); ++lane) {
        made.block().a[lane] = sides[lane].a;
        made.block().b[lane] = sides[lane].b;
        const auto bit = static_cast<std::uint16_t>(1u << lane);
        if (sides[lane].side != 1) made.block().writes_a |= bit;
        if (sides[lane].side != 2) made.block().writes_b |= bit;
    }
    return made;
}

template <class Real>
BlockCase<Real> random_block(std::mt19937& random, const BlockWish& wish)
{
    BlockCase<Real> made = packed_block<Real>(random, wish);
    made.prepare(*solve_kernels_of<Real>("scalar"));
    return made;
}

}  // namespace throng::given
