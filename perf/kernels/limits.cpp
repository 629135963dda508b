// Limits: what this machine can do at most, for the kernels to be held against.
//
// Bandwidth by the triad a = b + s c, counted as the three arrays it names (a store that misses
// also reads its line first, which is not counted); arithmetic by chains of a multiplication and an
// addition in registers, unfused, as throng is built.
#include "kernels/parallel/blocks.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace throng::perf {
namespace {

using Clock = std::chrono::steady_clock;

using V8 __attribute__((vector_size(32))) = float;
using V16 __attribute__((vector_size(64))) = float;

#define THRONG_INLINE inline __attribute__((always_inline))

// ------------------------------------------------------------------------------------ arithmetic

// As many chains as hide the latency of both operations on two ports, and fit 16 registers.
constexpr int kChains = 12;

template <class V>
THRONG_INLINE V filled(float number)
{
    float numbers[sizeof(V) / sizeof(float)];  // NOLINT(bugprone-sizeof-expression): V may be float
    std::fill(std::begin(numbers), std::end(numbers), number);
    V made;
    std::memcpy(&made, numbers, sizeof made);
    return made;
}

template <class V>
THRONG_INLINE float chains(std::size_t rounds)
{
    const V factor = filled<V>(0.999f), term = filled<V>(0.001f);
    V sums[kChains];
    for (int i = 0; i < kChains; ++i) sums[i] = filled<V>(static_cast<float>(i));
    for (std::size_t round = 0; round < rounds; ++round)
        for (V& sum : sums) sum = sum * factor + term;
    float all = 0;
    for (const V& sum : sums) {
        float first = 0;
        std::memcpy(&first, &sum, sizeof first);
        all += first;
    }
    return all;
}

// One number at a time: the compiler is kept from putting chains side by side.
__attribute__((optimize("no-tree-vectorize", "no-tree-slp-vectorize"))) float
chains_scalar(std::size_t rounds)
{
    return chains<float>(rounds);
}
__attribute__((target("avx2"))) float chains_avx2(std::size_t rounds) { return chains<V8>(rounds); }
__attribute__((target("avx512f"))) float chains_avx512(std::size_t rounds)
{
    return chains<V16>(rounds);
}

struct Width {
    const char* name;
    float (*chains)(std::size_t);
    int numbers;
    bool here;
};

// Best of a few: others can only make it slower.
template <class Work>
double least_seconds(const Work& work)
{
    double least = 1e30;
    for (int i = 0; i < 7; ++i) {
        const auto begin = Clock::now();
        work();
        least = std::min(least, std::chrono::duration<double>(Clock::now() - begin).count());
    }
    return least;
}

volatile float sink = 0;  // NOLINT: what is written here is not thrown away as unused

double gigaflops(const Width& width, int threads)
{
    constexpr std::size_t kRounds = 4'000'000;
    const double seconds = least_seconds([&] {
        for_each_block(
            static_cast<std::size_t>(threads), 1,
            [&](std::size_t, std::size_t, std::size_t) { sink = width.chains(kRounds); });
    });
    return 2.0 * kChains * width.numbers * static_cast<double>(kRounds) * threads / seconds / 1e9;
}

// ------------------------------------------------------------------------------------- bandwidth

template <class V>
THRONG_INLINE void triad(float* a, const float* b, const float* c, std::size_t count)
{
    constexpr std::size_t kNumbers = sizeof(V) / sizeof(float);
    auto* to = reinterpret_cast<V*>(a);
    const auto *from = reinterpret_cast<const V*>(b), *other = reinterpret_cast<const V*>(c);
    for (std::size_t i = 0; i < count / kNumbers; ++i) to[i] = from[i] + 0.5f * other[i];
}

using Triad = void (*)(float*, const float*, const float*, std::size_t);
__attribute__((target("avx2"))) void
triad_avx2(float* a, const float* b, const float* c, std::size_t n)
{
    triad<V8>(a, b, c, n);
}
__attribute__((target("avx512f"))) void
triad_avx512(float* a, const float* b, const float* c, std::size_t n)
{
    triad<V16>(a, b, c, n);
}
void triad_scalar(float* a, const float* b, const float* c, std::size_t n)
{
    for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + 0.5f * c[i];
}

Triad widest_triad()
{
    if (__builtin_cpu_supports("avx512f")) return triad_avx512;
    return __builtin_cpu_supports("avx2") ? triad_avx2 : triad_scalar;
}

struct Free {
    void operator()(float* memory) const { std::free(memory); }
};
using Array = std::unique_ptr<float, Free>;

Array make_array(std::size_t count)
{
    Array made(static_cast<float*>(std::aligned_alloc(4096, count * sizeof(float))));
    std::fill_n(made.get(), count, 1.0f);
    return made;
}

// bytes: of the three arrays together, for each thread.
double gigabytes_a_second(std::size_t bytes, int threads)
{
    const std::size_t count = bytes / (3 * sizeof(float)) / 1024 * 1024;
    const std::size_t rounds = std::max<std::size_t>(1, (std::size_t{1} << 30) / bytes);
    const Triad run = widest_triad();
    std::vector<Array> arrays(static_cast<std::size_t>(3 * threads));
    for (Array& array : arrays) array = make_array(count);
    const double seconds = least_seconds([&] {
        for_each_block(static_cast<std::size_t>(threads), 1,
                       [&](std::size_t, std::size_t, std::size_t thread) {
                           float* const a = arrays[3 * thread].get();
                           for (std::size_t i = 0; i < rounds; ++i) {
                               run(a, arrays[3 * thread + 1].get(), arrays[3 * thread + 2].get(),
                                   count);
                               sink = a[i % count];
                           }
                       });
    });
    return static_cast<double>(3 * sizeof(float) * count * rounds) * threads / seconds / 1e9;
}

void print(const std::string& what, int threads, double figure, const char* unit)
{
    std::printf("%-34s  threads:%d  %8.1f %s\n", what.c_str(), threads, figure, unit);
    std::fflush(stdout);
}

void run()
{
    const Width widths[] = {
        {"scalar", chains_scalar, 1, true},
        {"avx2", chains_avx2, 8, __builtin_cpu_supports("avx2") != 0},
        {"avx512", chains_avx512, 16, __builtin_cpu_supports("avx512f") != 0},
    };
    struct Level {
        const char* name;
        std::size_t bytes;
    };
    // Of each thread: well within the second cache, beyond it but within the third, beyond all.
    constexpr Level kLevels[] = {{"triad in L2 (384 KiB)", 384u << 10},
                                 {"triad in L3 (6 MiB)", 6u << 20},
                                 {"triad in memory (384 MiB)", 384u << 20}};
    for (const int threads : {1, 2}) {
        ThreadPool pool(threads);
        pool.run([&](std::size_t, std::size_t, std::size_t) {
            for (const Level& level : kLevels)
                print(level.name, threads, gigabytes_a_second(level.bytes, threads), "GB/s");
            for (const Width& width : widths)
                if (width.here)
                    print(std::string("multiply and add, ") + width.name, threads,
                          gigaflops(width, threads), "Gflop/s");
        });
    }
}

}  // namespace
}  // namespace throng::perf

int main()
{
    throng::perf::run();
    return 0;
}
