// Lane rows: shuffled or gathered, the same numbers in the same lanes; and back.
#include "kernels/simd/lane_rows.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace throng {
namespace {

using scalar::RowIds;
using scalar::Wide;

template <int W>
struct RowData {
    using L = Wide<double, W>;
    std::vector<double> numbers;  // each says where it is
    RowIds follow_on, scattered;

    RowData()
    {
        for (int i = 0; i < 40 * 6; ++i) numbers.push_back(i);
        for (std::uint32_t i = 0; i < W; ++i) {
            follow_on.at[i] = 3 + i;
            scattered.at[i] = (7 * i + 2) % 40;
        }
        follow_on.run = true;
    }

    template <int K, class Load>
    void expect_loads(int stride, Load load)
    {
        for (const RowIds& ids : {follow_on, scattered}) {
            L out[K];
            load(numbers.data(), ids, out);
            for (int i = 0; i < W; ++i)
                for (int k = 0; k < K; ++k)
                    EXPECT_EQ(out[k].get(i), int(ids.at[i]) * stride + k) << W << ", lane " << i;
        }
    }

    // Stores the negatives; what is not to be written stays.
    template <int K, class Store>
    void expect_stores(Store store)
    {
        for (const RowIds& ids : {follow_on, scattered})
            for (const unsigned writes : {(1u << W) - 1, 0x55u & ((1u << W) - 1)}) {
                std::vector<double> to = numbers;
                L in[K];
                for (int i = 0; i < W; ++i)
                    for (int k = 0; k < K; ++k) in[k].set(i, -double(ids.at[i]) * K - k);
                store(in, to.data(), ids, writes);
                std::vector<double> wanted = numbers;
                for (int i = 0; i < W; ++i)
                    for (int k = 0; k < K && (writes >> i & 1u) != 0; ++k)
                        wanted[ids.at[i] * K + std::size_t(k)] *= -1;
                EXPECT_EQ(to, wanted) << W;
            }
    }
};

template <int W>
void check_rows()
{
    RowData<W> rows;
    using L = Wide<double, W>;
    rows.template expect_loads<3>(
        3, [](const double* from, const RowIds& ids, L(&out)[3]) { load_3(from, ids, out); });
    rows.template expect_loads<4>(
        4, [](const double* from, const RowIds& ids, L(&out)[4]) { load_4(from, ids, out); });
    rows.template expect_loads<3>(
        6, [](const double* from, const RowIds& ids, L(&out)[3]) { load_3_of_6(from, ids, out); });
    rows.template expect_loads<6>(
        6, [](const double* from, const RowIds& ids, L(&out)[6]) { load_6(from, ids, out); });
    rows.template expect_stores<3>([](const L(&in)[3], double* to, const RowIds& ids,
                                      unsigned writes) { store_3(in, to, ids, writes); });
    rows.template expect_stores<4>([](const L(&in)[4], double* to, const RowIds& ids,
                                      unsigned writes) { store_4(in, to, ids, writes); });
}

TEST(LaneRows, AreTheSameHoweverTheyAreLoaded)
{
    check_rows<1>();
    check_rows<4>();
    check_rows<8>();
}

}  // namespace
}  // namespace throng
