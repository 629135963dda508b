// Contact packing: what a contact's pushes do, against brute force; what carries over, how contacts
// give way.
#include "tests/kernels/solver/random_contacts.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace throng {
namespace {

using given::random_block;
using given::random_number;
using given::random_vector;

// The change of relative velocity at two arms when a unit impulse acts there along a direction:
// done to two bodies, not computed.
Vec3 answer_to(const Vec3& impulse,
               const Vec3& arm_a,
               const Vec3& arm_b,
               const SolverBody<double>& a,
               const SolverBody<double>& b)
{
    const auto change = [](const SolverBody<double>& body, const Vec3& p, const Vec3& arm) {
        const Sym3 inverse{body.inertia[1], body.inertia[2], body.inertia[3],
                           body.inertia[4], body.inertia[5], body.inertia[6]};
        const Vec3 spin = inverse.matrix() * arm.cross(p);
        return Vec3(body.inertia[0] * p + spin.cross(arm));
    };
    return change(b, impulse, arm_b) - change(a, -impulse, arm_a);
}

// The six numbers of a contact, whatever they are of: along normal, tangent and other tangent, then
// about tangent, other tangent and normal.
using Six = Eigen::Matrix<double, 6, 1>;

struct Axes {
    Vec3 normal, tangent, other;

    Axes(const given::BlockCase<double>& made, std::size_t lane)
    {
        const auto get = [lane](const Lane16<double>(&of)[3]) {
            return Vec3(of[0].at[lane], of[1].at[lane], of[2].at[lane]);
        };
        normal = get(made.block().normal);
        tangent = get(made.block().tangent);
        other = normal.cross(tangent);
    }
    Six of(const Vec3& along, const Vec3& about) const
    {
        Six six;
        six << normal.dot(along), tangent.dot(along), other.dot(along), tangent.dot(about),
            other.dot(about), normal.dot(about);
        return six;
    }
};

// A block of contacts, with the centers of one lane's points.
struct Lane {
    given::BlockCase<double>& made;
    std::size_t lane;
    const Contact<double>& contact;
    const SolverBody<double>&a, &b;
    Vec3 center_a = Vec3::Zero(), center_b = Vec3::Zero();

    Lane(given::BlockCase<double>& in, std::size_t at)
        : made(in), lane(at), contact(in.contacts[at]), a(in.body_a(at)), b(in.body_b(at))
    {
        for (int k = 0; k < contact.count; ++k) {
            const double share = given::share_of_center(contact, k);
            center_a += contact.points[static_cast<std::size_t>(k)].anchor_a * share;
            center_b += contact.anchor_b(k) * share;
        }
    }
};

void for_lanes(unsigned seeds, const given::BlockWish& wish, const std::function<void(Lane)>& see)
{
    for (unsigned seed = 0; seed < seeds; ++seed) {
        std::mt19937 random(seed);
        auto made = random_block<double>(random, wish);
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            see(Lane(made, lane));
            if (::testing::Test::HasFailure()) FAIL() << "seed " << seed << " lane " << lane;
        }
    }
}

TEST(ContactPacking, EffectiveMassesAreThoseOfBruteForce)
{
    for_lanes(100, {}, [](const Lane& at) {
        for (int k = 0; k < at.contact.count; ++k) {
            const Vec3 normal = at.contact.normal;
            const double answer = normal.dot(
                answer_to(normal, at.contact.points[static_cast<std::size_t>(k)].anchor_a,
                          at.contact.anchor_b(k), at.a, at.b));
            EXPECT_NEAR(at.made.point(k).mass.at[at.lane] * answer, 1, 1e-12);
        }
        // A point that only others of the block have.
        for (int k = at.contact.count; k < at.made.block().points; ++k) {
            EXPECT_EQ(at.made.point(k).mass.at[at.lane], 0);
            EXPECT_EQ(at.made.point(k).impulse.at[at.lane], 0);
            EXPECT_EQ(at.made.point(k).center_distance.at[at.lane], 0);
        }
    });
}

TEST(ContactPacking, CentersAndLeverArmsSayWhereThePointsAre)
{
    for_lanes(100, {}, [](const Lane& at) {
        const ContactConstraintWide<double>& block = at.made.block();
        const Axes axes(at.made, at.lane);
        EXPECT_NEAR(axes.tangent.dot(at.contact.normal), 0, 1e-15);
        EXPECT_NEAR(axes.tangent.norm(), 1, 1e-15);
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(block.center_a[i].at[at.lane], at.center_a[i], 1e-14);
            EXPECT_NEAR(block.center_b[i].at[at.lane], at.center_b[i], 1e-14);
        }
        std::mt19937 random(7);
        for (int k = 0; k < at.contact.count; ++k) {
            const ContactPointWide<double>& point = at.made.point(k);
            const auto& from = at.contact.points[static_cast<std::size_t>(k)];
            EXPECT_EQ(point.separation.at[at.lane], from.separation);
            // The velocity of any spin at the point, from that at the center.
            const Vec3 spin = random_vector(random, 1), off = from.anchor_a - at.center_a;
            const Six six = axes.of(Vec3::Zero(), spin);
            const double wanted = axes.normal.dot(spin.cross(off));
            EXPECT_NEAR(point.lever_arm[0].at[at.lane] * six[3]
                            + point.lever_arm[1].at[at.lane] * six[4],
                        wanted, 1e-14);
            EXPECT_NEAR(point.center_distance.at[at.lane], axes.normal.cross(off).norm(), 1e-14);
        }
    });
}

TEST(ContactPacking, FrictionStopsAnySlipAndSlidingNeverOvershoots)
{
    std::mt19937 random(1);
    for_lanes(100, {}, [&](const Lane& at) {
        const ContactConstraintWide<double>& block = at.made.block();
        const Axes axes(at.made, at.lane);
        const Vec3 t = axes.tangent, u = axes.other;
        const double m11 = block.friction_mass[0].at[at.lane],
                     m22 = block.friction_mass[1].at[at.lane],
                     m12 = block.friction_mass[2].at[at.lane];
        const double x = random_number(random, -1, 1), y = random_number(random, -1, 1);
        const Vec3 impulse = t * (m11 * x + m12 * y) + u * (m12 * x + m22 * y);
        const Vec3 got = answer_to(impulse, at.center_a, at.center_b, at.a, at.b);
        EXPECT_NEAR(got.dot(t), x, 1e-11);
        EXPECT_NEAR(got.dot(u), y, 1e-11);
        double greatest = 0;
        for (int i = 0; i < 360; ++i) {
            const Vec3 along = std::cos(i * 0.0174532925) * t + std::sin(i * 0.0174532925) * u;
            greatest = std::max(greatest,
                                along.dot(answer_to(along, at.center_a, at.center_b, at.a, at.b)));
        }
        EXPECT_NEAR(block.sliding_mass.at[at.lane] * greatest, 1, 1e-3);
        EXPECT_NEAR(block.sliding_mass.at[at.lane] * block.sliding_inverse_mass.at[at.lane], 1,
                    1e-12);
    });
}

// What a push along or about each of the six axes does to the six, done to two bodies.
Eigen::Matrix<double, 6, 6> response_of(const Lane& at)
{
    const Axes axes(at.made, at.lane);
    const Vec3 directions[6] = {axes.normal,  axes.tangent, axes.other,
                                axes.tangent, axes.other,   axes.normal};
    Eigen::Matrix<double, 6, 6> wanted;
    for (int push = 0; push < 6; ++push) {
        const Vec3 impulse = push < 3 ? directions[push] : Vec3(Vec3::Zero());
        const Vec3 angular_impulse = push < 3 ? Vec3(Vec3::Zero()) : directions[push];
        Vec3 v[2], w[2];  // of a, of b
        for (const int side : {0, 1}) {
            const SolverBody<double>& body = side == 0 ? at.a : at.b;
            const Vec3 arm = side == 0 ? at.center_a : at.center_b;
            const double sign = side == 0 ? -1 : 1;
            const Sym3 inverse{body.inertia[1], body.inertia[2], body.inertia[3],
                               body.inertia[4], body.inertia[5], body.inertia[6]};
            w[side] = sign * (inverse.matrix() * (arm.cross(impulse) + angular_impulse));
            v[side] = sign * body.inertia[0] * impulse + w[side].cross(arm);
        }
        wanted.col(push) = axes.of(v[1] - v[0], w[1] - w[0]);
    }
    return wanted;
}

TEST(ContactPacking, ResponsesAreThoseOfBruteForce)
{
    // Which of the six pushes and is pushed by each place of ContactConstraintWide::inverse_mass.
    constexpr int kPlaces[21][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}, {3, 0},
                                    {3, 1}, {3, 2}, {4, 0}, {4, 1}, {4, 2}, {5, 0}, {5, 1},
                                    {5, 2}, {3, 3}, {4, 4}, {5, 5}, {3, 4}, {3, 5}, {4, 5}};
    for (const bool pivots : {false, true})
        for_lanes(100, {.pivots = pivots}, [&](const Lane& at) {
            const auto wanted = response_of(at);
            EXPECT_LE((wanted - wanted.transpose()).norm(), 1e-13 * wanted.norm());
            for (int i = 0; i < 21; ++i)
                EXPECT_NEAR(at.made.block().inverse_mass[i].at[at.lane],
                            wanted(kPlaces[i][0], kPlaces[i][1]), 1e-14 * wanted.norm())
                    << i;
        });
}

TEST(ContactPacking, WithoutRotationOnlyMassesAnswer)
{
    for_lanes(50, {.turns = false}, [](const Lane& at) {
        const ContactConstraintWide<double>& block = at.made.block();
        const double mass = at.a.inertia[0] + at.b.inertia[0];
        const double wanted[6] = {mass, 0, 0, mass, 0, mass};
        for (int i = 0; i < 6; ++i) EXPECT_EQ(block.inverse_mass[i].at[at.lane], wanted[i]);
        for (int k = 0; k < at.contact.count; ++k)
            EXPECT_EQ(at.made.point(k).mass.at[at.lane], 1 / mass);
    });
}

TEST(ContactPacking, AContactKnowsItsRestitutionAndHasNotBounced)
{
    for_lanes(50, {}, [&](const Lane& at) {
        const RestitutionWide<double>& bounce = at.made.constraints.restitutions[given::kPlace];
        EXPECT_EQ(bounce.restitution.at[at.lane], at.made.terms[at.lane].restitution);
        for (const Lane16<double>& number : bounce.impulse) EXPECT_EQ(number.at[at.lane], 0);
    });
}

TEST(ContactPacking, ALaneOfNothingHasNoMassAndHoldsNothing)
{
    std::mt19937 random(1);
    const auto made = random_block<float>(random, {.lanes = 3, .points = 4});
    const ContactConstraintWide<float>& block = made.block();
    for (std::size_t lane = 3; lane < kBlock; ++lane) {
        for (int k = 0; k < block.points; ++k) {
            EXPECT_EQ(made.point(k).mass.at[lane], 0);
            EXPECT_EQ(made.point(k).impulse.at[lane], 0);
        }
        for (const auto& mass : block.friction_mass) EXPECT_EQ(mass.at[lane], 0);
        EXPECT_EQ(block.sliding_mass.at[lane], 0);
        EXPECT_EQ(block.torsional_mass.at[lane], 0);
        EXPECT_EQ(block.torsional_impulse.at[lane], 0);
        EXPECT_EQ(block.friction_impulse[1].at[lane], 0);
        EXPECT_EQ(made.constraints.rolling_frictions[given::kPlace].mass.at[lane], 0);
        EXPECT_EQ(made.constraints.rolling_frictions[given::kPlace].impulse[1].at[lane], 0);
        for (const auto& inverse_mass : block.inverse_mass) EXPECT_EQ(inverse_mass.at[lane], 0);
    }
}

// The friction that a contact came with, cut to the cone of its normal impulses.
Vec3 within_cone(const given::BlockCase<double>& made, int lane)
{
    const Contact<double>& contact = made.contacts[static_cast<std::size_t>(lane)];
    double load = 0;
    for (int k = 0; k < contact.count; ++k)
        load += contact.points[static_cast<std::size_t>(k)].impulse;
    const double most = made.terms[static_cast<std::size_t>(lane)].friction * load;
    const double length = contact.friction.norm();
    return length > most ? Vec3(contact.friction * (most / length)) : contact.friction;
}

TEST(ContactPacking, FrictionThatWasHeldIsCutToTheCone)
{
    int cut = 0;
    for_lanes(20, {}, [&](const Lane& at) {
        const Vec3 wanted = within_cone(at.made, static_cast<int>(at.lane));
        const Axes axes(at.made, at.lane);
        const double f1 = at.made.block().friction_impulse[0].at[at.lane],
                     f2 = at.made.block().friction_impulse[1].at[at.lane];
        EXPECT_LE((axes.tangent * f1 + axes.other * f2 - wanted).norm(), 1e-15);
        cut += wanted.norm() < 0.99 * at.contact.friction.norm() ? 1 : 0;
    });
    EXPECT_GT(cut, 50);
    EXPECT_LT(cut, 20 * kBlock - 50);
}

// Down to nothing, and at every size: a contact that nothing presses fades from step to step.
TEST(ContactPacking, FrictionOfAnyGreatnessStaysANumber)
{
    for (int power = -46; power <= 36; ++power)
        for (const float share : {0.0f, 0.3f, 3.0f}) {
            std::mt19937 random(1);
            auto made = given::packed_block<float>(random, {.lanes = 1, .points = 1});
            const auto size = static_cast<float>(std::pow(10.0, power));
            made.contacts[0].points[0].impulse = size;
            made.contacts[0].normal = Vec3T<float>::UnitZ();
            made.contacts[0].friction = Vec3T<float>(share * size, 0, 0);
            made.terms[0].friction = 1;
            made.prepare(solve_kernels<float>());
            const float f1 = made.block().friction_impulse[0].at[0],
                        f2 = made.block().friction_impulse[1].at[0];
            ASSERT_TRUE(std::isfinite(f1) && std::isfinite(f2)) << power;
            ASSERT_LE(std::hypot(double{f1}, double{f2}), double{size} * 1.000001) << power;
            if (power >= -36) {
                ASSERT_NEAR(std::hypot(double{f1}, double{f2}) / double{size},
                            std::min(double{share}, 1.0), 1e-6)
                    << power;
            }
        }
}

TEST(ContactPacking, ImpulsesComeBackAsTheyWentIn)
{
    for (const bool turns : {true, false}) {
        std::mt19937 random(2);
        auto made = random_block<double>(random, {.turns = turns});
        for (int lane = 0; lane < kBlock; ++lane) {
            const auto& before = made.contacts[static_cast<std::size_t>(lane)];
            Contact<double> after = before;
            after.friction.setZero();
            after.rolling.setZero();
            after.torsional_impulse = 0;
            for (auto& point : after.points) point.impulse = -1;
            store_impulses(made.view(), given::kPlace, lane, after);
            for (std::size_t k = 0; k < static_cast<std::size_t>(before.count); ++k)
                EXPECT_EQ(after.points[k].impulse, before.points[k].impulse);
            EXPECT_LE((after.friction - within_cone(made, lane)).norm(), 1e-15);
            EXPECT_LE((after.rolling - before.rolling).norm(), 1e-15);
            EXPECT_EQ(after.torsional_impulse, before.torsional_impulse);
        }
    }
}

TEST(ContactPacking, WhereNothingResistsRollingItsImpulseStays)
{
    std::mt19937 random(3);
    auto made = random_block<double>(random, {.rolls = false});
    Contact<double> contact = made.contacts[0];
    store_impulses(made.view(), given::kPlace, 0, contact);
    EXPECT_EQ(contact.rolling, made.contacts[0].rolling);
}

TEST(Contact, AnchorsAreTheSamePointOnEitherSurface)
{
    std::mt19937 random(4);
    for (int i = 0; i < 100; ++i) {
        const Vec3 a = random_vector(random, 1), b = random_vector(random, 1);
        const auto contact = given::random_contact<double>(random, a, b, {});
        for (int k = 0; k < contact.count; ++k) {
            const auto& point = contact.points[static_cast<std::size_t>(k)];
            const Vec3 apart = (b + contact.anchor_b(k)) - (a + point.anchor_a);
            EXPECT_LE((apart - contact.normal * point.separation).norm(), 1e-14);
        }
    }
}

TEST(Softness, IsADampedSpringIntegratedImplicitly)
{
    // One mass on a spring and a damper, by implicit Euler on paper: v' = (v - h w^2 x) / (1 + 2 z
    // h w
    // + h^2 w^2). The solver's form: v' = v - (1 - leak) (v + bias x) - leak * impulse, impulse 0.
    for (const double rate : {5.0, 30.0, 100.0})
        for (const double damping : {0.5, 1.0, 10.0})
            for (const double h : {1 / 60.0, 1 / 240.0}) {
                const auto soft = softness<double>(rate, damping, h);
                const double w = 2 * 3.14159265358979323846 * rate;
                const double x = -0.01, v = -0.3;
                const double wanted =
                    (v - h * w * w * x) / (1 + 2 * damping * h * w + h * h * w * w);
                const double got = v - (1 - soft.impulse_scale) * (v + soft.bias_rate * x);
                EXPECT_NEAR(got, wanted, 1e-13);
                EXPECT_GT(soft.impulse_scale, 0);
                EXPECT_LT(soft.impulse_scale, 1);
            }
}

}  // namespace
}  // namespace throng
