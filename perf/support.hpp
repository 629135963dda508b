// Support: what the benchmarks share.
#pragma once

#include <benchmark/benchmark.h>

#include <cstddef>

namespace throng::perf {

/// Lists what a program times. Each *_perf.cpp defines its own; main.cpp calls it.
void register_benchmarks();

/// The time that one of some things took, where an iteration does `count` of them. Printed
/// as 12.3ns.
inline benchmark::Counter time_of_one(std::size_t count)
{
    return benchmark::Counter(static_cast<double>(count),
                              benchmark::Counter::kIsIterationInvariantRate
                                  | benchmark::Counter::kInvert);
}

}  // namespace throng::perf
