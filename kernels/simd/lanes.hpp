// Lanes: one formula, any width.
//
// Wide<T, W> is W numbers that go through the same arithmetic side by side. Every operation is the
// plain IEEE one, lane by lane, so a formula gives the same bits with 1, 4, 8 or 16 lanes: also
// mul_add(), which formulas ask for by name and the compiler never puts in by itself. Built on
// the compiler's vector types: a source that includes this is compiled once for each instruction
// set (see CMakeLists.txt), each time in a namespace of its own, and may include neither Eigen nor
// containers, whose inline functions would be shared between instruction sets.
#pragma once

#include <cstdint>

#ifndef THRONG_LANES
#define THRONG_LANES scalar
#define THRONG_LANE_BYTES 0
#endif

#if THRONG_LANE_BYTES > 0
#include <immintrin.h>
#endif

namespace throng::THRONG_LANES {

// The register that holds W numbers; one number is just itself.
template <class T, int W>
struct Register {
    using Type __attribute__((vector_size(W * sizeof(T)))) = T;
    static Type all(T value) { return value - Type{}; }
};
template <class T>
struct Register<T, 1> {
    using Type = T;
};

template <class T, int W>
struct Wide {
    using V = typename Register<T, W>::Type;
    using Number = T;
    static constexpr int kWidth = W;
    V v;

    Wide() : v{} { }
    Wide(V value) : v(value) { }  // NOLINT(google-explicit-constructor): a number
    /// The same number in every lane.
    Wide(T value)  // NOLINT(google-explicit-constructor): a number
        requires(W > 1)
        : v(Register<T, W>::all(value))
    { }

    static Wide load(const T* from)
    {
        Wide result;
        __builtin_memcpy(&result.v, from, sizeof(V));
        return result;
    }
    void store(T* to) const { __builtin_memcpy(to, &v, sizeof(V)); }

    friend Wide operator+(Wide a, Wide b) { return a.v + b.v; }
    friend Wide operator-(Wide a, Wide b) { return a.v - b.v; }
    friend Wide operator*(Wide a, Wide b) { return a.v * b.v; }
    friend Wide operator/(Wide a, Wide b) { return a.v / b.v; }
    friend Wide operator-(Wide a) { return -a.v; }
    Wide& operator+=(Wide b)
    {
        v += b.v;
        return *this;
    }
    Wide& operator-=(Wide b)
    {
        v -= b.v;
        return *this;
    }
    friend auto operator<(Wide a, Wide b) { return a.v < b.v; }
    friend auto operator>(Wide a, Wide b) { return a.v > b.v; }

    void set(int lane, T value)
    {
        if constexpr (W == 1)
            v = value;
        else
            v[lane] = value;
    }
    T get(int lane) const
    {
        if constexpr (W == 1)
            return v;
        else
            return v[lane];
    }
};

/// yes where the mask is set, no elsewhere.
template <class Mask, class T, int W>
Wide<T, W> select(Mask mask, Wide<T, W> yes, Wide<T, W> no)
{
    return mask ? yes.v : no.v;
}
/// The second where they are equal, as the machine's own instruction has it.
template <class T, int W>
Wide<T, W> max(Wide<T, W> a, Wide<T, W> b)
{
    return a.v > b.v ? a.v : b.v;
}
template <class T, int W>
Wide<T, W> min(Wide<T, W> a, Wide<T, W> b)
{
    return a.v < b.v ? a.v : b.v;
}
template <class T, int W>
Wide<T, W> abs(Wide<T, W> a)
{
    return max(a, -a);
}
inline float root(float x) { return __builtin_sqrtf(x); }
inline double root(double x) { return __builtin_sqrt(x); }
// The compiler would take roots of wide registers one number at a time.
#if THRONG_LANE_BYTES == 64
inline __m512 root(__m512 x) { return _mm512_mask_sqrt_ps(x, 0xffff, x); }
inline __m512d root(__m512d x) { return _mm512_mask_sqrt_pd(x, 0xff, x); }
#elif THRONG_LANE_BYTES == 32
inline __m256 root(__m256 x) { return _mm256_sqrt_ps(x); }
inline __m256d root(__m256d x) { return _mm256_sqrt_pd(x); }
#endif

/// Fused multiply-add: a b + c, rounded once.
inline float mul_add(float a, float b, float c) { return __builtin_fmaf(a, b, c); }
inline double mul_add(double a, double b, double c) { return __builtin_fma(a, b, c); }
/// c - a b, likewise.
inline float neg_mul_add(float a, float b, float c) { return __builtin_fmaf(-a, b, c); }
inline double neg_mul_add(double a, double b, double c) { return __builtin_fma(-a, b, c); }
// The compiler writes a sign that it is told of outside of the instruction as one of its own.
#if THRONG_LANE_BYTES == 64
inline __m512 mul_add(__m512 a, __m512 b, __m512 c) { return _mm512_fmadd_ps(a, b, c); }
inline __m512d mul_add(__m512d a, __m512d b, __m512d c) { return _mm512_fmadd_pd(a, b, c); }
inline __m512 neg_mul_add(__m512 a, __m512 b, __m512 c) { return _mm512_fnmadd_ps(a, b, c); }
inline __m512d neg_mul_add(__m512d a, __m512d b, __m512d c) { return _mm512_fnmadd_pd(a, b, c); }
#elif THRONG_LANE_BYTES == 32
inline __m256 mul_add(__m256 a, __m256 b, __m256 c) { return _mm256_fmadd_ps(a, b, c); }
inline __m256d mul_add(__m256d a, __m256d b, __m256d c) { return _mm256_fmadd_pd(a, b, c); }
inline __m256 neg_mul_add(__m256 a, __m256 b, __m256 c) { return _mm256_fnmadd_ps(a, b, c); }
inline __m256d neg_mul_add(__m256d a, __m256d b, __m256d c) { return _mm256_fnmadd_pd(a, b, c); }
#endif
// An operation that the machine has for whole registers, or number by number where the width is
// not this instruction set's own.
template <class T, int W, class Operation, class... More>
Wide<T, W> by_register(const Operation& operation, Wide<T, W> a, More... more)
{
    if constexpr (W == 1 || W * int(sizeof(T)) == THRONG_LANE_BYTES) {
        return Wide<T, W>(operation(a.v, more.v...));
    } else {
        Wide<T, W> result;
        for (int i = 0; i < W; ++i) result.v[i] = operation(a.v[i], more.v[i]...);
        return result;
    }
}
template <class T, int W>
Wide<T, W> mul_add(Wide<T, W> a, Wide<T, W> b, Wide<T, W> c)
{
    return by_register([](auto x, auto y, auto z) { return mul_add(x, y, z); }, a, b, c);
}
template <class T, int W>
Wide<T, W> neg_mul_add(Wide<T, W> a, Wide<T, W> b, Wide<T, W> c)
{
    return by_register([](auto x, auto y, auto z) { return neg_mul_add(x, y, z); }, a, b, c);
}
template <class T, int W>
Wide<T, W> sqrt(Wide<T, W> a)
{
    return by_register([](auto x) { return root(x); }, a);
}

// Eight numbers of each of W bodies, turned so that each number has a register of its own. Loads
// and shuffles: gather instructions cost a third more (measured on the contact sweep).
namespace detail {

template <class V>
void turn_8x8(V (&r)[8])
{
    V t[8], u[8];
    for (int i = 0; i < 4; ++i) {
        t[2 * i] = __builtin_shufflevector(r[2 * i], r[2 * i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
        t[2 * i + 1] = __builtin_shufflevector(r[2 * i], r[2 * i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
    }
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 2; ++k) {
            V &lower = t[4 * i + k], &upper = t[4 * i + k + 2];
            u[4 * i + 2 * k] = __builtin_shufflevector(lower, upper, 0, 1, 8, 9, 4, 5, 12, 13);
            u[4 * i + 2 * k + 1] =
                __builtin_shufflevector(lower, upper, 2, 3, 10, 11, 6, 7, 14, 15);
        }
    for (int i = 0; i < 4; ++i) {
        r[i] = __builtin_shufflevector(u[i], u[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
        r[i + 4] = __builtin_shufflevector(u[i], u[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

// The same for both halves of 16-wide registers at once.
template <class V>
void turn_two_8x8(V (&r)[8])
{
    V t[8], u[8];
    for (int i = 0; i < 4; ++i) {
        const V a = r[2 * i], b = r[2 * i + 1];
        t[2 * i] =
            __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
        t[2 * i + 1] = __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14,
                                               30, 15, 31);
    }
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 2; ++k) {
            const V a = t[4 * i + k], b = t[4 * i + k + 2];
            u[4 * i + 2 * k] = __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24,
                                                       25, 12, 13, 28, 29);
            u[4 * i + 2 * k + 1] = __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11,
                                                           26, 27, 14, 15, 30, 31);
        }
    for (int i = 0; i < 4; ++i) {
        const V a = u[i], b = u[i + 4];
        r[i] =
            __builtin_shufflevector(a, b, 0, 1, 2, 3, 16, 17, 18, 19, 8, 9, 10, 11, 24, 25, 26, 27);
        r[i + 4] = __builtin_shufflevector(a, b, 4, 5, 6, 7, 20, 21, 22, 23, 12, 13, 14, 15, 28, 29,
                                           30, 31);
    }
}

}  // namespace detail

/// out[k] lane i = k-th number at row(i).
template <class T, int W, class Row>
void gather_8(Row row, Wide<T, W> (&out)[8])
{
    if constexpr (W == 8 || W == 16) {
        using V8 __attribute__((vector_size(8 * sizeof(T)))) = T;
        using V = typename Wide<T, W>::V;
        V rows[8];
        for (int i = 0; i < 8; ++i) {
            V8 lower;
            __builtin_memcpy(&lower, row(i), sizeof(V8));
            if constexpr (W == 16) {
                V8 upper;
                __builtin_memcpy(&upper, row(i + 8), sizeof(V8));
                rows[i] = __builtin_shufflevector(lower, upper, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10,
                                                  11, 12, 13, 14, 15);
            } else {
                rows[i] = lower;
            }
        }
        if constexpr (W == 16)
            detail::turn_two_8x8(rows);
        else
            detail::turn_8x8(rows);
        for (int k = 0; k < 8; ++k) out[k].v = rows[k];
    } else {
        for (int i = 0; i < W; ++i) {
            const T* const from = row(i);
            for (int k = 0; k < 8; ++k) out[k].set(i, from[k]);
        }
    }
}

/// out[k] lane i = k-th number at base + stride * index[i].
template <class T, int W>
void gather_8(const T* base, int stride, const std::int32_t* index, Wide<T, W> (&out)[8])
{
    gather_8<T, W>([=](int i) { return base + std::int64_t{stride} * index[i]; }, out);
}

/// scatter_8, number by number.
template <class T, int W>
void scatter_8_singly(
    const Wide<T, W> (&in)[8], T* base, int stride, const std::int32_t* index, unsigned writes)
{
    for (int i = 0; i < W; ++i)
        if ((writes >> i & 1u) != 0)
            for (int k = 0; k < 8; ++k) base[std::int64_t{stride} * index[i] + k] = in[k].get(i);
}

/// The reverse of gather_8, for the lanes whose bit in `writes` is set.
template <class T, int W>
void scatter_8(
    const Wide<T, W> (&in)[8], T* base, int stride, const std::int32_t* index, unsigned writes)
{
    if constexpr (W == 8 || W == 16) {
        using V8 __attribute__((vector_size(8 * sizeof(T)))) = T;
        using V = typename Wide<T, W>::V;
        V rows[8];
        for (int k = 0; k < 8; ++k) rows[k] = in[k].v;
        if constexpr (W == 16)
            detail::turn_two_8x8(rows);
        else
            detail::turn_8x8(rows);
        for (int i = 0; i < W; ++i) {
            if ((writes >> i & 1u) == 0) continue;
            V8 row;
            if constexpr (W == 16) {
                const V both = rows[i & 7];
                row = i < 8 ? __builtin_shufflevector(both, both, 0, 1, 2, 3, 4, 5, 6, 7)
                            : __builtin_shufflevector(both, both, 8, 9, 10, 11, 12, 13, 14, 15);
            } else {
                row = rows[i];
            }
            __builtin_memcpy(base + std::int64_t{stride} * index[i], &row, sizeof(V8));
        }
    } else {
        scatter_8_singly(in, base, stride, index, writes);
    }
}

/// Towards zero; what int32 can hold.
template <int W>
Wide<std::int32_t, W> truncated(Wide<float, W> a)
{
    if constexpr (W == 1)
        return static_cast<std::int32_t>(a.v);
    else
        return __builtin_convertvector(a.v, typename Wide<std::int32_t, W>::V);
}
/// The float of a whole number.
template <int W>
Wide<float, W> whole(Wide<std::int32_t, W> a)
{
    if constexpr (W == 1)
        return static_cast<float>(a.v);
    else
        return __builtin_convertvector(a.v, typename Wide<float, W>::V);
}

/// Lane i = base[index lane i]. For single numbers here and there: where eight stand together,
/// gather_8() is faster.
template <int W>
Wide<std::int32_t, W> gather(const std::int32_t* base, Wide<std::int32_t, W> index)
{
    Wide<std::int32_t, W> out;
#if THRONG_LANE_BYTES == 64
    if constexpr (W == 16) {
        const auto got =
            _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), 0xffff, (__m512i)index.v, base, 4);
        __builtin_memcpy(&out.v, &got, sizeof got);
        return out;
    }
#elif THRONG_LANE_BYTES == 32
    if constexpr (W == 8) {
        const auto all = _mm256_set1_epi32(-1);
        const auto got =
            _mm256_mask_i32gather_epi32(_mm256_setzero_si256(), base, (__m256i)index.v, all, 4);
        __builtin_memcpy(&out.v, &got, sizeof got);
        return out;
    }
#endif
    for (int i = 0; i < W; ++i) out.set(i, base[index.get(i)]);
    return out;
}

/// low and high lane i = base[index lane i] and the number behind it.
template <int W>
void gather_pair(const float* base,
                 Wide<std::int32_t, W> index,
                 Wide<float, W>& low,
                 Wide<float, W>& high)
{
#if THRONG_LANE_BYTES == 64
    if constexpr (W == 16) {
        // Both numbers of a lane at once: half as many reads.
        const auto none = _mm512_setzero_pd();
        const auto of_first = __builtin_shufflevector(index.v, index.v, 0, 1, 2, 3, 4, 5, 6, 7);
        const auto of_second =
            __builtin_shufflevector(index.v, index.v, 8, 9, 10, 11, 12, 13, 14, 15);
        const auto first = _mm512_mask_i32gather_pd(none, 0xff, (__m256i)of_first, base, 4);
        const auto second = _mm512_mask_i32gather_pd(none, 0xff, (__m256i)of_second, base, 4);
        typename Wide<float, W>::V a, b;
        __builtin_memcpy(&a, &first, sizeof a);
        __builtin_memcpy(&b, &second, sizeof b);
        low.v = __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28,
                                        30);
        high.v = __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27,
                                         29, 31);
        return;
    }
#elif THRONG_LANE_BYTES == 32
    if constexpr (W == 8) {
        const auto none = _mm256_setzero_pd();
        const auto all = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
        const auto* const pairs = reinterpret_cast<const double*>(base);
        const auto of_first = __builtin_shufflevector(index.v, index.v, 0, 1, 2, 3);
        const auto of_second = __builtin_shufflevector(index.v, index.v, 4, 5, 6, 7);
        const auto first = _mm256_mask_i32gather_pd(none, pairs, (__m128i)of_first, all, 4);
        const auto second = _mm256_mask_i32gather_pd(none, pairs, (__m128i)of_second, all, 4);
        typename Wide<float, W>::V a, b;
        __builtin_memcpy(&a, &first, sizeof a);
        __builtin_memcpy(&b, &second, sizeof b);
        low.v = __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
        high.v = __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15);
        return;
    }
#endif
    for (int i = 0; i < W; ++i) {
        low.set(i, base[index.get(i)]);
        high.set(i, base[index.get(i) + 1]);
    }
}

/// As many as fit this instruction set's registers.
template <class T>
using Lanes = Wide<T, THRONG_LANE_BYTES == 0 ? 1 : THRONG_LANE_BYTES / int(sizeof(T))>;

}  // namespace throng::THRONG_LANES
