// Sweep: the visits of the solver against the textbook, and what no visit may do.
#include "kernels/solver/sweep.hpp"

#include "tests/kernels/solver/plain_contact.hpp"
#include "tests/kernels/solver/random_contacts.hpp"
#include "tests/kernels/solver/random_visit.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::BlockCase;
using given::BlockWish;
using given::PlainBody;
using given::PlainContact;
using given::PlainVisit;
using given::random_block;
using given::random_visit;
using given::run_all;

template <class Real>
PlainContact plain_contact(const BlockCase<Real>& made, std::size_t lane)
{
    const auto body = [&](std::int32_t place) -> const SolverBody<Real>& {
        return made.rows.bodies[static_cast<std::size_t>(place)];
    };
    return {made.contacts[lane], made.terms[lane],
            PlainBody(body(made.block().a[lane]), made.writes_a(lane), made.turns),
            PlainBody(body(made.block().b[lane]), made.writes_b(lane), made.turns)};
}

template <class Real>
PlainVisit plain_visit_of(const BlockCase<Real>& made, const Visit<Real>& visit)
{
    PlainVisit plain{1 / 240.0, 3, visit.push, visit.grips};
    plain.rolls = visit.rolls && made.turns;
    plain.at_points = visit.at_points;
    plain.pyramid = visit.pyramid;
    const bool apart = visit.at_points || visit.pyramid;
    plain.together = made.turns && (made.block().points > 1 || visit.rolls || apart);
    plain.normal_sweeps = visit.normal_sweeps;
    plain.slow = double{visit.slow};
    plain.fall = Vec3(double{visit.fall[0]}, double{visit.fall[1]}, double{visit.fall[2]});
    plain.bounces = !made.rows.bounces.empty();
    return plain;
}

// What run_all does.
void run_all(PlainContact& contact, PlainVisit visit, bool bounces)
{
    if (bounces) contact.bounce(visit);
    contact.warm_start(visit);
    contact.sweep(visit);
    visit.push = !visit.push;
    contact.sweep(visit);
}

// N s, of the impact of a lane.
template <class Real>
Vec3 impact_on(const BlockCase<Real>& made, std::size_t lane)
{
    const auto vec = [&](const Lane16<Real>(&from)[3]) {
        return Vec3(double{from[0].at[lane]}, double{from[1].at[lane]}, double{from[2].at[lane]});
    };
    const Vec3 normal = vec(made.block().normal), tangent = vec(made.block().tangent);
    const Vec3 given = vec(made.rows.bounces[given::kPlace].impulse);
    return normal * given[0] + tangent * given[1] + normal.cross(tangent) * given[2];
}

// A lane of the block after the visits, as the textbook has it.
template <class Real>
void expect_lane(BlockCase<Real>& made,
                 const std::vector<SolverBody<Real>>& before,
                 std::size_t lane,
                 const PlainContact& wanted,
                 double tolerance)
{
    // Impulses that are huge, as those on next to no lever are, have that much greater a last
    // digit.
    double greatest = 0;
    for (const PlainContact::Point& point : wanted.points)
        greatest = std::max(greatest, point.impulse);
    greatest = std::max(greatest, wanted.impact_impulse.norm());
    tolerance *= std::max(1.0, greatest / 100);
    const auto expect_body = [&](std::int32_t slot, const PlainBody& body) {
        if (!body.written) return;
        const auto at = static_cast<std::size_t>(slot);
        const PlainBody got(made.rows.bodies[at], true);
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
    EXPECT_NEAR(double{stored.twist}, wanted.twist_impulse, tolerance);
    const Vec3 rolling = stored.rolling.template cast<double>();
    EXPECT_LE((rolling - wanted.rolling_impulse).norm(), tolerance);
    if (made.rows.bounces.empty()) return;
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
        wish.bounces = random() % 4 != 0;
        wish.rolls = random() % 2 == 0;
        BlockCase<Real> made = random_block<Real>(random, wish);
        const Visit<Real> visit = random_visit<Real>(random, wish);
        const PlainVisit plain = plain_visit_of(made, visit);
        std::vector<PlainContact> wanted;
        for (std::size_t lane = 0; lane < made.contacts.size(); ++lane) {
            wanted.push_back(plain_contact(made, lane));
            run_all(wanted.back(), plain, wish.bounces);
        }
        const std::vector<SolverBody<Real>> before = made.rows.bodies;
        run_all(kernels, made, visit);
        for (std::size_t lane = 0; lane < made.contacts.size(); ++lane) {
            expect_lane(made, before, lane, wanted[lane], tolerance);
            if (::testing::Test::HasFailure())
                FAIL() << "seed " << seed << " lane " << lane << " of "
                       << wanted[lane].points.size() << " points in a block of "
                       << made.block().points;
        }
    }
}

TEST(Sweep, AgreesWithTheTextbook)
{
    check_against_textbook<double>(1e-12, {});
    check_against_textbook<float>(5e-4, {});
}

TEST(Sweep, AgreesWithTheTextbookWhereNothingTurns)
{
    check_against_textbook<double>(1e-12, {.turns = false});
    check_against_textbook<float>(5e-4, {.turns = false});
}

TEST(Sweep, AgreesWithTheTextbookWhereSomeBodiesTurnWithoutBeingMoved)
{
    // Little resists such a body where it has next to no lever: less is left of the digits.
    check_against_textbook<double>(1e-9, {.pivots = true});
}

TEST(Sweep, AgreesWithTheTextbookOfFrictionAtPointsAndWithinAPyramid)
{
    check_against_textbook<double>(1e-12, {.at_points = true});
    check_against_textbook<double>(1e-12, {.pyramid = true});
    check_against_textbook<double>(1e-12, {.at_points = true, .pyramid = true});
    check_against_textbook<float>(5e-4, {.at_points = true});
    check_against_textbook<float>(5e-4, {.pyramid = true});
}

TEST(Sweep, AgreesWithTheTextbookFromRestWithoutImpulses)
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
    for (std::size_t i = 0; i < made.rows.bodies.size(); ++i) {
        const PlainBody body(made.rows.bodies[i], false);
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
        const BlockWish wish{.still = false, .meeting = true};
        BlockCase<Real> made = random_block<Real>(random, wish);
        const Visit<Real> visit = random_visit<Real>(random, wish);
        const Momentum before = momentum_of(made);
        run_all(*solve_kernels_of<Real>("scalar"), made, visit);
        const Momentum after = momentum_of(made);
        ASSERT_LE((after.linear - before.linear).norm(), tolerance) << "seed " << seed;
        ASSERT_LE((after.angular - before.angular).norm(), tolerance) << "seed " << seed;
    }
}

TEST(Sweep, KeepsLinearAndAngularMomentum)
{
    check_momentum<float>(1e-3);
    check_momentum<double>(1e-12);
}

// J, of all bodies that have mass, with the kinetic energy that they had without contacts.
template <class Real>
double energy_of(const BlockCase<Real>& made)
{
    double sum = 0;
    for (const SolverBody<Real>& solver : made.rows.bodies) {
        const PlainBody body(solver, false);
        if (body.inverse_mass <= 0) continue;
        sum += body.velocity.squaredNorm() / body.inverse_mass / 2
            + body.spin.dot(body.inverse_inertia.inverse() * body.spin) / 2;
    }
    return sum;
}

// Whatever the points, their levers and gaps: no impact gains, and one without loss loses none.
template <class Real>
void check_energy_of_impacts(double tolerance)
{
    int bounced = 0;
    for (unsigned seed = 0; seed < 1000; ++seed) {
        std::mt19937 random(seed);
        const bool apart = seed % 3 == 0;
        const BlockWish wish{.at_points = apart && seed % 2 == 0, .pyramid = apart};
        BlockCase<Real> made = given::loose_block<Real>(random, wish);
        // What moves by itself gives energy.
        for (int k = 0; k < 8; ++k) made.rows.bodies[given::kKinematic].motion[k] = 0;
        const bool elastic = seed % 4 != 0;
        for (ContactTerms<Real>& terms : made.terms) {
            if (!elastic) continue;
            terms.restitution = 1;
            terms.friction = terms.rolling_friction = 0;
        }
        made.prepare(solve_kernels<Real>());
        Visit<Real> visit = random_visit<Real>(random, wish);
        for (Real& number : visit.fall) number = 0;
        const double before = energy_of(made);
        bounced += made.bounce(solve_kernels<Real>(), visit) ? 1 : 0;
        const double after = energy_of(made);
        ASSERT_LE(after, before * (1 + tolerance)) << "seed " << seed;
        if (elastic) {
            ASSERT_NEAR(after, before, before * tolerance) << "seed " << seed;
        }
    }
    EXPECT_GT(bounced, 900);
}

TEST(Sweep, ImpactsGainNoEnergyAndElasticOnesLoseNone)
{
    check_energy_of_impacts<float>(2e-6);
    check_energy_of_impacts<double>(1e-13);
}

// The loads by which friction goes are those in the middle of a visit, which the textbook tells.
template <class Real>
void check_limits(double slack)
{
    for (unsigned seed = 0; seed < 500; ++seed) {
        std::mt19937 random(seed);
        const BlockWish wish{.points = 1 + static_cast<int>(seed % 4),
                             .turns = seed % 5 != 0,
                             .rolls = seed % 3 != 0};
        BlockCase<Real> made = random_block<Real>(random, wish);
        Visit<Real> visit = random_visit<Real>(random, wish);
        visit.grips = true;
        std::vector<PlainContact> plain;
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            plain.push_back(plain_contact(made, lane));
            plain.back().sweep(plain_visit_of(made, visit));
        }
        made.sweep(solve_kernels<Real>(), visit);
        const ContactBlock<Real>& block = made.block();
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            for (int k = 0; k < block.points; ++k)
                ASSERT_GE(made.point(k).impulse.at[lane], 0) << "seed " << seed;
            const double friction = double{block.friction.at[lane]};
            const double load = plain[lane].held_by, lever = plain[lane].held_at;
            const double f = std::hypot(double{block.friction_impulse[0].at[lane]},
                                        double{block.friction_impulse[1].at[lane]});
            ASSERT_LE(f, friction * load + slack * (1 + load)) << "seed " << seed;
            if (block.points > 1 && wish.turns) {
                ASSERT_LE(std::abs(double{block.twist_impulse.at[lane]}),
                          friction * lever + slack * (1 + load));
            }
            if (!wish.rolls || !wish.turns) continue;
            const RollingRows<Real>& rows = made.rows.rollings[given::kPlace];
            const Vec3T<Real> rolling(rows.impulse[0].at[lane], rows.impulse[1].at[lane],
                                      rows.impulse[2].at[lane]);
            ASSERT_LE(double{rolling.norm()},
                      double{rows.rolling.at[lane]} * load + slack * (1 + load));
        }
    }
}

TEST(Sweep, ContactsNeverPullAndFrictionStaysInItsCone)
{
    check_limits<float>(1e-5);
    check_limits<double>(1e-13);
}

template <class T>
bool same_bytes(const T& x, const T& y)
{
    return std::memcmp(&x, &y, sizeof(T)) == 0;
}

template <class Real>
void check_untouched()
{
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        const BlockWish wish{.lanes = static_cast<int>(seed % kBlock), .turns = seed % 3 != 0};
        BlockCase<Real> made = given::loose_block<Real>(random, wish);
        const BlockCase<Real> before = made;
        made.prepare(solve_kernels<Real>());
        run_all(solve_kernels<Real>(), made, random_visit<Real>(random, wish));
        std::vector<bool> written(made.rows.bodies.size(), false);
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            if (made.writes_a(lane)) written[static_cast<std::size_t>(made.block().a[lane])] = true;
            if (made.writes_b(lane)) written[static_cast<std::size_t>(made.block().b[lane])] = true;
        }
        ASSERT_FALSE(written[0]);
        ASSERT_FALSE(written[given::kKinematic]);
        for (std::size_t i = 0; i < made.rows.bodies.size(); ++i)
            ASSERT_TRUE(written[i] || same_bytes(made.rows.bodies[i], before.rows.bodies[i]))
                << "seed " << seed << " body " << i;
        for (auto lane = static_cast<std::size_t>(wish.lanes); lane < kBlock; ++lane) {
            for (int k = 0; k < made.block().points; ++k)
                ASSERT_EQ(made.point(k).impulse.at[lane], 0);
            ASSERT_EQ(made.block().friction_impulse[0].at[lane], 0);
            ASSERT_EQ(made.block().twist_impulse.at[lane], 0);
        }
        // Neither the blocks before and after it nor their points.
        const auto end = given::kFirstPoint + static_cast<unsigned>(made.block().points);
        for (std::size_t k = 0; k < made.rows.points.size(); ++k) {
            if (k >= given::kFirstPoint && k < end) continue;
            ASSERT_TRUE(same_bytes(made.rows.points[k], before.rows.points[k]));
        }
        for (const std::size_t place : {given::kPlace - 1, given::kPlace + 1}) {
            ASSERT_TRUE(same_bytes(made.rows.blocks[place], before.rows.blocks[place]));
            ASSERT_TRUE(same_bytes(made.rows.rollings[place], before.rows.rollings[place]));
            ASSERT_TRUE(same_bytes(made.rows.bounces[place], before.rows.bounces[place]));
        }
    }
}

TEST(Sweep, WritesNoBodyThatStandsStillOrMovesByItselfOrBelongsToNoLane)
{
    check_untouched<float>();
    check_untouched<double>();
}

}  // namespace
}  // namespace throng
