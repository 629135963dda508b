// Next substep: what contacts gave in the last one, given back without asking them.
#include "tests/kernels/solver/random_iteration.hpp"

#include <gtest/gtest.h>

#include <string>

namespace throng {
namespace {

using given::BlockWish;

// Bodies that share many contacts, block after block.
template <class Real>
struct Heap {
    ContactConstraints<Real> constraints;
    std::vector<GyroscopicInertia<Real>> inertias;
    SolverIteration<Real> iteration;

    Heap(std::mt19937& random, const BlockWish& wish)
    {
        const std::size_t count = 3 * kBlock;
        std::vector<Vec3> positions;
        for (std::size_t i = 0; i < count; ++i) {
            constraints.bodies.push_back(given::random_body<Real>(random));
            positions.push_back(given::random_vector(random, 0.5));
            inertias.push_back({{Real(0.3), Real(0.2), Real(0.5), 0, 0, 0, 1, 0}, {}});
            if (i % 2 == 0) inertias.back().axis[2] = inertias.back().axis[3] = 1;
        }
        // A still one and one that moves by itself.
        for (Real& number : constraints.bodies[0].motion) number = 0;
        for (const std::size_t i : {0, 1})
            for (Real& number : constraints.bodies[i].inertia) number = 0;
        for (const std::size_t i : {0, 1}) inertias[i] = {};
        iteration = given::random_iteration<Real>(random, wish);
        iteration.use_bias = true;
        iteration.has_friction = iteration.has_friction || wish.rolls;

        std::vector<int> counts;
        for (int block = 0; block < 12; ++block) counts.push_back(1 + block % 4);
        std::uint32_t points = 0;
        for (const int most : counts) points += static_cast<std::uint32_t>(most);
        constraints.blocks.resize(counts.size());
        constraints.points.resize(points);
        constraints.rolling_frictions.resize(wish.rolls ? counts.size() : 0);
        constraints.restitutions.resize(wish.restitutions ? counts.size() : 0);
        points = 0;
        for (std::size_t place = 0; place < counts.size(); ++place) {
            fill(random, place, counts[place], points, positions, wish);
            points += static_cast<std::uint32_t>(counts[place]);
        }
    }

    void fill(std::mt19937& random,
              std::size_t place,
              int points,
              std::uint32_t first_point,
              const std::vector<Vec3>& positions,
              BlockWish wish)
    {
        ContactConstraintWide<Real>& block = constraints.blocks[place];
        block.points = wish.points = points;
        block.first_point = first_point;
        block.writes_a = block.writes_b = 0;
        // No body twice, but all of them again in the next block.
        std::vector<std::int32_t> order(constraints.bodies.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
        std::shuffle(order.begin(), order.end(), random);
        PackedContacts<Real> packed;
        std::array<Contact<Real>, kBlock> contacts;
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            const std::int32_t a = block.a[lane] = order[2 * lane];
            const std::int32_t b = block.b[lane] = order[2 * lane + 1];
            const auto bit = static_cast<std::uint16_t>(1u << lane);
            if (a > 1) block.writes_a |= bit;
            if (b > 1) block.writes_b |= bit;
            contacts[lane] =
                given::random_contact<Real>(random, positions[static_cast<std::size_t>(a)],
                                            positions[static_cast<std::size_t>(b)], wish);
            pack_contact(contacts[lane], given::random_terms<Real>(random), static_cast<int>(lane),
                         packed);
        }
        solve_kernels<Real>().prepare(packed, place, ContactConstraintsView<Real>::of(constraints),
                                      wish.turns);
    }

    void begin(Substep<Real> substep, bool first)
    {
        substep.first = first;
        const bool off = substep.gyroscopic == Substep<Real>::Gyroscopic::off;
        solve_kernels<Real>().begin_substep(constraints.bodies.data(),
                                            off ? nullptr : inertias.data(), nullptr,
                                            constraints.bodies.size(), substep);
    }
    void warm_start()
    {
        const auto view = ContactConstraintsView<Real>::of(constraints);
        solve_kernels<Real>().warm_start(view, 0, constraints.blocks.size(), iteration);
    }
    void solve(bool push)
    {
        SolverIteration<Real> how = iteration;
        how.use_bias = push;
        solve_kernels<Real>().solve(ContactConstraintsView<Real>::of(constraints), 0,
                                    constraints.blocks.size(), how);
    }
    void advance(Real time)
    {
        solve_kernels<Real>().advance(constraints.bodies.data(), inertias.data(), nullptr,
                                      constraints.bodies.size(), time, iteration.turns);
    }
};

template <class Real>
void check_given_back(double tolerance)
{
    using How = typename Substep<Real>::Gyroscopic;
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        const BlockWish wish{.impulses = random() % 2 == 0,
                             .turns = random() % 4 != 0,
                             .restitutions = random() % 2 == 0,
                             .rolls = random() % 2 == 0};
        Heap<Real> heap(random, wish);
        Substep<Real> substep{{0, 0, Real(-0.04)}, Real(1) / 240, true, How::off};
        if (wish.turns && seed % 3 != 0)
            substep.gyroscopic = seed % 3 == 1 ? How::implicit : How::direct;
        heap.begin(substep, true);
        heap.warm_start();
        for (int step = 0; step < 4; ++step) {
            heap.solve(true);
            heap.advance(substep.time);
            heap.solve(false);
            heap.solve(false);
            Heap<Real> asked = heap;
            asked.begin(substep, true);
            asked.warm_start();
            heap.begin(substep, false);
            for (std::size_t i = 0; i < heap.constraints.bodies.size(); ++i) {
                const SolverBody<Real>&got = heap.constraints.bodies[i],
                      &wanted = asked.constraints.bodies[i];
                double given = 1;
                for (int k = 0; k < 8; ++k)
                    given = std::max(given, std::abs(double{wanted.motion[k] - wanted.free[k]}));
                for (int k = 0; k < 8; ++k) {
                    ASSERT_NEAR(double{got.motion[k]}, double{wanted.motion[k]}, tolerance * given)
                        << "seed " << seed << " substep " << step << " body " << i;
                    ASSERT_EQ(got.free[k], wanted.free[k]);
                }
            }
        }
    }
}

TEST(NextSubstep, GivesBackWhatAWarmStartOfAllContactsWould)
{
    check_given_back<float>(1e-4);
    check_given_back<double>(1e-12);
}

TEST(NextSubstep, WhatMovesByItselfIsGivenNothing)
{
    std::mt19937 random(1);
    Heap<float> heap(random, {});
    const SolverBody<float> before = heap.constraints.bodies[1];
    heap.begin({{0, 0, -1}, 0.004f, true}, true);
    heap.warm_start();
    heap.solve(true);
    heap.begin({{0, 0, -1}, 0.004f, true}, false);
    for (int k = 0; k < 8; ++k) EXPECT_EQ(heap.constraints.bodies[1].motion[k], before.motion[k]);
}

}  // namespace
}  // namespace throng
