#include "kernels/parallel/wavefront.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

namespace throng {

namespace {

// More threads than this would only wait for one another.
constexpr std::size_t kMostThreads = 64;

}  // namespace

void Wavefront::wait_for(std::size_t place, std::size_t passes)
{
    constexpr int kSpins = 200;  // some microseconds: a neighbour is seldom far behind
    const std::atomic_ref<std::uint32_t> done(progress_[place].passes);
    for (int spins = 0; done.load(std::memory_order_acquire) < passes; ++spins)
        if (spins > kSpins) std::this_thread::yield();
}

void Wavefront::run_diagonals(std::size_t passes, std::size_t places, const BlockBody& body)
{
    if (passes == 0 || places == 0) return;
    progress_.assign(places, Progress{});
    std::atomic<std::size_t> next{0};
    // Diagonals are taken in order, so whoever waits does so for one that somebody is at work on.
    const auto take_diagonals = [&](std::size_t, std::size_t, std::size_t) {
        while (true) {
            const std::size_t diagonal = next.fetch_add(1, std::memory_order_relaxed);
            if (diagonal >= passes + places - 1) return;
            const std::size_t first = diagonal < places ? 0 : diagonal - (places - 1);
            for (std::size_t pass = first; pass < passes && pass <= diagonal; ++pass) {
                const std::size_t place = diagonal - pass;
                if (place > 0) wait_for(place - 1, pass + 1);
                if (place + 1 < places) wait_for(place + 1, pass);
                body(pass, place, 0);
                std::atomic_ref<std::uint32_t>(progress_[place].passes)
                    .store(static_cast<std::uint32_t>(pass + 1), std::memory_order_release);
            }
        }
    };
    for_each_block(std::min({kMostThreads, passes, (places + 1) / 2}), 1, take_diagonals);
}

}  // namespace throng
