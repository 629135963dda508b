#include "perf/narrowphase/turns.hpp"

#include <algorithm>
#include <ctime>

namespace throng::perf {
namespace {

// Of this thread alone, s: what others take of the machine's time is not counted.
double thread_seconds()
{
    timespec now = {};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) / 1e9;
}

volatile double sink = 0;  // NOLINT: what is written here is not thrown away as unused

}  // namespace

void Turn::run(const Effort& effort)
{
    constexpr std::size_t kQuestions = 2 * kSteps - 2;  // to and fro
    constexpr double kLong = 30;
    // What is that slow is known well enough after two turns.
    if (turns >= 2 && best * 1e-9 * static_cast<double>(pairs * kQuestions) > kLong * effort.turn)
        return;
    ++turns;
    if (pairs == 0) {
        const double begin = thread_seconds();
        sink = ask(1, 0);
        sink = ask(1, 1);
        const double took = (thread_seconds() - begin) / 2;
        const double most = effort.turn / (kQuestions * std::max(took, 1e-9));
        pairs = std::clamp(static_cast<std::size_t>(most), std::size_t{1}, effort.pairs);
    }
    double sum = 0;
    const double begin = thread_seconds();
    for (std::size_t i = 0; i < kQuestions; ++i) sum += ask(pairs, i < kSteps ? i : kQuestions - i);
    const double took = thread_seconds() - begin;
    sink = sum;
    const double one = took * 1e9 / static_cast<double>(pairs * kQuestions);
    if (!(best <= one)) best = one;
}

void take_turns(std::vector<Turn>& turns, const Effort& effort)
{
    for (int i = 0; i < effort.turns; ++i)
        for (Turn& turn : turns) turn.run(effort);
}

}  // namespace throng::perf
