// Body matrix: masses and what ties them together, six rows a body, factorised sparse.
//
// Bodies are told in units in which each has mass 1, so without ties the matrix is the identity.
#pragma once

#include "kernels/solver/direct/cones.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <span>

namespace throng {

/// Numbers of a body: linear, then angular.
using BodySix = Eigen::Matrix<double, 6, 1>;
/// Rows over the six of one body.
using ConeBlock = Eigen::Matrix<double, int(kConeRows), 6, Eigen::RowMajor>;
/// How the rows of a tie weigh on one another; need not be symmetric, as friction follows the
/// normal and not the other way round.
using ConeWeight = Eigen::
    Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, int(kConeRows), int(kConeRows)>;

/// Two bodies that something ties together; below 0 for what does not move.
struct BodyTie {
    std::int32_t a = -1, b = -1;
};

/// The sum of the identity and, over all ties, rows' weight rows.
class BodyMatrix {
public:
    BodyMatrix();
    ~BodyMatrix();
    BodyMatrix(BodyMatrix&&) noexcept;
    BodyMatrix& operator=(BodyMatrix&&) noexcept;

    /// Which bodies there are and which are tied: the order of elimination follows from that alone,
    /// least fill first.
    void lay_out(std::size_t bodies, std::span<const BodyTie> ties);

    /// Back to the identity.
    void clear();
    /// Adds the tie at its place among those laid out; its rows over either body.
    void add(std::size_t tie, const ConeBlock& a, const ConeBlock& b, const ConeWeight& weight);

    /// False where rounding left nothing to divide by.
    bool factorise();
    /// x of matrix x = right, in place; needs a matrix that was factorised.
    void solve(std::span<BodySix> right);

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

}  // namespace throng
