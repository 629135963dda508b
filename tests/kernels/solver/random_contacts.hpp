// Random contacts: bodies, contacts between them and the rows they make, for tests of the solver.
#pragma once

#include "kernels/math/rotation.hpp"
#include "kernels/solver/contact_rows.hpp"
#include "kernels/solver/sweep.hpp"

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace throng::given {

/// What a block is to be made of.
struct BlockWish {
    int lanes = kBlock;          // in use, from lane 0
    int points = 4;              // greatest number a contact
    bool still = true;           // some contacts with the still body, some with a kinematic one
    bool impulses = true;        // contacts start with some
    double greatest_gap = 0.02;  // m; overlaps go as far
    bool turns = true;           // what is prepared: whether bodies turn
    bool bounces = true;         // and whether there is restitution
    bool rolls = true;           // and rolling friction
    bool round = true;           // some sides are round
    bool pivots = false;         // some bodies turn without being moved
    bool uneven = true;          // the points of a contact do not lie in a plane across the normal
    bool meeting = false;        // the two sides meet in one place: angular momentum is kept
    bool at_points = false;      // friction at every point
    bool pyramid = false;        // and within a pyramid

    bool grips_apart() const { return at_points || pyramid; }
};

// Where the block stands among others, and its points, which no kernel may touch.
inline constexpr std::size_t kPlace = 1;
inline constexpr std::uint32_t kFirstPoint = 3;
inline constexpr std::int32_t kKinematic = 2 * kBlock + 1;  // place among the bodies

/// A block among blocks, with its bodies: the still one, two a lane, the kinematic one.
template <class Real>
struct BlockCase {
    Rows<Real> rows;
    std::vector<Vec3> positions;            // of the bodies, m
    std::vector<Contact<Real>> contacts;    // [lanes]
    std::vector<ContactTerms<Real>> terms;  // [lanes]
    bool turns = true;
    bool uncut = false;  // friction starts from all that is held

    RowsView<Real> view() { return RowsView<Real>::of(rows); }
    ContactBlock<Real>& block() { return rows.blocks[kPlace]; }
    const ContactBlock<Real>& block() const { return rows.blocks[kPlace]; }
    PointRows<Real>& point(int k) { return rows.points[kFirstPoint + static_cast<unsigned>(k)]; }
    const PointRows<Real>& point(int k) const
    {
        return rows.points[kFirstPoint + static_cast<unsigned>(k)];
    }
    SolverBody<Real>& body_a(std::size_t lane)
    {
        return rows.bodies[static_cast<std::size_t>(block().a[lane])];
    }
    SolverBody<Real>& body_b(std::size_t lane)
    {
        return rows.bodies[static_cast<std::size_t>(block().b[lane])];
    }
    bool writes_a(std::size_t lane) const { return (block().writes_a >> lane & 1) != 0; }
    bool writes_b(std::size_t lane) const { return (block().writes_b >> lane & 1) != 0; }

    void prepare(const SolveKernels<Real>& kernels)
    {
        LooseBlock<Real> loose;
        std::memset(static_cast<void*>(&loose), 0xff, sizeof(loose));
        for (int lane = 0; lane < kBlock; ++lane) {
            const auto at = static_cast<std::size_t>(lane);
            if (at < contacts.size())
                loosen(contacts[at], terms[at], lane, loose);
            else
                loosen_nothing(lane, loose);
        }
        kernels.prepare(loose, kPlace, view(), turns);
        for (std::size_t lane = 0; uncut && lane < contacts.size(); ++lane)
            hold_uncut(contacts[lane], static_cast<int>(lane), block());
    }
    void warm_start(const SolveKernels<Real>& kernels, const Visit<Real>& visit)
    {
        const auto start = rows.grips.empty() ? kernels.warm_start : kernels.warm_start_grips;
        start(view(), kPlace, kPlace + 1, visit);
    }
    void sweep(const SolveKernels<Real>& kernels, const Visit<Real>& visit)
    {
        const auto visited = rows.grips.empty() ? kernels.sweep : kernels.sweep_grips;
        visited(view(), kPlace, kPlace + 1, visit);
    }
    bool bounce(const SolveKernels<Real>& kernels, const Visit<Real>& visit)
    {
        const auto struck = rows.grips.empty() ? kernels.bounce : kernels.bounce_grips;
        return struck(view(), kPlace, kPlace + 1, visit);
    }
};

/// Makes room for a block of contacts of up to some points. All of it is not a number, so that
/// whoever reads what nobody wrote gives himself away.
template <class Real>
void make_room(int points, const BlockWish& wish, BlockCase<Real>& made)
{
    const auto poison = [](auto& rows, std::size_t count) {
        rows.resize(count);
        if (count > 0) std::memset(static_cast<void*>(rows.data()), 0xff, count * sizeof(rows[0]));
    };
    const std::size_t all = kFirstPoint + static_cast<std::size_t>(points) + 2;
    poison(made.rows.blocks, kPlace + 2);
    poison(made.rows.points, all);
    poison(made.rows.bounces, wish.bounces ? kPlace + 2 : 0);
    poison(made.rows.rollings, wish.rolls ? kPlace + 2 : 0);
    poison(made.rows.grips, wish.grips_apart() ? all : 0);
    made.block().points = points;
    made.block().first_point = kFirstPoint;
    made.block().writes_a = made.block().writes_b = 0;
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
    set(body.drift, random_vector(random, 0.01));
    const Quat turn = exponential(random_vector(random, 0.1));
    set(body.drift + 4, turn.vec());
    body.drift[7] = static_cast<Real>(turn.w());

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
    double gap = 0;
    for (int k = 0; k < contact.count; ++k) {
        auto& point = contact.points[static_cast<std::size_t>(k)];
        Vec3 off = random_vector(random, 0.4);
        off -= normal * normal.dot(off);
        if (wish.uneven) off += normal * random_number(random, -0.02, 0.02);
        point.from_a = (middle + off - position_a).cast<Real>();
        point.separation =
            static_cast<Real>(random_number(random, -wish.greatest_gap, wish.greatest_gap));
        gap += double{point.separation} / contact.count;
        point.impulse =
            wish.impulses && k != 2 ? static_cast<Real>(random_number(random, 0, 2)) : 0;
        point.feature = static_cast<std::uint32_t>(10 + k);
    }
    const Vec3 apart = wish.meeting ? Vec3(normal * gap) : Vec3(Vec3::Zero());
    contact.between = (position_a - position_b - apart).cast<Real>();
    if (wish.round) {
        if (random() % 3 == 0) contact.round_a = static_cast<Real>(random_number(random, 0, 0.5));
        if (random() % 3 == 0) contact.round_b = static_cast<Real>(random_number(random, 0, 0.5));
    }
    if (wish.impulses) {
        Vec3 friction = random_vector(random, 0.2);
        friction -= normal * normal.dot(friction);
        contact.friction = friction.cast<Real>();
        if (contact.count > 1) contact.twist = static_cast<Real>(random_number(random, -0.1, 0.1));
        contact.rolling = random_vector(random, 0.05).cast<Real>();
    }
    return contact;
}

template <class Real>
ContactTerms<Real> random_terms(std::mt19937& random)
{
    ContactTerms<Real> terms;
    terms.friction = static_cast<Real>(random_number(random, 0, 1));
    terms.restitution = random() % 3 == 0 ? 0 : static_cast<Real>(random_number(random, 0, 1));
    terms.rolling_friction = static_cast<Real>(random_number(random, 0, 0.05));
    terms.softness = softness<Real>(40, 10, 1.0 / 240);
    terms.deep = random() % 2 == 0 ? Real(0) : Real(0.005);
    return terms;
}

/// A block whose contacts are yet to be prepared.
template <class Real>
BlockCase<Real> loose_block(std::mt19937& random, const BlockWish& wish)
{
    BlockCase<Real> made;
    made.turns = wish.turns;
    made.uncut = wish.pyramid;
    SolverBody<Real> still = {};
    still.drift[7] = 1;
    auto& bodies = made.rows.bodies;
    bodies.push_back(still);
    for (int i = 0; i < 2 * kBlock; ++i) {
        bodies.push_back(random_body<Real>(random));
        if (wish.pivots && random() % 3 != 0) {
            bodies.back().inertia[0] = 0;
            for (int k = 0; k < 3; ++k) bodies.back().motion[k] = bodies.back().drift[k] = 0;
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
        // Straight below the center of whoever cannot be moved: there it has no lever, and bears
        // nothing.
        if (wish.pivots && at.side == 1 && random() % 2 == 0)
            for (int k = 0; k < contact.count; ++k) {
                auto& point = contact.points[static_cast<std::size_t>(k)];
                const Vec3T<Real> arm = -contact.normal * Real(0.3);
                point.from_a = arm - contact.between - contact.normal * point.separation;
                point.impulse = 0;
            }
        made.terms.push_back(random_terms<Real>(random));
        points = std::max(points, contact.count);
    }
    make_room(points, wish, made);
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
    BlockCase<Real> made = loose_block<Real>(random, wish);
    made.prepare(*solve_kernels_of<Real>("scalar"));
    return made;
}

}  // namespace throng::given
