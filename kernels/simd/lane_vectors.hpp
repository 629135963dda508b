// Lane vectors: W vectors side by side, and one where L is a plain number. For sources compiled
// once a width.
#pragma once

#include "kernels/simd/lanes.hpp"

namespace throng::THRONG_LANES {

template <class L>
struct V3 {
    L x, y, z;
};
template <class L>
V3<L> operator+(const V3<L>& a, const V3<L>& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class L>
V3<L> operator-(const V3<L>& a, const V3<L>& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class L>
V3<L> operator-(const V3<L>& a)
{
    return {-a.x, -a.y, -a.z};
}
template <class L>
V3<L> operator*(const V3<L>& a, L s)
{
    return {a.x * s, a.y * s, a.z * s};
}
/// a s + c.
template <class L>
V3<L> mul_add(const V3<L>& a, L s, const V3<L>& c)
{
    return {mul_add(a.x, s, c.x), mul_add(a.y, s, c.y), mul_add(a.z, s, c.z)};
}
/// Of numbers that are no vectors elsewhere: made into some, they would be copied through memory.
template <class L>
L dot(L ax, L ay, L az, L bx, L by, L bz)
{
    return mul_add(az, bz, mul_add(ay, by, ax * bx));
}
template <class L>
L dot(const V3<L>& a, const V3<L>& b)
{
    return dot(a.x, a.y, a.z, b.x, b.y, b.z);
}
// Each product rounded: that of parallel vectors of few digits is nothing, and what is alike along
// two axes stays so.
template <class L>
V3<L> cross(const V3<L>& a, const V3<L>& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// The shortest turn that takes one unit vector to another. Of two that are all but opposite it is
/// none.
template <class L>
struct ShortestTurn {
    V3<L> axis;  // from x to
    L share;     // 1 / (1 + from . to)

    ShortestTurn(const V3<L>& from, const V3<L>& to)
        : axis(cross(from, to)),
          share(L(Number(1)) / max(L(Number(1)) + dot(from, to), L(Number(1e-6))))
    { }
    V3<L> operator*(const V3<L>& v) const
    {
        const V3<L> across = cross(axis, v);
        return mul_add(cross(axis, across), share, v + across);
    }

private:
    using Number = typename L::Number;
};
/// Turned by the unit quaternion (axis, w).
template <class L>
V3<L> turned(const V3<L>& axis, L w, const V3<L>& v)
{
    const V3<L> t = cross(axis, v);
    const V3<L> twice = t + t;
    return mul_add(twice, w, v) + cross(axis, twice);
}

}  // namespace throng::THRONG_LANES
