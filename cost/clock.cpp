#include "cost/clock.hpp"

#include <algorithm>
#include <limits>
#include <time.h>

namespace throng {

namespace {

double seconds_by(clockid_t clock)
{
    timespec now = {};
    ::clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A thread's own time is the system's to tell, which is long beside a step of one body.
double reading_of(clockid_t clock)
{
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 64; ++k) {
        const double begin = seconds_by(clock);
        least = std::min(least, seconds_by(clock) - begin);
    }
    return least;
}

}  // namespace

WorkClock::WorkClock(int threads) : own_(threads == 1), reading_(0)
{
    static const double of_own = reading_of(CLOCK_THREAD_CPUTIME_ID);
    if (own_) reading_ = of_own;
}

double WorkClock::now() const
{
    return seconds_by(own_ ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC);
}

double WorkClock::since(double begin) const { return std::max(0.0, now() - begin - reading_); }

}  // namespace throng
