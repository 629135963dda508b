// Solve kernels: the iterations of the solver against the textbook, and what no iteration may do.
#include "kernels/solver/solve_kernels.hpp"

#include "tests/kernels/solver/plain_contact.hpp"
#include "tests/kernels/solver/random_contacts.hpp"
#include "tests/kernels/solver/random_iteration.hpp"
#include "tests/support/same_bytes.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::BlockCase;
using given::BlockWish;
using given::PlainBody;
using given::PlainContact;
using given::PlainIteration;
using given::random_block;
using given::random_iteration;
using given::run_all;
using given::same_bytes;

template <class Real>
PlainContact plain_contact(const BlockCase<Real>& made, std::size_t lane)
{
    const auto body = [&](std::int32_t place) -> const SolverBody<Real>& {
        return made.constraints.bodies[static_cast<std::size_t>(place)];
    };
    return {made.contacts[lane], made.terms[lane],
            PlainBody(body(made.block().a[lane]), made.writes_a(lane), made.turns),
            PlainBody(body(made.block().b[lane]), made.writes_b(lane), made.turns)};
}

template <class Real>
PlainIteration plain_iteration_of(const BlockCase<Real>& made,
                                  const SolverIteration<Real>& iteration)
{
    PlainIteration plain{1 / 240.0, 3, iteration.use_bias, iteration.has_friction};
    plain.has_rolling_friction = iteration.has_rolling_friction && made.turns;
    plain.friction_at_points = iteration.friction_at_points;
    plain.friction_pyramid = iteration.friction_pyramid;
    const bool apart = iteration.friction_at_points || iteration.friction_pyramid;
    plain.together =
        made.turns && (made.block().points > 1 || iteration.has_rolling_friction || apart);
    plain.normal_iterations = iteration.normal_iterations;
    plain.restitution_threshold = double{iteration.restitution_threshold};
    plain.gravity_step = Vec3(double{iteration.gravity_step[0]}, double{iteration.gravity_step[1]},
                              double{iteration.gravity_step[2]});
    plain.restitutions = !made.constraints.restitutions.empty();
    return plain;
}

// What run_all does.
void run_all(PlainContact& contact, PlainIteration iteration, bool restitutions)
{
    if (restitutions) contact.apply_restitution(iteration);
    contact.warm_start(iteration);
    contact.solve(iteration);
    iteration.use_bias = !iteration.use_bias;
    contact.solve(iteration);
}

// N s, of the impact of a lane.
template <class Real>
Vec3 impact_on(const BlockCase<Real>& made, std::size_t lane)
{
    const auto vec = [&](const Lane16<Real>(&from)[3]) {
        return Vec3(double{from[0].at[lane]}, double{from[1].at[lane]}, double{from[2].at[lane]});
    };
    const Vec3 normal = vec(made.block().normal), tangent = vec(made.block().tangent);
    const Vec3 given = vec(made.constraints.restitutions[given::kPlace].impulse);
    return normal * given[0] + tangent * given[1] + normal.cross(tangent) * given[2];
}

// A lane of the block after the iterations, as the textbook has it.
template <class Real>
void expect_lane(BlockCase<Real>& made,
                 const std::vector<SolverBody<Real>>& before,
                 std::size_t lane,
                 const PlainContact& wanted,
                 double tolerance)
{
    // Impulses that are huge, as those on next to no lever arm are, have that much greater a last
    // digit.
    double greatest = 0;
    for (const PlainContact::Point& point : wanted.points)
        greatest = std::max(greatest, point.impulse);
    greatest = std::max(greatest, wanted.impact_impulse.norm());
    tolerance *= std::max(1.0, greatest / 100);
    const auto expect_body = [&](std::int32_t solver_index, const PlainBody& body) {
        if (!body.written) return;
        const auto at = static_cast<std::size_t>(solver_index);
        const PlainBody got(made.constraints.bodies[at], true);
        EXPECT_LE((got.velocity - body.velocity).norm(), tolerance);
        if (made.turns) {
            EXPECT_LE((got.spin - body.spin).norm(), 10 * tolerance);
        } else {
            EXPECT_EQ(got.spin, PlainBody(before[at], true).spin);
        }
    };
    expect_body(made.block().a[lane], wanted.a);
    expect_body(made.block().b[lane], wanted.b);
    Contact<Real> stored = made.contacts[lane];
    store_impulses(made.view(), given::kPlace, static_cast<int>(lane), stored);
    double got_total = 0, wanted_total = 0;
    for (std::size_t k = 0; k < wanted.points.size(); ++k) {
        got_total += double{stored.points[k].impulse};
        wanted_total += wanted.points[k].impulse;
        // What cannot turn does not care which of its points bears what.
        if (!made.turns) continue;
        EXPECT_NEAR(double{stored.points[k].impulse}, wanted.points[k].impulse, tolerance);
    }
    EXPECT_NEAR(got_total, wanted_total, 4 * tolerance);
    const Vec3 friction = stored.friction.template cast<double>();
    EXPECT_LE((friction - wanted.friction_impulse).norm(), tolerance);
    EXPECT_NEAR(double{stored.torsional_impulse}, wanted.torsional_impulse, tolerance);
    const Vec3 rolling = stored.rolling.template cast<double>();
    EXPECT_LE((rolling - wanted.rolling_impulse).norm(), tolerance);
    if (made.constraints.restitutions.empty()) return;
    EXPECT_LE((impact_on(made, lane) - wanted.impact_impulse).norm(),
              tolerance * std::max(1.0, wanted.impact_impulse.norm()));
}

template <class Real>
void check_against_textbook(double tolerance, BlockWish wish, unsigned seeds = 600)
{
    const SolveKernels<Real>& kernels = *solve_kernels_of<Real>("scalar");
    for (unsigned seed = 0; seed < seeds; ++seed) {
        std::mt19937 random(seed);
        wish.lanes = 1 + static_cast<int>(seed % 16);
        wish.points = 1 + static_cast<int>(seed / 16 % 4);
        wish.restitutions = random() % 4 != 0;
        wish.rolls = random() % 2 == 0;
        BlockCase<Real> made = random_block<Real>(random, wish);
        const SolverIteration<Real> iteration = random_iteration<Real>(random, wish);
        const PlainIteration plain = plain_iteration_of(made, iteration);
        std::vector<PlainContact> wanted;
        for (std::size_t lane = 0; lane < made.contacts.size(); ++lane) {
            wanted.push_back(plain_contact(made, lane));
            run_all(wanted.back(), plain, wish.restitutions);
        }
        const std::vector<SolverBody<Real>> before = made.constraints.bodies;
        run_all(kernels, made, iteration);
        for (std::size_t lane = 0; lane < made.contacts.size(); ++lane) {
            expect_lane(made, before, lane, wanted[lane], tolerance);
            if (::testing::Test::HasFailure())
                FAIL() << "seed " << seed << " lane " << lane << " of "
                       << wanted[lane].points.size() << " points in a block of "
                       << made.block().points;
        }
    }
}

TEST(SolveContacts, AgreesWithTheTextbook)
{
    check_against_textbook<double>(1e-12, {});
    check_against_textbook<float>(5e-4, {});
}

TEST(SolveContacts, AgreesWithTheTextbookWhereNothingTurns)
{
    check_against_textbook<double>(1e-12, {.turns = false});
    check_against_textbook<float>(5e-4, {.turns = false});
}

TEST(SolveContacts, AgreesWithTheTextbookWhereSomeBodiesTurnWithoutBeingMoved)
{
    // Little resists such a body where it has next to no lever arm: less is left of the digits.
    check_against_textbook<double>(1e-9, {.pivots = true});
}

TEST(SolveContacts, AgreesWithTheTextbookOfFrictionAtPointsAndWithinAPyramid)
{
    check_against_textbook<double>(1e-12, {.friction_at_points = true});
    check_against_textbook<double>(1e-12, {.pyramid = true});
    check_against_textbook<double>(1e-12, {.friction_at_points = true, .pyramid = true});
    check_against_textbook<float>(5e-4, {.friction_at_points = true});
    check_against_textbook<float>(5e-4, {.pyramid = true});
}

TEST(SolveContacts, AgreesWithTheTextbookFromRestWithoutImpulses)
{
    check_against_textbook<double>(1e-12, {.impulses = false, .round = false, .uneven = false});
}

struct Momentum {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

// Of all bodies that have mass, about the origin.
template <class Real>
Momentum momentum_of(const BlockCase<Real>& made)
{
    Momentum sum;
    for (std::size_t i = 0; i < made.constraints.bodies.size(); ++i) {
        const PlainBody body(made.constraints.bodies[i], false);
        if (body.inverse_mass <= 0) continue;
        const Vec3 linear = body.velocity / body.inverse_mass;
        sum.linear += linear;
        sum.angular += made.positions[i].cross(linear) + body.inverse_inertia.inverse() * body.spin;
    }
    return sum;
}

template <class Real>
void check_momentum(double tolerance)
{
    for (unsigned seed = 0; seed < 300; ++seed) {
        std::mt19937 random(seed);
        const BlockWish wish{.still = false, .one_place = true};
        BlockCase<Real> made = random_block<Real>(random, wish);
        const SolverIteration<Real> iteration = random_iteration<Real>(random, wish);
        const Momentum before = momentum_of(made);
        run_all(*solve_kernels_of<Real>("scalar"), made, iteration);
        const Momentum after = momentum_of(made);
        ASSERT_LE((after.linear - before.linear).norm(), tolerance) << "seed " << seed;
        ASSERT_LE((after.angular - before.angular).norm(), tolerance) << "seed " << seed;
    }
}

TEST(SolveContacts, KeepsLinearAndAngularMomentum)
{
    check_momentum<float>(1e-3);
    check_momentum<double>(1e-12);
}

// J, of all bodies that have mass, with the kinetic energy that they had without contacts.
template <class Real>
double energy_of(const BlockCase<Real>& made)
{
    double sum = 0;
    for (const SolverBody<Real>& solver : made.constraints.bodies) {
        const PlainBody body(solver, false);
        if (body.inverse_mass <= 0) continue;
        sum += body.velocity.squaredNorm() / body.inverse_mass / 2
            + body.spin.dot(body.inverse_inertia.inverse() * body.spin) / 2;
    }
    return sum;
}

// Whatever the points, their lever arms and gaps: no impact gains, and one without loss loses none.
template <class Real>
void check_energy_of_impacts(double tolerance)
{
    int bounced = 0;
    for (unsigned seed = 0; seed < 1000; ++seed) {
        std::mt19937 random(seed);
        const bool apart = seed % 3 == 0;
        const BlockWish wish{.friction_at_points = apart && seed % 2 == 0, .pyramid = apart};
        BlockCase<Real> made = given::packed_block<Real>(random, wish);
        // What moves by itself gives energy.
        for (int k = 0; k < 8; ++k) made.constraints.bodies[given::kKinematic].motion[k] = 0;
        const bool elastic = seed % 4 != 0;
        for (ContactParameters<Real>& terms : made.terms) {
            if (!elastic) continue;
            terms.restitution = 1;
            terms.friction = terms.rolling_friction = 0;
        }
        made.prepare(solve_kernels<Real>());
        SolverIteration<Real> iteration = random_iteration<Real>(random, wish);
        for (Real& number : iteration.gravity_step) number = 0;
        const double before = energy_of(made);
        bounced += made.apply_restitution(solve_kernels<Real>(), iteration) ? 1 : 0;
        const double after = energy_of(made);
        ASSERT_LE(after, before * (1 + tolerance)) << "seed " << seed;
        if (elastic) {
            ASSERT_NEAR(after, before, before * tolerance) << "seed " << seed;
        }
    }
    EXPECT_GT(bounced, 900);
}

TEST(SolveContacts, ImpactsGainNoEnergyAndElasticOnesLoseNone)
{
    check_energy_of_impacts<float>(2e-6);
    check_energy_of_impacts<double>(1e-13);
}

// The loads by which friction goes are those in the middle of an iteration, which the textbook
// tells.
template <class Real>
void check_limits(double slack)
{
    for (unsigned seed = 0; seed < 500; ++seed) {
        std::mt19937 random(seed);
        const BlockWish wish{.points = 1 + static_cast<int>(seed % 4),
                             .turns = seed % 5 != 0,
                             .rolls = seed % 3 != 0};
        BlockCase<Real> made = random_block<Real>(random, wish);
        SolverIteration<Real> iteration = random_iteration<Real>(random, wish);
        iteration.has_friction = true;
        std::vector<PlainContact> plain;
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            plain.push_back(plain_contact(made, lane));
            plain.back().solve(plain_iteration_of(made, iteration));
        }
        made.solve(solve_kernels<Real>(), iteration);
        const ContactConstraintWide<Real>& block = made.block();
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            for (int k = 0; k < block.points; ++k)
                ASSERT_GE(made.point(k).impulse.at[lane], 0) << "seed " << seed;
            const auto friction = double{block.friction.at[lane]};
            const double load = plain[lane].held_by, lever_arm = plain[lane].held_at;
            const double f = std::hypot(double{block.friction_impulse[0].at[lane]},
                                        double{block.friction_impulse[1].at[lane]});
            ASSERT_LE(f, friction * load + slack * (1 + load)) << "seed " << seed;
            if (block.points > 1 && wish.turns) {
                ASSERT_LE(std::abs(double{block.torsional_impulse.at[lane]}),
                          friction * lever_arm + slack * (1 + load));
            }
            if (!wish.rolls || !wish.turns) continue;
            const RollingFrictionWide<Real>& wide =
                made.constraints.rolling_frictions[given::kPlace];
            const Vec3T<Real> rolling(wide.impulse[0].at[lane], wide.impulse[1].at[lane],
                                      wide.impulse[2].at[lane]);
            ASSERT_LE(double{rolling.norm()},
                      double{wide.rolling.at[lane]} * load + slack * (1 + load));
        }
    }
}

TEST(SolveContacts, ContactsNeverPullAndFrictionStaysInItsCone)
{
    check_limits<float>(1e-5);
    check_limits<double>(1e-13);
}

template <class Real>
void check_untouched()
{
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        const BlockWish wish{.lanes = static_cast<int>(seed % kBlock), .turns = seed % 3 != 0};
        BlockCase<Real> made = given::packed_block<Real>(random, wish);
        const BlockCase<Real> before = made;
        made.prepare(solve_kernels<Real>());
        run_all(solve_kernels<Real>(), made, random_iteration<Real>(random, wish));
        std::vector<bool> written(made.constraints.bodies.size(), false);
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            if (made.writes_a(lane)) written[static_cast<std::size_t>(made.block().a[lane])] = true;
            if (made.writes_b(lane)) written[static_cast<std::size_t>(made.block().b[lane])] = true;
        }
        ASSERT_FALSE(written[0]);
        ASSERT_FALSE(written[given::kKinematic]);
        for (std::size_t i = 0; i < made.constraints.bodies.size(); ++i)
            ASSERT_TRUE(written[i]
                        || same_bytes(made.constraints.bodies[i], before.constraints.bodies[i]))
                << "seed " << seed << " body " << i;
        for (auto lane = static_cast<std::size_t>(wish.lanes); lane < kBlock; ++lane) {
            for (int k = 0; k < made.block().points; ++k)
                ASSERT_EQ(made.point(k).impulse.at[lane], 0);
            ASSERT_EQ(made.block().friction_impulse[0].at[lane], 0);
            ASSERT_EQ(made.block().torsional_impulse.at[lane], 0);
        }
        // Neither the blocks before and after it nor their points.
        const auto end = given::kFirstPoint + static_cast<unsigned>(made.block().points);
        for (std::size_t k = 0; k < made.constraints.points.size(); ++k) {
            if (k >= given::kFirstPoint && k < end) continue;
            ASSERT_TRUE(same_bytes(made.constraints.points[k], before.constraints.points[k]));
        }
        for (const std::size_t place : {given::kPlace - 1, given::kPlace + 1}) {
            ASSERT_TRUE(
                same_bytes(made.constraints.blocks[place], before.constraints.blocks[place]));
            ASSERT_TRUE(same_bytes(made.constraints.rolling_frictions[place],
                                   before.constraints.rolling_frictions[place]));
            ASSERT_TRUE(same_bytes(made.constraints.restitutions[place],
                                   before.constraints.restitutions[place]));
        }
    }
}

TEST(SolveContacts, WritesNoBodyThatStandsStillOrMovesByItselfOrBelongsToNoLane)
{
    check_untouched<float>();
    check_untouched<double>();
}

}  // namespace
}  // namespace throng
