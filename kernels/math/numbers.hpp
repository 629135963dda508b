// Numbers: vectors, quaternions and matrices in rows of plain numbers.
#pragma once

#include "throng/math.hpp"

namespace throng {

template <class Real>
Vec3 vector_at(const Real* numbers)
{
    return {double{numbers[0]}, double{numbers[1]}, double{numbers[2]}};
}

/// xx, yy, zz, xy, xz, yz.
template <class Real>
Sym3 tensor_at(const Real* numbers)
{
    return {double{numbers[0]}, double{numbers[1]}, double{numbers[2]},
            double{numbers[3]}, double{numbers[4]}, double{numbers[5]}};
}

/// Anything of Eigen's as the numbers that it is of, in the order in which it holds them.
template <class Numbers>
void put(const Eigen::DenseBase<Numbers>& from, double* to)
{
    const typename Numbers::PlainObject plain = from.derived();
    for (Eigen::Index i = 0; i < plain.size(); ++i) to[i] = plain.data()[i];
}

}  // namespace throng
