// Main of every benchmark: runs what it lists, and says first what the figures depend on.
#include "kernels/solver/solve_kernels.hpp"
#include "perf/support.hpp"

int main(int argc, char** argv)
{
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::AddCustomContext("widest lanes", throng::solve_kernels<float>().name);
#if defined(THRONG_CHECKS) || !defined(NDEBUG)
    benchmark::AddCustomContext("checks", "on: these figures say nothing about a release");
#endif
    throng::perf::register_benchmarks();
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
