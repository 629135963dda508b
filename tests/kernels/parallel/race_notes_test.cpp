// Race notes: the race checker still sees a race of blocks.
#include "kernels/parallel/race_notes.hpp"

#include "kernels/parallel/blocks.hpp"
#include "tests/support/planted_races.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

namespace throng {
namespace {

#if defined(__SANITIZE_THREAD__)

// Blocks of two threads at least, each of which changes the same number; nothing orders them.
void race_of_blocks()
{
    std::atomic<int> come{0};
    int shared = 0;
    ThreadPool pool(2);
    pool.run([&](std::size_t, std::size_t, std::size_t) {
        for_each_block(2, 1, [&](std::size_t, std::size_t, std::size_t) {
            given::meet_another(come);
            given::change_often(shared);
        });
    });
    std::exit(0);
}

TEST(RaceChecker, SeesARaceOfBlocks) { given::expect_race(race_of_blocks); }

#else

TEST(RaceNotes, AreNothingInOtherBuildsOfBlocks)
{
    EXPECT_FALSE(kChecksRaces);
    EXPECT_LE(sizeof(TaskNotes), 2u);
}

#endif

}  // namespace
}  // namespace throng
