// Wavefront: as if pass by pass and place by place, for whoever touches a place and the next.
#include "kernels/parallel/wavefront.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

// Each pass mixes a place with the next one, so any other order gives other numbers.
void mix(std::vector<std::uint64_t>& places, std::size_t pass, std::size_t place)
{
    const std::uint64_t right = place + 1 < places.size() ? places[place + 1] : 23;
    places[place] = (places[place] * 6364136223846793005u + right) ^ (right + pass);
    if (place + 1 < places.size()) places[place + 1] += places[place] >> 7;
}

TEST(Wavefront, GivesWhatPassAfterPassGives)
{
    ThreadPool one(1), two(2), many(5);
    Wavefront wave;
    for (const std::size_t places : {1, 2, 3, 7, 40})
        for (const std::size_t passes : {1, 2, 5, 60}) {
            std::vector<std::uint64_t> wanted(places, 1);
            for (std::size_t pass = 0; pass < passes; ++pass)
                for (std::size_t place = 0; place < places; ++place) mix(wanted, pass, place);
            for (ThreadPool* pool : {&one, &two, &many}) {
                std::vector<std::uint64_t> got(places, 1);
                pool->run([&](std::size_t, std::size_t, std::size_t) {
                    wave.run(passes, places,
                             [&](std::size_t pass, std::size_t place) { mix(got, pass, place); });
                });
                ASSERT_EQ(got, wanted) << places << " places, " << passes << " passes";
            }
        }
}

TEST(Wavefront, OfNothingDoesNothing)
{
    Wavefront wave;
    const auto fail = [](std::size_t, std::size_t) { FAIL(); };
    wave.run(0, 4, fail);
    wave.run(4, 0, fail);
}

}  // namespace
}  // namespace throng
