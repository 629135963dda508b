// Hash: what two fingerprints tell apart.
#include "kernels/math/hash.hpp"

#include <gtest/gtest.h>

#include <set>

namespace throng {
namespace {

template <class... Numbers>
std::uint64_t hash_of(Numbers... numbers)
{
    Hash hash;
    (hash.add(numbers), ...);
    return hash.value();
}

TEST(Hash, IsTheSameForTheSameNumbers)
{
    EXPECT_EQ(hash_of(1.0, 2.0f, std::uint64_t{3}), hash_of(1.0, 2.0f, std::uint64_t{3}));
    EXPECT_EQ(Hash().value(), Hash().value());
}

TEST(Hash, TellsOrdersApart)
{
    EXPECT_NE(hash_of(1.0, 2.0), hash_of(2.0, 1.0));
    EXPECT_NE(hash_of(0.0, 1.0), hash_of(1.0, 0.0));
}

TEST(Hash, TellsLengthsApart)
{
    std::set<std::uint64_t> seen;
    Hash zeros;
    for (int i = 0; i < 1000; ++i) {
        EXPECT_TRUE(seen.insert(zeros.value()).second) << i << " zeros";
        zeros.add(0.0);
    }
}

TEST(Hash, FeelsEveryBit)
{
    std::set<std::uint64_t> seen = {hash_of(std::uint64_t{0}, 5.0)};
    int bits_changed = 0;
    for (int bit = 0; bit < 64; ++bit) {
        const std::uint64_t value = hash_of(std::uint64_t{1} << bit, 5.0);
        EXPECT_TRUE(seen.insert(value).second) << "bit " << bit;
        bits_changed += std::popcount(value ^ hash_of(std::uint64_t{0}, 5.0));
    }
    // Half of them, on average.
    EXPECT_NEAR(bits_changed / 64.0, 32, 3);
}

TEST(Hash, TellsZeroFromMinusZero)
{
    EXPECT_NE(hash_of(0.0), hash_of(-0.0));
    EXPECT_NE(hash_of(0.0f), hash_of(-0.0f));
}

TEST(Hash, IsWrittenAsSixteenDigits)
{
    EXPECT_EQ(Hash().text(), "0000000000000000");
    Hash hash;
    hash.add(1.0);
    ASSERT_EQ(hash.text().size(), 16u);
    EXPECT_EQ(std::stoull(hash.text(), nullptr, 16), hash.value());
}

TEST(Spot, FillsTheCubeEvenly)
{
    Vec3 mean = Vec3::Zero(), square = Vec3::Zero();
    constexpr int kSpots = 10000;
    for (std::uint64_t i = 0; i < kSpots; ++i) {
        const Vec3 spot = spot_of(i);
        ASSERT_LE(spot.cwiseAbs().maxCoeff(), 1);
        mean += spot / kSpots;
        square += spot.cwiseAbs2() / kSpots;
    }
    EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.03);
    EXPECT_LT((square - Vec3::Constant(1.0 / 3)).cwiseAbs().maxCoeff(), 0.02);
}

}  // namespace
}  // namespace throng
