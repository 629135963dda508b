// First crossing: until when a separation that changes with time stays above a level.
//
// The one root finder behind every time of impact, in three forms. None of them ever steps over a
// root: between two times at which a separation is known it is bounded from below, by how sharply
// it may bend, and only what that bound clears is passed.
#pragma once

#include "throng/settings.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

/// How a time of impact is sought.
///
///   level, close  m, an impact is a distance between the two: the shapes are brought no nearer
///   than
///                 `level`, and have met once they are within `close`. 0 < level < close
struct ImpactRule {
    ToiMethod method = ToiMethod::newton;
    double level = 0, close = 0;
};

/// A separation and how fast it changes.
struct SeparationRate {
    double value = 0, slope = 0;  // m, m a unit of time
};

/// What holds for a separation over all of the time looked at.
///
///   bend   its second derivative is at most this wherever there is one, and its slope never jumps
///          upward: so is that of the least of many smooth ones
///   speed  it falls no faster than this
struct SeparationLimits {
    double bend = 0, speed = 0;
};

/// Where a search ended: the value at `time` was known last.
struct Crossing {
    double time = 0;
    bool clear = false;  // up to the end of the time looked at
};

namespace detail {

/// How far past `from` a separation surely stays at or above the level, of which `from` and `to`,
/// so far apart, are known. All of the way where that is so.
///
/// A function whose second derivative is at most `bend` lies no further than bend / 2 (t - t0)
/// (t1 - t) below its chord.
inline double cleared_way(double from, double to, double way, double level, double bend)
{
    const double above = from - level;
    const double tilt = (to - from) / way - bend * way / 2;
    const double under = tilt * tilt - 2 * bend * above;
    if (!(tilt < 0) || under < 0) return way;
    return std::min(way, 2 * above / (std::sqrt(under) - tilt));
}

// At `begin` the separation is known and above the level. Halves what cannot be cleared, doubles
// again.
template <class SeparationAt>
Crossing bisect(SeparationAt separation_at,
                double begin,
                SeparationRate separation,
                double end,
                double level,
                double close,
                double bend)
{
    constexpr int kMostRounds = 4096;
    double way = end - begin;
    for (int round = 0; round < kMostRounds && begin < end; ++round) {
        const double next = way < end - begin ? begin + way : end;
        if (!(next > begin)) return {begin, false};
        const SeparationRate ahead = separation_at(next);
        if (ahead.value >= level
            && cleared_way(separation.value, ahead.value, next - begin, level, bend)
                >= next - begin) {
            begin = next;
            separation = ahead;
            if (separation.value <= close) return {begin, false};
            way *= 2;
        } else {
            way = (next - begin) / 2;
        }
    }
    return {begin, begin >= end};
}

// How far to look: to where the tangent comes down to what is aimed at, or as far as the bend lets
// anything be cleared.
inline double
newton_way(SeparationRate separation, double left, double level, double aim, double bend)
{
    if (separation.slope < 0) left = std::min(left, (separation.value - aim) / -separation.slope);
    if (bend > 0) left = std::min(left, 2 * std::sqrt((separation.value - level) / bend));
    return left;
}

template <class SeparationAt>
Crossing approach(SeparationAt separation_at,
                  double begin,
                  SeparationRate separation,
                  double end,
                  double level,
                  double close,
                  double bend)
{
    constexpr int kMostRounds = 1024;
    const double aim = (level + close) / 2;
    // Where the tangent from beyond the root meets the level: the root is not past that, as far as
    // the separation does not bend upward.
    double most = end;
    for (int round = 0; round < kMostRounds && begin < end; ++round) {
        const double way =
            newton_way(separation, (most > begin ? most : end) - begin, level, aim, bend);
        double next = way < end - begin ? begin + way : end;
        if (!(next > begin)) next = std::min(end, std::nextafter(begin, end));
        const SeparationRate ahead = separation_at(next);
        const double clear = cleared_way(separation.value, ahead.value, next - begin, level, bend);
        most = end;
        if (ahead.value >= level && clear >= next - begin) {
            begin = next;
            separation = ahead;
        } else {
            if (ahead.value < aim && ahead.slope < 0)
                most = next - (aim - ahead.value) / -ahead.slope;
            // The first root lies in between.
            const double back = begin + clear * (1 - 1e-12);
            if (!(back > begin) || !(back < next)) return {begin, false};
            const SeparationRate there = separation_at(back);
            if (!(there.value >= level)) return {begin, false};  // by rounding alone
            begin = back;
            separation = there;
        }
        if (separation.value <= close) return {begin, false};
    }
    return {begin, begin >= end};
}

}  // namespace detail

/// How far past `begin` a separation is sure to stay at or above the rule's level: to a time at
/// which it is no more than `close`, or to the end. `conservative` takes a single step, which is up
/// to its caller to repeat. Every form ends in a bounded number of rounds, and where that is not
/// enough, early.
///
///   separation_at  (time) -> Gap
///   separation     at `begin`; its value is above `close`, which is above `level`
template <class SeparationAt>
Crossing first_crossing(const ImpactRule& rule,
                        SeparationAt separation_at,
                        double begin,
                        SeparationRate separation,
                        double end,
                        const SeparationLimits& limits)
{
    if (!(limits.speed * (end - begin) > separation.value - rule.level)) return {end, true};
    switch (rule.method) {
    case ToiMethod::bisection:
        return detail::bisect(separation_at, begin, separation, end, rule.level, rule.close,
                              limits.bend);
    case ToiMethod::conservative:
        return {std::min(end, begin + (separation.value - rule.level) / limits.speed), false};
    default:
        return detail::approach(separation_at, begin, separation, end, rule.level, rule.close,
                                limits.bend);
    }
}

}  // namespace throng
