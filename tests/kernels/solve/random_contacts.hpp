// Random contacts: bodies, contacts between them and the block they make, for tests of the solver.
#pragma once

#include "kernels/math/rotation.hpp"
#include "kernels/solve/contact_rows.hpp"
#include "kernels/solve/sweep.hpp"

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace throng::testing {

/// What a block is to be made of.
struct BlockWish {
    int lanes = kBlock;          // in use, from lane 0
    int points = 4;              // greatest number a contact
    bool still = true;           // some contacts with the still body, some with a kinematic one
    bool impulses = true;        // contacts start with some
    double greatest_gap = 0.02;  // m; overlaps go as far
};

template <class Real>
struct BlockCase {
    ContactBlock<Real> block;
    std::vector<SolverBody<Real>> bodies;   // still one, 2 a lane, kinematic one
    std::vector<Vec3> positions;            // of the bodies, m
    std::vector<Contact<Real>> contacts;    // [lanes]
    std::vector<ContactTerms<Real>> terms;  // [lanes]
};

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
    const Sym3 six = Sym3::from(in_world_axes(inverse, exponential(random_vector(random, 2))));
    const double numbers[7] = {1 / mass, six.xx, six.yy, six.zz, six.xy, six.xz, six.yz};
    for (int k = 0; k < 7; ++k) body.inertia[k] = static_cast<Real>(numbers[k]);
    return body;
}

/// A contact of two bodies whose anchors meet in the world, so that angular momentum is kept.
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
        point.from_a = (middle + off - position_a).cast<Real>();
        point.from_b = (middle + off - position_b).cast<Real>();
        point.separation =
            static_cast<Real>(random_number(random, -wish.greatest_gap, wish.greatest_gap));
        point.impulse =
            wish.impulses && k != 2 ? static_cast<Real>(random_number(random, 0, 2)) : 0;
        point.feature = static_cast<std::uint32_t>(10 + k);
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
BlockCase<Real> random_block(std::mt19937& random, const BlockWish& wish)
{
    BlockCase<Real> made;
    std::memset(static_cast<void*>(&made.block), 0, sizeof(made.block));
    SolverBody<Real> still = {};
    still.drift[7] = 1;
    made.bodies.push_back(still);
    for (int i = 0; i < 2 * kBlock; ++i) made.bodies.push_back(random_body<Real>(random));
    SolverBody<Real> kinematic = random_body<Real>(random);
    for (Real& number : kinematic.inertia) number = 0;
    made.bodies.push_back(kinematic);
    for (std::size_t i = 0; i < made.bodies.size(); ++i)
        made.positions.push_back(random_vector(random, 0.5));

    for (int lane = 0; lane < wish.lanes; ++lane) {
        const auto at = static_cast<std::size_t>(lane);
        std::int32_t a = 1 + 2 * lane, b = 2 + 2 * lane;
        const auto replaced = static_cast<std::int32_t>(random() % 2 == 0 ? 0 : 2 * kBlock + 1);
        const unsigned side = wish.still ? random() % 4 : 0;
        if (side == 1) a = replaced;
        if (side == 2) b = replaced;
        made.block.a[at] = a;
        made.block.b[at] = b;
        if (side != 1)
            made.block.writes_a = static_cast<std::uint16_t>(made.block.writes_a | 1u << lane);
        if (side != 2)
            made.block.writes_b = static_cast<std::uint16_t>(made.block.writes_b | 1u << lane);
        made.contacts.push_back(
            random_contact<Real>(random, made.positions[static_cast<std::size_t>(a)],
                                 made.positions[static_cast<std::size_t>(b)], wish));
        ContactTerms<Real> terms;
        terms.friction = static_cast<Real>(random_number(random, 0, 1));
        terms.restitution = lane % 3 == 0 ? 0 : static_cast<Real>(random_number(random, 0, 1));
        terms.rolling_friction = static_cast<Real>(random_number(random, 0, 0.05));
        terms.softness = softness<Real>(40, 10, 1.0 / 240);
        terms.deep = lane % 2 == 0 ? Real(0) : Real(0.005);
        made.terms.push_back(terms);
        made.block.points = std::max<std::int32_t>(made.block.points, made.contacts[at].count);
    }
    made.block.points = std::max<std::int32_t>(made.block.points, 1);
    for (int lane = 0; lane < kBlock; ++lane) {
        if (lane >= wish.lanes) {
            clear_lane(made.block, lane, 0);
            continue;
        }
        const auto at = static_cast<std::size_t>(lane);
        fill_lane(made.block, lane, made.contacts[at],
                  made.bodies[static_cast<std::size_t>(made.block.a[at])],
                  made.bodies[static_cast<std::size_t>(made.block.b[at])], made.terms[at]);
    }
    return made;
}

}  // namespace throng::testing
