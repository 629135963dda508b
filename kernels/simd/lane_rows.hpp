// Lane rows: a few numbers of each of W bodies, turned so that each number has a register.
//
// Where the bodies follow one another in memory, whole registers are loaded and shuffled; a gather
// costs several times as much. Otherwise number by number.
#pragma once

#include "kernels/simd/lanes.hpp"

namespace throng::THRONG_LANES {

/// Which rows: W ids, `run` where they follow one another.
struct RowIds {
    std::uint32_t at[16];
    bool run = false;
};

/// out[k] lane i = k-th number of row ids.at[i], of rows of `stride` numbers.
template <int K, class L>
void load_rows(const typename L::Number* base, int stride, const RowIds& ids, L (&out)[K])
{
    constexpr int W = L::kWidth;
    typename L::Number numbers[K][W];
    for (int i = 0; i < W; ++i)
        for (int k = 0; k < K; ++k) numbers[k][i] = base[std::size_t{ids.at[i]} * stride + k];
    for (int k = 0; k < K; ++k) out[k] = L::load(numbers[k]);
}

/// The reverse, for the lanes whose bit in `writes` is set.
template <int K, class L>
void store_rows(
    const L (&in)[K], typename L::Number* base, int stride, const RowIds& ids, unsigned writes)
{
    constexpr int W = L::kWidth;
    typename L::Number numbers[K][W];
    for (int k = 0; k < K; ++k) in[k].store(numbers[k]);
    for (int i = 0; i < W; ++i)
        if ((writes >> i & 1u) != 0)
            for (int k = 0; k < K; ++k) base[std::size_t{ids.at[i]} * stride + k] = numbers[k][i];
}

#define THRONG_SHUFFLE __builtin_shufflevector

/// Rows of three numbers.
template <class L>
void load_3(const double* base, const RowIds& ids, L (&out)[3])
{
    if constexpr (L::kWidth == 8) {
        if (ids.run) {
            const double* from = base + std::size_t{ids.at[0]} * 3;
            const auto a = L::load(from).v, b = L::load(from + 8).v, c = L::load(from + 16).v;
            const auto x = THRONG_SHUFFLE(a, b, 0, 3, 6, 9, 12, 15, 0, 0);
            const auto y = THRONG_SHUFFLE(a, b, 1, 4, 7, 10, 13, 0, 0, 0);
            const auto z = THRONG_SHUFFLE(a, b, 2, 5, 8, 11, 14, 0, 0, 0);
            out[0] = L(THRONG_SHUFFLE(x, c, 0, 1, 2, 3, 4, 5, 10, 13));
            out[1] = L(THRONG_SHUFFLE(y, c, 0, 1, 2, 3, 4, 8, 11, 14));
            out[2] = L(THRONG_SHUFFLE(z, c, 0, 1, 2, 3, 4, 9, 12, 15));
            return;
        }
    }
    load_rows(base, 3, ids, out);
}

template <class L>
void store_3(const L (&in)[3], double* base, const RowIds& ids, unsigned writes)
{
    if constexpr (L::kWidth == 8) {
        if (ids.run && writes == 0xffu) {
            double* to = base + std::size_t{ids.at[0]} * 3;
            const auto x = in[0].v, y = in[1].v, z = in[2].v;
            const auto a = THRONG_SHUFFLE(x, y, 0, 8, 0, 1, 9, 0, 2, 10);
            const auto b = THRONG_SHUFFLE(x, y, 0, 3, 11, 0, 4, 12, 0, 5);
            const auto c = THRONG_SHUFFLE(x, y, 13, 0, 6, 14, 0, 7, 15, 0);
            L(THRONG_SHUFFLE(a, z, 0, 1, 8, 3, 4, 9, 6, 7)).store(to);
            L(THRONG_SHUFFLE(b, z, 10, 1, 2, 11, 4, 5, 12, 7)).store(to + 8);
            L(THRONG_SHUFFLE(c, z, 0, 13, 2, 3, 14, 5, 6, 15)).store(to + 16);
            return;
        }
    }
    store_rows(in, base, 3, ids, writes);
}

/// Rows of four numbers.
template <class L>
void load_4(const double* base, const RowIds& ids, L (&out)[4])
{
    if constexpr (L::kWidth == 8) {
        if (ids.run) {
            const double* from = base + std::size_t{ids.at[0]} * 4;
            const auto a = L::load(from).v, b = L::load(from + 8).v;
            const auto c = L::load(from + 16).v, d = L::load(from + 24).v;
            const auto xy_lower = THRONG_SHUFFLE(a, b, 0, 4, 8, 12, 1, 5, 9, 13);
            const auto zw_lower = THRONG_SHUFFLE(a, b, 2, 6, 10, 14, 3, 7, 11, 15);
            const auto xy_upper = THRONG_SHUFFLE(c, d, 0, 4, 8, 12, 1, 5, 9, 13);
            const auto zw_upper = THRONG_SHUFFLE(c, d, 2, 6, 10, 14, 3, 7, 11, 15);
            out[0] = L(THRONG_SHUFFLE(xy_lower, xy_upper, 0, 1, 2, 3, 8, 9, 10, 11));
            out[1] = L(THRONG_SHUFFLE(xy_lower, xy_upper, 4, 5, 6, 7, 12, 13, 14, 15));
            out[2] = L(THRONG_SHUFFLE(zw_lower, zw_upper, 0, 1, 2, 3, 8, 9, 10, 11));
            out[3] = L(THRONG_SHUFFLE(zw_lower, zw_upper, 4, 5, 6, 7, 12, 13, 14, 15));
            return;
        }
    }
    load_rows(base, 4, ids, out);
}

template <class L>
void store_4(const L (&in)[4], double* base, const RowIds& ids, unsigned writes)
{
    if constexpr (L::kWidth == 8) {
        if (ids.run && writes == 0xffu) {
            double* to = base + std::size_t{ids.at[0]} * 4;
            const auto x = in[0].v, y = in[1].v, z = in[2].v, w = in[3].v;
            const auto xy_lower = THRONG_SHUFFLE(x, y, 0, 1, 2, 3, 8, 9, 10, 11);
            const auto xy_upper = THRONG_SHUFFLE(x, y, 4, 5, 6, 7, 12, 13, 14, 15);
            const auto zw_lower = THRONG_SHUFFLE(z, w, 0, 1, 2, 3, 8, 9, 10, 11);
            const auto zw_upper = THRONG_SHUFFLE(z, w, 4, 5, 6, 7, 12, 13, 14, 15);
            L(THRONG_SHUFFLE(xy_lower, zw_lower, 0, 4, 8, 12, 1, 5, 9, 13)).store(to);
            L(THRONG_SHUFFLE(xy_lower, zw_lower, 2, 6, 10, 14, 3, 7, 11, 15)).store(to + 8);
            L(THRONG_SHUFFLE(xy_upper, zw_upper, 0, 4, 8, 12, 1, 5, 9, 13)).store(to + 16);
            L(THRONG_SHUFFLE(xy_upper, zw_upper, 2, 6, 10, 14, 3, 7, 11, 15)).store(to + 24);
            return;
        }
    }
    store_rows(in, base, 4, ids, writes);
}

/// The first three numbers of rows of six.
template <class L>
void load_3_of_6(const double* base, const RowIds& ids, L (&out)[3])
{
    if constexpr (L::kWidth == 8) {
        if (ids.run) {
            const double* from = base + std::size_t{ids.at[0]} * 6;
            typename L::V r[6];
            for (int k = 0; k < 6; ++k) r[k] = L::load(from + 8 * k).v;
            const auto xy_lower = THRONG_SHUFFLE(r[0], r[1], 0, 6, 12, 0, 1, 7, 13, 0);
            const auto z_lower = THRONG_SHUFFLE(r[0], r[1], 2, 8, 14, 0, 0, 0, 0, 0);
            const auto xy_upper = THRONG_SHUFFLE(r[3], r[4], 0, 6, 12, 0, 1, 7, 13, 0);
            const auto z_upper = THRONG_SHUFFLE(r[3], r[4], 2, 8, 14, 0, 0, 0, 0, 0);
            const auto last = THRONG_SHUFFLE(r[2], r[5], 2, 3, 4, 10, 11, 12, 0, 0);
            const auto x = THRONG_SHUFFLE(xy_lower, xy_upper, 0, 1, 2, 0, 8, 9, 10, 0);
            const auto y = THRONG_SHUFFLE(xy_lower, xy_upper, 4, 5, 6, 0, 12, 13, 14, 0);
            const auto z = THRONG_SHUFFLE(z_lower, z_upper, 0, 1, 2, 0, 8, 9, 10, 0);
            out[0] = L(THRONG_SHUFFLE(x, last, 0, 1, 2, 8, 4, 5, 6, 11));
            out[1] = L(THRONG_SHUFFLE(y, last, 0, 1, 2, 9, 4, 5, 6, 12));
            out[2] = L(THRONG_SHUFFLE(z, last, 0, 1, 2, 10, 4, 5, 6, 13));
            return;
        }
    }
    load_rows(base, 6, ids, out);
}

/// Rows of six numbers.
template <class L>
void load_6(const double* base, const RowIds& ids, L (&out)[6])
{
    if constexpr (L::kWidth == 8) {
        if (ids.run) {
            const double* from = base + std::size_t{ids.at[0]} * 6;
            typename L::V r[6];
            for (int k = 0; k < 6; ++k) r[k] = L::load(from + 8 * k).v;
            // Rows 0, 1 and 2 of each half lie in its first 18 numbers; row 3 is the rest.
            const auto a = THRONG_SHUFFLE(r[0], r[1], 0, 6, 12, 1, 7, 13, 2, 8);
            const auto b = THRONG_SHUFFLE(r[0], r[1], 3, 9, 15, 4, 10, 5, 11, 14);
            const auto c = THRONG_SHUFFLE(r[3], r[4], 0, 6, 12, 1, 7, 13, 2, 8);
            const auto d = THRONG_SHUFFLE(r[3], r[4], 3, 9, 15, 4, 10, 5, 11, 14);
            // Of both halves: number 4 of row 2, number 5 of row 2, then row 3.
            const auto e = THRONG_SHUFFLE(r[2], r[5], 0, 1, 2, 3, 8, 9, 10, 11);
            const auto f = THRONG_SHUFFLE(r[2], r[5], 4, 5, 6, 7, 12, 13, 14, 15);
            const auto x = THRONG_SHUFFLE(a, c, 0, 1, 2, 0, 8, 9, 10, 0);
            const auto y = THRONG_SHUFFLE(a, c, 3, 4, 5, 0, 11, 12, 13, 0);
            const auto z = THRONG_SHUFFLE(a, c, 6, 7, 0, 0, 14, 15, 0, 0);
            const auto zb = THRONG_SHUFFLE(b, d, 7, 15, 0, 0, 0, 0, 0, 0);
            const auto u = THRONG_SHUFFLE(b, d, 0, 1, 2, 0, 8, 9, 10, 0);
            const auto v = THRONG_SHUFFLE(b, d, 3, 4, 0, 0, 11, 12, 0, 0);
            const auto w = THRONG_SHUFFLE(b, d, 5, 6, 0, 0, 13, 14, 0, 0);
            const auto ze = THRONG_SHUFFLE(z, zb, 0, 1, 8, 0, 4, 5, 9, 0);
            out[0] = L(THRONG_SHUFFLE(x, e, 0, 1, 2, 10, 4, 5, 6, 14));
            out[1] = L(THRONG_SHUFFLE(y, e, 0, 1, 2, 11, 4, 5, 6, 15));
            out[2] = L(THRONG_SHUFFLE(ze, f, 0, 1, 2, 8, 4, 5, 6, 12));
            out[3] = L(THRONG_SHUFFLE(u, f, 0, 1, 2, 9, 4, 5, 6, 13));
            const auto ve = THRONG_SHUFFLE(v, e, 0, 1, 8, 0, 4, 5, 12, 0);
            const auto we = THRONG_SHUFFLE(w, e, 0, 1, 9, 0, 4, 5, 13, 0);
            out[4] = L(THRONG_SHUFFLE(ve, f, 0, 1, 2, 10, 4, 5, 6, 14));
            out[5] = L(THRONG_SHUFFLE(we, f, 0, 1, 2, 11, 4, 5, 6, 15));
            return;
        }
    }
    load_rows(base, 6, ids, out);
}

#undef THRONG_SHUFFLE

}  // namespace throng::THRONG_LANES
