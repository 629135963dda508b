#include "kernels/data/bodies.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

void expect_same(const PrincipalInertia& a, const PrincipalInertia& b)
{
    EXPECT_EQ(a.axes, b.axes);
    EXPECT_EQ(a.moments, b.moments);
}

// A list that is kept for some is no reason to believe it of others.
TEST(PrincipalInertia, ThatIsKeptIsThatOfEachBodyNow)
{
    const Sym3 even{2, 3, 4, 0, 0, 0}, askew{2, 3, 4, 0.1, -0.2, 0.3};
    Masses masses;
    masses.inertia = {even, askew, even, askew};
    for (std::size_t body = 0; body < 4; ++body)
        expect_same(masses.principal_of(body), principal_inertia(masses.inertia[body]));
    masses.principal.resize(2);
    masses.principal[1] = principal_inertia(askew);
    for (std::size_t body = 0; body < 4; ++body)
        expect_same(masses.principal_of(body), principal_inertia(masses.inertia[body]));
    masses.inertia[1] = even;
    expect_same(masses.principal_of(1), principal_inertia(even));
}

TEST(PrincipalInertia, TurnedBackIsTheInertia)
{
    const Sym3 askew{2, 3, 4, 0.1, -0.2, 0.3};
    const PrincipalInertia principal = principal_inertia(askew);
    const Mat3 back = principal.axes * principal.moments.asDiagonal() * principal.axes.transpose();
    EXPECT_LT((back - askew.matrix()).norm(), 1e-14);
    EXPECT_NEAR(principal.axes.determinant(), 1, 1e-14);
}

}  // namespace
}  // namespace throng
