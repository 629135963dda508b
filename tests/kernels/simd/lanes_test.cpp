// Lanes: every operation, lane by lane, against plain numbers; gathers and scatters of any width.
#include "kernels/simd/lanes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace throng {
namespace {

using scalar::Wide;

template <class T, int W>
void check_arithmetic()
{
    std::mt19937 random(W);
    std::uniform_real_distribution<T> numbers(-10, 10);
    T a[W], b[W], out[W];
    for (int i = 0; i < W; ++i) {
        a[i] = numbers(random);
        b[i] = i % 3 == 0 ? a[i] : numbers(random);
    }
    const auto x = Wide<T, W>::load(a), y = Wide<T, W>::load(b);
    const auto expect = [&](const Wide<T, W>& wide, auto plain) {
        wide.store(out);
        for (int i = 0; i < W; ++i) EXPECT_EQ(out[i], plain(a[i], b[i])) << W << " lanes, " << i;
    };
    expect(x + y, [](T p, T q) { return p + q; });
    expect(x - y, [](T p, T q) { return p - q; });
    expect(x * y, [](T p, T q) { return p * q; });
    expect(x / y, [](T p, T q) { return p / q; });
    expect(-x, [](T p, T) { return -p; });
    expect(mul_add(x, y, x), [](T p, T q) { return std::fma(p, q, p); });
    expect(neg_mul_add(x, x, y * y), [](T p, T q) { return std::fma(-p, p, q * q); });
    expect(max(x, y), [](T p, T q) { return p > q ? p : q; });
    expect(min(x, y), [](T p, T q) { return p < q ? p : q; });
    expect(sqrt(x * x), [](T p, T) { return std::sqrt(p * p); });
    expect(select(x > y, x, -y), [](T p, T q) { return p > q ? p : -q; });
    expect(select(x < y, x, -y), [](T p, T q) { return p < q ? p : -q; });
    expect(Wide<T, W>(T(3)), [](T, T) { return T(3); });
    for (int i = 0; i < W; ++i) EXPECT_EQ(x.get(i), a[i]);
}

TEST(Lanes, ComputeWhatPlainNumbersDo)
{
    check_arithmetic<float, 1>();
    check_arithmetic<float, 4>();
    check_arithmetic<float, 8>();
    check_arithmetic<float, 16>();
    check_arithmetic<double, 1>();
    check_arithmetic<double, 4>();
    check_arithmetic<double, 8>();
}

TEST(Lanes, MaxTakesTheSecondOfWhatIsNotANumber)
{
    // The solver leans on this: an impulse that is not a number becomes none.
    const auto nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ((max(Wide<float, 1>(nan), Wide<float, 1>(0.0f)).get(0)), 0.0f);
    EXPECT_EQ((max(Wide<float, 8>(nan), Wide<float, 8>(0.0f)).get(5)), 0.0f);
}

template <class T, int W>
void check_gather()
{
    constexpr int kStride = 24, kBodies = 40;
    std::mt19937 random(W);
    std::vector<T> bodies(std::size_t{kStride} * kBodies);
    for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i] = static_cast<T>(i);
    std::int32_t index[W];
    for (int i = 0; i < W; ++i) index[i] = (7 * i + 3) % kBodies;  // all different

    Wide<T, W> rows[8];
    scalar::gather_8(bodies.data() + 8, kStride, index, rows);
    for (int i = 0; i < W; ++i)
        for (int k = 0; k < 8; ++k)
            ASSERT_EQ(rows[k].get(i), static_cast<T>(kStride * index[i] + 8 + k));

    // Back to where they came from, changed, some lanes left out.
    const unsigned writes = 0x5a3du & ((1u << W) - 1);
    for (auto& row : rows) row = row + Wide<T, W>(T(10000));
    const std::vector<T> before = bodies;
    scalar::scatter_8(rows, bodies.data() + 8, kStride, index, writes);
    std::vector<T> wanted = before;
    for (int i = 0; i < W; ++i)
        for (int k = 0; k < 8; ++k)
            if ((writes >> i & 1u) != 0)
                wanted[static_cast<std::size_t>(kStride * index[i] + 8 + k)] += T(10000);
    EXPECT_EQ(bodies, wanted) << W << " lanes";
}

TEST(Lanes, GatherAndScatterEveryNumberOfEveryLane)
{
    check_gather<float, 1>();
    check_gather<float, 4>();
    check_gather<float, 8>();
    check_gather<float, 16>();
    check_gather<double, 1>();
    check_gather<double, 4>();
    check_gather<double, 8>();
}

}  // namespace
}  // namespace throng
