// Hull lanes: a polytope's furthest vertex, for the hull kernels.
#pragma once

#include "kernels/simd/lane_vectors.hpp"
#include "narrowphase/convex/wide/hull_kernels.hpp"

namespace throng::THRONG_LANES {

using L = Lanes<float>;

using F3 = V3<float>;

inline void store(const F3& v, float* to)
{
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}
inline float most(float a, float b) { return a > b ? a : b; }
inline float least(float a, float b) { return a < b ? a : b; }

inline F3 vertex_of(const WidePolytope& shape, int i)
{
    return {shape.x()[i], shape.y()[i], shape.z()[i]};
}
inline F3 normal_of(const WidePolytope& shape, int i)
{
    return {shape.nx()[i], shape.ny()[i], shape.nz()[i]};
}
inline F3 along_of(const WideEdge& edge) { return {edge.along[0], edge.along[1], edge.along[2]}; }

/// The least of all lanes; +0 for either zero.
template <int W>
float least_of(Wide<float, W> lanes)
{
    if constexpr (W == 1) {
        return lanes.v + 0.0F;
    } else if constexpr (W == 4) {
        const auto four = lanes.v, turned = __builtin_shufflevector(four, four, 2, 3, 0, 1);
        const auto two = min(lanes, Wide<float, 4>(turned)).v;
        return least(two[0], two[1]) + 0.0F;
    } else if constexpr (W == 8) {
        const auto v = lanes.v;
        const Wide<float, 4> lower(__builtin_shufflevector(v, v, 0, 1, 2, 3));
        const Wide<float, 4> upper(__builtin_shufflevector(v, v, 4, 5, 6, 7));
        return least_of(min(lower, upper));
    } else {
        const auto v = lanes.v;
        const Wide<float, 8> lower(__builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7));
        const Wide<float, 8> upper(__builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15));
        return least_of(min(lower, upper));
    }
}

/// The lanes that are set, as bits.
template <class Mask>
unsigned bits_of(Mask mask)
{
#if THRONG_LANE_BYTES == 64
    using V __attribute__((vector_size(64))) = int;
    return static_cast<std::uint16_t>(__builtin_ia32_cvtd2mask512(reinterpret_cast<V>(mask)));
#elif THRONG_LANE_BYTES == 32
    using V __attribute__((vector_size(32))) = float;
    return static_cast<unsigned>(__builtin_ia32_movmskps256(reinterpret_cast<V>(mask)));
#else
    return mask ? 1u : 0u;
#endif
}

/// How far the vertices from i on reach along a direction.
inline L extent_at(const WidePolytope& shape, F3 direction, int i)
{
    return L(direction.x) * L::load(shape.x() + i) + L(direction.y) * L::load(shape.y() + i)
        + L(direction.z) * L::load(shape.z() + i);
}

/// The least direction . vertex.
inline float lowest(const WidePolytope& shape, F3 direction)
{
    L low = extent_at(shape, direction, 0);
    for (int i = L::kWidth; i < shape.vertices; i += L::kWidth)
        low = min(low, extent_at(shape, direction, i));
    return least_of(low);
}

/// The first vertex with the least direction . vertex.
inline int lowest_vertex(const WidePolytope& shape, F3 direction)
{
    const float low = lowest(shape, direction);
    for (int i = 0; i < shape.vertices; i += L::kWidth) {
        const unsigned there = bits_of(!(extent_at(shape, direction, i) > L(low)));
        if (there != 0) return i + __builtin_ctz(there);
    }
    return 0;
}

/// The pair as one of the two sees it: `self` is at rest.
///
///   turn    other's axes into self's, by rows
///   center  other's center, from self's
struct Side {
    const WidePolytope& self;
    const WidePolytope& other;
    float turn[9];
    F3 center;

    F3 from_other(F3 v) const
    {
        return {turn[0] * v.x + turn[1] * v.y + turn[2] * v.z,
                turn[3] * v.x + turn[4] * v.y + turn[5] * v.z,
                turn[6] * v.x + turn[7] * v.y + turn[8] * v.z};
    }
    F3 to_other(F3 v) const
    {
        return {turn[0] * v.x + turn[3] * v.y + turn[6] * v.z,
                turn[1] * v.x + turn[4] * v.y + turn[7] * v.z,
                turn[2] * v.x + turn[5] * v.y + turn[8] * v.z};
    }
};

/// A plane through the side of a face, outward.
struct Wall {
    F3 out;
    float offset;

    float beyond(F3 point) const { return dot(out, point) - offset; }
};
inline Wall wall_of(const WidePolytope& shape, int face, int side)
{
    const int at = shape.face_begin()[face] + side;
    const WideEdge& edge = shape.edges[shape.sides()[at]];
    const F3 along = along_of(edge);
    const F3 out = cross(edge.left == face ? along : -along, normal_of(shape, face));
    return {out, dot(out, vertex_of(shape, shape.corners()[at]))};
}

/// The separation of the deepest point, or 0 where there is none: the other's face under one of
/// self's, that of `index`, what is over it within `slack` of its sides, out to
/// `speculative_margin`. In self's frame, and appended; the face is named in the features.
float clip_under(
    const Side& side, int index, float speculative_margin, float slack, HullOverlap& out);

}  // namespace throng::THRONG_LANES
