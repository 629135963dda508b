// Box lanes: W pairs of boxes side by side, one to a lane, as the three steps of box_kernels.hpp
// share them.
//
// For sources that are compiled once for each instruction set, like lanes.hpp.
#pragma once

#include "kernels/simd/lanes.hpp"
#include "narrowphase/convex/wide/box_kernels.hpp"

namespace throng::THRONG_LANES {

using Floats = Lanes<float>;
using Ints = Wide<std::int32_t, Floats::kWidth>;
using Mask = decltype(Floats() < Floats());
constexpr int kWidth = Floats::kWidth;

// A face leads unless another axis is better by this part of the boxes' least half extents, so that
// the normal of a body at rest does not jump between axes that are as good as one another.
constexpr float kFaceBias = 1e-3f;

inline Floats sign_of(Floats a) { return select(a < Floats(0.f), Floats(-1.f), Floats(1.f)); }
inline Floats least_of(const Floats (&a)[3]) { return min(min(a[0], a[1]), a[2]); }
inline Floats dot(const Floats (&a)[3], const Floats (&b)[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Floats clamp(Floats a, Floats low, Floats high) { return min(max(a, low), high); }

// Where is0 the first, where is1 the second, else the third.
template <class T>
T pick(Mask is0, Mask is1, T first, T second, T third)
{
    return select(is0, first, select(is1, second, third));
}

// The same four bytes, read as the other kind of number.
inline Floats as_floats(Ints a)
{
    Floats result;
    __builtin_memcpy(&result.v, &a.v, sizeof(a.v));
    return result;
}
inline Ints as_ints(Floats a)
{
    Ints result;
    __builtin_memcpy(&result.v, &a.v, sizeof(a.v));
    return result;
}

inline Mask equal(Ints a, Ints b) { return a.v == b.v; }

// Masks of one lane are plain truth values, of more one number each.
template <class M>
M no_of(M mask)
{
    if constexpr (kWidth == 1)
        return !mask;
    else
        return ~mask;
}
template <class M>
M both_of(M a, M b)
{
    if constexpr (kWidth == 1)
        return a && b;
    else
        return a & b;
}
template <class M>
M either_of(M a, M b)
{
    if constexpr (kWidth == 1)
        return a || b;
    else
        return a | b;
}
inline Mask no(Mask mask) { return no_of(mask); }
inline Mask both(Mask a, Mask b) { return both_of(a, b); }
inline Mask either(Mask a, Mask b) { return either_of(a, b); }
inline Mask but_not(Mask mask, Mask other) { return both(mask, no(other)); }

// Bit i is set where lane i of the mask is.
inline unsigned bits(Mask mask)
{
#if THRONG_LANE_BYTES == 64
    return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask));
#elif THRONG_LANE_BYTES == 32
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#else
    return mask ? 1u : 0u;
#endif
}

// The first n lanes.
inline unsigned first_lanes(int n) { return n >= kWidth ? (1u << kWidth) - 1 : (1u << n) - 1; }

// What a and b look like from a: b's center and axes (the columns of turn) in a's frame.
struct BoxLanes {
    Floats half_a[3], half_b[3], center[3], turn[3][3], speculative_margin;

    BoxLanes(const BoxPair* pairs, const std::int32_t* index)
    {
        constexpr int kStride = sizeof(BoxPair) / sizeof(float);
        Floats p[8], s[8];
        gather_8(pairs->place, kStride, index, p);
        gather_8(pairs->size, kStride, index, s);
        for (int i = 0; i < 3; ++i) center[i] = p[i], half_a[i] = s[i], half_b[i] = s[i + 4];
        speculative_margin = p[3];
        const Floats one = 1.f, x = p[4], y = p[5], z = p[6], w = p[7];
        const Floats x2 = x + x, y2 = y + y, z2 = z + z;
        turn[0][0] = one - (y2 * y + z2 * z);
        turn[0][1] = y2 * x - z2 * w;
        turn[0][2] = z2 * x + y2 * w;
        turn[1][0] = y2 * x + z2 * w;
        turn[1][1] = one - (x2 * x + z2 * z);
        turn[1][2] = z2 * y - x2 * w;
        turn[2][0] = z2 * x - y2 * w;
        turn[2][1] = z2 * y + x2 * w;
        turn[2][2] = one - (x2 * x + y2 * y);
    }
    // By how much another axis has to be better than a face.
    Floats bias() const { return Floats(kFaceBias) * (least_of(half_a) + least_of(half_b)); }
};

// The axes of W pairs of a list, and where each lane's pair and manifold are.
struct AxesLanes {
    std::int32_t pair[kWidth];
    Ints face, edge, alike;
    Floats face_separation, edge_separation;
    Floats numbers[8];  // as they are in the list
    unsigned used;      // lanes; the others repeat the last pair

    AxesLanes(const BoxList& list, std::int32_t from)
    {
        std::int32_t index[kWidth];
        for (int i = 0; i < kWidth; ++i) {
            index[i] = from + i < list.count ? from + i : list.count - 1;
            pair[i] = list.at[index[i]].pair;
        }
        used = first_lanes(list.count - from);
        Floats(&n)[8] = numbers;
        gather_8(reinterpret_cast<const float*>(list.at), sizeof(BoxAxes) / sizeof(float), index,
                 n);
        face = as_ints(n[1]), edge = as_ints(n[2]), alike = as_ints(n[3]);
        face_separation = n[4], edge_separation = n[5];
    }
};

// Appends the lanes of `which`; numbers as in BoxAxes.
inline void append(BoxList& list, const Floats (&numbers)[8], unsigned which)
{
    std::int32_t index[kWidth];
    std::int32_t next = list.count;
    for (int i = 0; i < kWidth; ++i) {
        index[i] = next;
        next += static_cast<std::int32_t>(which >> i & 1u);
    }
    scatter_8(numbers, reinterpret_cast<float*>(list.at), sizeof(BoxAxes) / sizeof(float), index,
              which);
    list.count = next;
}

struct PointLanes {
    Floats at[3], separation;
    Ints feature;
};

// Writes the manifolds of the lanes of `which`.
inline void write_manifolds(const Floats (&normal)[3],
                            const PointLanes (&point)[4],
                            Ints count,
                            const std::int32_t* pair,
                            unsigned which,
                            float* manifolds)
{
    Floats n[kManifoldNumbers];
    for (int i = 0; i < 3; ++i) n[i] = normal[i];
    for (int k = 0; k < 4; ++k) {
        for (int i = 0; i < 3; ++i) n[3 + 5 * k + i] = point[k].at[i];
        n[6 + 5 * k] = point[k].separation;
        n[7 + 5 * k] = as_floats(point[k].feature);
    }
    n[23] = as_floats(count);
    for (int part = 0; part < 3; ++part) {
        Floats eight[8];
        for (int i = 0; i < 8; ++i) eight[i] = n[8 * part + i];
        scatter_8(eight, manifolds + 8 * part, kManifoldNumbers, pair, which);
    }
}

}  // namespace throng::THRONG_LANES
