#include "tests/narrowphase/convex/round_pairs.hpp"

namespace throng {
namespace {

using given::collide;
using given::deepest_of;
using given::Placement;
using given::random_direction;
using given::random_turn;

constexpr ShapeRef kCapsuleA = {ShapeKind::capsule, 0}, kCapsuleB = {ShapeKind::capsule, 1};

double uniform(std::mt19937& random, double from, double to)
{
    return std::uniform_real_distribution<double>(from, to)(random);
}

Placement placed(const Capsule& a, const Capsule& b, const Vec3& position, const Quat& turn)
{
    Placement pair;
    pair.a = kCapsuleA;
    pair.b = kCapsuleB;
    pair.shapes.capsules = {a, b};
    pair.b_in_a = {position, turn};
    return pair;
}

Placement random_placement(std::mt19937& random, double scale, double spread)
{
    const auto size = [&] { return scale * std::pow(10.0, uniform(random, -spread, 0)); };
    const Capsule a = {size(), size()}, b = {size(), size()};
    const double furthest = a.radius + a.half_length + b.radius + b.half_length;
    return placed(a, b, random_direction(random) * uniform(random, 0.05, 1.2) * furthest,
                  random_turn(random));
}

void expect_as_searched(const Placement& pair, double exact, double coarse)
{
    given::expect_as_searched(capsule_capsule<double>, capsule_capsule<float>, pair, exact, coarse);
}

// The least distance of two segments by trying places on one against the other, then closer ones.
double least_distance(const Capsule& a, const Capsule& b, const Pose& b_in_a)
{
    const Vec3 along = b_in_a.orientation * Vec3(0, 0, 1);
    const auto at = [&](double t) {
        const Vec3 point(0, 0, t);
        const double on_b =
            std::clamp(along.dot(point - b_in_a.position), -b.half_length, b.half_length);
        return (b_in_a.position + on_b * along - point).norm();
    };
    double low = -a.half_length, high = a.half_length;
    for (int i = 0; i < 200; ++i) {
        const double third = (high - low) / 3;
        if (at(low + third) < at(high - third))
            high -= third;
        else
            low += third;
    }
    return at((low + high) / 2);
}

}  // namespace

TEST(CapsuleCapsule, AgreesWithTheSearchWhateverTheSize)
{
    std::mt19937 random(51);
    for (const double scale : {1e-6, 1.0, 1e6}) {
        for (int i = 0; i < 2000; ++i) {
            SCOPED_TRACE("seed 51, case " + std::to_string(i));
            expect_as_searched(random_placement(random, scale, 1), 1e-9, 4e-6);
            if (HasFailure()) return;
        }
    }
}

TEST(CapsuleCapsule, AgreesWithTheSearchForNeedles)
{
    std::mt19937 random(52);
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE("seed 52, case " + std::to_string(i));
        expect_as_searched(random_placement(random, 1, 1 + i % 6), 1e-8, 4e-6);
        if (HasFailure()) return;
    }
}

TEST(CapsuleCapsule, NearlyParallelAxesAreAsFarApartAsTheyAre)
{
    std::mt19937 random(53);
    for (int i = 0; i < 5000; ++i) {
        SCOPED_TRACE("seed 53, case " + std::to_string(i));
        const Capsule a = {0.1, uniform(random, 0, 1)}, b = {0.2, uniform(random, 0, 2)};
        const double lean = i % 5 ? std::pow(10.0, -uniform(random, 1, 17)) : 0;
        const Quat turn(Eigen::AngleAxisd(lean + (i % 2 ? std::acos(-1.0) : 0),
                                          random_direction(random).cross(Vec3::UnitZ())));
        const Placement pair = placed(a, b, random_direction(random), turn.normalized());
        const double truth = least_distance(a, b, pair.b_in_a) - 0.3;
        EXPECT_NEAR(deepest_of(collide<double>(capsule_capsule<double>, pair, 10)), truth, 1e-9);
        EXPECT_NEAR(deepest_of(collide<float>(capsule_capsule<float>, pair, 10)), truth, 2e-6);
        if (HasFailure()) return;
    }
}

TEST(CapsuleCapsule, SideBySideTouchTwiceUnderNoise)
{
    std::mt19937 random(54);
    for (int i = 0; i < 300; ++i) {
        const Quat turn(Eigen::AngleAxisd(1e-4, random_direction(random)));
        const Vec3 place = Vec3(0.199, 0, 0.1) + 1e-4 * random_direction(random);
        const Placement pair = placed({0.1, 0.4}, {0.1, 0.4}, place, turn);
        const auto found = collide<double>(capsule_capsule<double>, pair, 0.02);
        const auto rounded = collide<float>(capsule_capsule<float>, pair, 0.02);
        ASSERT_EQ(found.count, 2) << "seed 54, case " << i;
        ASSERT_EQ(rounded.count, 2) << "seed 54, case " << i;
        for (std::size_t k = 0; k < 2; ++k) {
            EXPECT_EQ(found.points[k].feature, k);
            EXPECT_EQ(rounded.points[k].feature, k);
            EXPECT_NEAR(found.points[k].position.z(), k == 0 ? -0.3 : 0.4, 1e-3);
        }
    }
}

TEST(CapsuleCapsule, NothingJumpsAsTheyTurn)
{
    std::mt19937 random(55);
    for (int run = 0; run < 50; ++run) {
        const Vec3 axis = random_direction(random).cross(Vec3::UnitZ()).normalized();
        const Vec3 place = Vec3(0.25, 0, uniform(random, -0.5, 0.5));
        Vec3 before = Vec3::Zero();
        for (int i = 0; i < 3000; ++i) {
            const Quat turn(Eigen::AngleAxisd((i - 1500) * 1e-4, axis));
            const auto found = collide<double>(capsule_capsule<double>,
                                               placed({0.1, 0.4}, {0.1, 0.4}, place, turn), 1);
            ASSERT_GT(found.count, 0);
            if (i > 0 && deepest_of(found) > -0.18) {
                EXPECT_LT((found.normal - before).norm(), 20e-4) << "run " << run << ", " << i;
            }
            before = found.normal;
        }
    }
}

TEST(CapsuleCapsule, WildNumbersStayFinite)
{
    std::mt19937 random(56);
    const auto wild = [&] { return std::pow(10.0, uniform(random, -9, 12)); };
    for (int i = 0; i < 5000; ++i) {
        const Capsule a = {i % 5 ? wild() : 0, i % 7 ? wild() : 0}, b = {wild(), wild()};
        const Placement pair = placed(a, b, random_direction(random) * (i % 11 ? wild() : 0),
                                      i % 3 ? random_turn(random) : Quat(1, 0, 0, 0));
        const double speculative_margin = i % 2 ? wild() : 0;
        EXPECT_TRUE(all_finite(collide<double>(capsule_capsule<double>, pair, speculative_margin)))
            << i;
        EXPECT_TRUE(all_finite(collide<float>(capsule_capsule<float>, pair, speculative_margin)))
            << i;
    }
}

}  // namespace throng
