// Clock: what patience and times are taken by.
#pragma once

#include <chrono>

namespace throng {

using WallClock = std::chrono::steady_clock;

/// s
inline double seconds_since(WallClock::time_point begin)
{
    return std::chrono::duration<double>(WallClock::now() - begin).count();
}

/// Takes the time of work. Where this thread alone does it, that is the thread's own time on a
/// processor, which others who keep the machine busy do not add to; with more threads the clock's.
class WorkClock {
public:
    /// threads: that do the work; 0 where it is as many as there are cores.
    explicit WorkClock(int threads);

    /// s since some moment.
    double now() const;
    /// s since what now() was, less what reading it takes.
    double since(double begin) const;

private:
    bool own_;        // time of this thread
    double reading_;  // s
};

/// s of simulated time, for which times are told.
inline constexpr double kFrame = 1.0 / 60;

}  // namespace throng
