// Sort keys: the same as the standard sort, whatever the keys.
#include "kernels/parallel/sort_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace throng {
namespace {

TEST(SortKeys, MatchesTheStandardSort)
{
    std::mt19937_64 engine(1);
    std::vector<std::uint64_t> scratch;
    for (const std::size_t count : {0u, 1u, 2u, 511u, 512u, 513u, 40000u, 100001u})
        for (const std::uint64_t mask : {~0ull, 0ull, 1ull, 1ull << 63, 0x1ffff0001ffffull,
                                         0xff00000000000000ull, 0xfull << 30}) {
            std::vector<std::uint64_t> keys(count);
            for (std::uint64_t& key : keys) key = (engine() & mask) | (0x5a5a5a5aull & ~mask);
            std::vector<std::uint64_t> wanted = keys;
            std::sort(wanted.begin(), wanted.end());
            sort_keys(keys, scratch);
            ASSERT_EQ(keys, wanted) << count << " keys, mask " << mask;
        }
}

TEST(SortKeys, LeavesSortedKeysAlone)
{
    std::vector<std::uint64_t> keys(5000), scratch;
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = i * i;
    const std::vector<std::uint64_t> wanted = keys;
    sort_keys(keys, scratch);
    EXPECT_EQ(keys, wanted);
}

}  // namespace
}  // namespace throng
