// Thread limit: what a pool asks of the whole program.
#include "kernels/parallel/blocks.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace throng {
namespace {

TEST(ThreadPool, ASmallOneLeavesTheHostAllItsThreads)
{
    const auto allowed = [] {
        return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    };
    const std::size_t before = allowed();
    const ThreadPool pool(1);
    EXPECT_EQ(allowed(), before);
}

}  // namespace
}  // namespace throng
