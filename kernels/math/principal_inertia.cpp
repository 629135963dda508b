#include "kernels/math/principal_inertia.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace throng {

double PrincipalInertia::asymmetry(int axis) const
{
    const double a = moments[(axis + 1) % 3], b = moments[(axis + 2) % 3];
    return std::abs(a - b) / (a + b);
}

int PrincipalInertia::axis_of_symmetry() const
{
    int best = 0;
    for (int k = 1; k < 3; ++k)
        if (asymmetry(k) < asymmetry(best)) best = k;
    return best;
}

PrincipalInertia principal_inertia(const Sym3& inertia)
{
    PrincipalInertia principal;
    principal.moments = Vec3(inertia.xx, inertia.yy, inertia.zz);
    if (!inertia.has_products()) return principal;
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia.matrix());
    principal.axes = solver.eigenvectors();
    // A left-handed set would turn the wrong way round.
    if (principal.axes.determinant() < 0) principal.axes.col(0) *= -1;
    principal.moments = solver.eigenvalues();
    return principal;
}

}  // namespace throng
