// Contacts: what is kept of a pair, packed and taken over.
#include "kernels/data/contacts.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

TEST(PackedCache, RemembersWhatFitsAndForgetsTheRest)
{
    static_assert(sizeof(PairState) == 8);
    EXPECT_EQ(PairCache(PackedCache()), PairCache());
    for (const std::uint32_t a : {0u, 1u, 77u, 32767u})
        for (const std::uint32_t b : {0u, 5u, 32767u})
            for (const std::uint32_t kind : {0u, 1u, 2u, 3u}) {
                const PairCache cache{a, b, kind};
                EXPECT_EQ(PairCache(PackedCache(cache)), cache) << a << " " << b << " " << kind;
            }
    EXPECT_EQ(PairCache(PackedCache(PairCache{32768, 1, 1})), PairCache());
    EXPECT_EQ(PairCache(PackedCache(PairCache{1, 0xffffffffu, 1})), PairCache());
    EXPECT_EQ(PairCache(PackedCache(PairCache{1, 1, 4})), PairCache());
}

TEST(Contact, TakesOverWhatIsThereAndNoMore)
{
    Contact<float> from, to;
    from.count = 2;
    from.normal = Vec3T<float>(1, 0, 0);
    from.torsional_impulse = 3;
    for (std::size_t k = 0; k < 4; ++k) {
        from.points[k].impulse = 1 + static_cast<float>(k);
        to.points[k].impulse = -1;
    }
    to.take(from);
    EXPECT_EQ(to.count, 2);
    EXPECT_EQ(to.normal, from.normal);
    EXPECT_EQ(to.torsional_impulse, 3);
    EXPECT_EQ(to.points[1].impulse, 2);
    EXPECT_EQ(to.points[2].impulse, -1);
}

}  // namespace
}  // namespace throng
