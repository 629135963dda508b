// Principal inertia: the axes about which a body turns by itself, and its moments about them.
#pragma once

#include "throng/math.hpp"

namespace throng {

/// An inertia by its principal axes: the columns of a rotation, and the moments about them.
struct PrincipalInertia {
    Mat3 axes = Mat3::Identity();
    Vec3 moments = Vec3::Zero();

    /// By how much the moments about the other two axes differ, of their sum.
    double asymmetry(int axis) const;
    /// The axis that comes nearest to one of symmetry.
    int axis_of_symmetry() const;
};

/// Of an inertia without products the axes are those that it is given in.
PrincipalInertia principal_inertia(const Sym3& inertia);

}  // namespace throng
