#include "kernels/solver/direct/body_matrix.hpp"

#include <Eigen/SparseLU>

#include <vector>

namespace throng {

namespace {

using Block = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

// Two tied bodies, the later one first: blocks below the diagonal.
struct Pair {
    std::int32_t row = 0, column = 0;
    bool operator==(const Pair&) const = default;
    bool operator<(const Pair& other) const
    {
        return column != other.column ? column < other.column : row < other.row;
    }
};

}  // namespace

struct BodyMatrix::Work {
    std::vector<BodyTie> ties;
    std::vector<Pair> pairs;              // column by column
    std::vector<std::size_t> pair_of;     // [ties]
    std::vector<std::size_t> first_pair;  // [bodies + 1] of each column
    std::vector<Block> diagonal, below;   // [bodies], [pairs]
    std::vector<Block> above;
    Eigen::SparseMatrix<double> matrix;
    Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::AMDOrdering<int>> factors;
    Eigen::VectorXd right, solved;

    struct Place {
        int row = 0;
        const Block* block = nullptr;
    };
    std::vector<std::vector<Place>> columns;  // [bodies]

    void list_pairs(std::size_t bodies);
    void lay_pattern();
    void copy_blocks();
};

void BodyMatrix::Work::list_pairs(std::size_t bodies)
{
    const auto pair_of_tie = [](const BodyTie& tie) {
        return Pair{std::max(tie.a, tie.b), std::min(tie.a, tie.b)};
    };
    pairs.clear();
    for (const BodyTie& tie : ties)
        if (tie.a >= 0 && tie.b >= 0) pairs.push_back(pair_of_tie(tie));
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    pair_of.clear();
    for (const BodyTie& tie : ties)
        pair_of.push_back(static_cast<std::size_t>(
            std::lower_bound(pairs.begin(), pairs.end(), pair_of_tie(tie)) - pairs.begin()));
    first_pair.assign(bodies + 1, 0);
    for (const Pair& pair : pairs) ++first_pair[static_cast<std::size_t>(pair.column) + 1];
    for (std::size_t i = 0; i < bodies; ++i) first_pair[i + 1] += first_pair[i];
}

// Where the numbers are: column by column the blocks of both halves, in order of rows.
void BodyMatrix::Work::lay_pattern()
{
    const auto bodies = static_cast<int>(diagonal.size());
    columns.assign(diagonal.size(), {});
    for (std::size_t i = 0; i < diagonal.size(); ++i)
        columns[i].push_back({static_cast<int>(i), &diagonal[i]});
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        columns[static_cast<std::size_t>(pairs[p].column)].push_back({pairs[p].row, &below[p]});
        columns[static_cast<std::size_t>(pairs[p].row)].push_back({pairs[p].column, &above[p]});
    }
    for (auto& column : columns)
        std::sort(column.begin(), column.end(),
                  [](const auto& x, const auto& y) { return x.row < y.row; });
    matrix.resize(6 * bodies, 6 * bodies);
    matrix.resizeNonZeros(static_cast<Eigen::Index>(36 * diagonal.size() + 72 * pairs.size()));
    int* const outer = matrix.outerIndexPtr();
    int* const inner = matrix.innerIndexPtr();
    int at = 0;
    for (int body = 0; body < bodies; ++body)
        for (int k = 0; k < 6; ++k) {
            outer[6 * body + k] = at;
            for (const auto& place : columns[static_cast<std::size_t>(body)])
                for (int i = 0; i < 6; ++i) inner[at++] = 6 * place.row + i;
        }
    outer[6 * bodies] = at;
    std::fill_n(matrix.valuePtr(), at, 1.0);
}

void BodyMatrix::Work::copy_blocks()
{
    double* value = matrix.valuePtr();
    for (const auto& column : columns)
        for (Eigen::Index k = 0; k < 6; ++k)
            for (const auto& place : column)
                for (Eigen::Index i = 0; i < 6; ++i) *value++ = (*place.block)(i, k);
}

BodyMatrix::BodyMatrix() : work_(std::make_unique<Work>()) { }
BodyMatrix::~BodyMatrix() = default;
BodyMatrix::BodyMatrix(BodyMatrix&&) noexcept = default;
BodyMatrix& BodyMatrix::operator=(BodyMatrix&&) noexcept = default;

void BodyMatrix::lay_out(std::size_t bodies, std::span<const BodyTie> ties)
{
    Work& work = *work_;
    work.ties.assign(ties.begin(), ties.end());
    work.list_pairs(bodies);
    work.diagonal.resize(bodies);
    work.below.resize(work.pairs.size());
    work.above.resize(work.pairs.size());
    work.lay_pattern();
    work.right.resize(work.matrix.rows());
    work.factors.analyzePattern(work.matrix);
}

void BodyMatrix::clear()
{
    for (Block& block : work_->diagonal) block.setIdentity();
    for (Block& block : work_->below) block.setZero();
    for (Block& block : work_->above) block.setZero();
}

void BodyMatrix::add(std::size_t tie,
                     const ConeBlock& of_a,
                     const ConeBlock& of_b,
                     const ConeWeight& weight)
{
    const auto [a, b] = work_->ties[tie];
    const auto rows_a = of_a.topRows(weight.rows()), rows_b = of_b.topRows(weight.rows());
    const auto diagonal = [&](std::int32_t body) -> Block& {
        return work_->diagonal[static_cast<std::size_t>(body)];
    };
    if (a >= 0) diagonal(a).noalias() += rows_a.transpose() * (weight * rows_a).eval();
    if (b >= 0) diagonal(b).noalias() += rows_b.transpose() * (weight * rows_b).eval();
    if (a < 0 || b < 0) return;
    Block& below = work_->below[work_->pair_of[tie]];
    Block& above = work_->above[work_->pair_of[tie]];
    (a > b ? below : above).noalias() += rows_a.transpose() * (weight * rows_b).eval();
    (a > b ? above : below).noalias() += rows_b.transpose() * (weight * rows_a).eval();
}

bool BodyMatrix::factorise()
{
    work_->copy_blocks();
    work_->factors.factorize(work_->matrix);
    return work_->factors.info() == Eigen::Success;
}

void BodyMatrix::solve(std::span<BodySix> right)
{
    Work& work = *work_;
    for (std::size_t i = 0; i < right.size(); ++i)
        work.right.segment<6>(6 * static_cast<Eigen::Index>(i)) = right[i];
    work.solved = work.factors.solve(work.right);
    for (std::size_t i = 0; i < right.size(); ++i)
        right[i] = work.solved.segment<6>(6 * static_cast<Eigen::Index>(i));
}

}  // namespace throng
