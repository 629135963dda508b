#include "kernels/solver/direct/cone_lemke.hpp"

#include "kernels/math/rotation.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

namespace throng {

namespace {

// A table of so many rows takes 5 MB, and up to half a second. Greater ones took seconds, and left
// hardly an answer nearer.
constexpr std::size_t kMostRows = 800;
constexpr std::size_t kMostSides = 8, kFewestSides = 4;
constexpr std::size_t kPivotsPerRow = 10;  // most take one or two
// Rows are set off by so much, each by its own: no two then reach 0 at once, and none comes back.
constexpr double kApart = 1e-8;
// What rounding leaves of 0 in the table.
constexpr double kRounding = 1e-11;

// `place` from -1 to 1 goes once round, from behind through where friction goes.
ConeVector side(const ContactCone& cone, double place, int closer)
{
    double angle = std::numbers::pi * place;
    for (int i = 0; i < closer; ++i) angle *= std::abs(place);
    const SinCos turn = sin_cos(angle);
    const double held = width(cone.impulse);
    const double x = held > 0 ? cone.impulse[1] / held : 1;
    const double y = held > 0 ? cone.impulse[2] / held : 0;
    return {0, x * turn.cos - y * turn.sin, x * turn.sin + y * turn.cos};
}

}  // namespace

ConeLemke::ConeLemke(ContactCones& island) : island_(island), speed_(island.cones.size()) { }

bool ConeLemke::choose_rows(int closer)
{
    const std::size_t points = island_.cones.size();
    if (points * (kFewestSides + 2) > kMostRows) return false;
    const std::size_t sides = std::min(kMostRows / points - 2, kMostSides) / 2 * 2;
    rows_.clear();
    for (std::size_t i = 0; i < points; ++i) {
        rows_.push_back({i, Kind::load, {1}});
        if (island_.cones[i].rows == 1) continue;
        add_friction(i, sides, closer);
        rows_.push_back({i, Kind::rest, {}});
    }
    return rows_.size() <= kMostRows;
}

// Of a cone of more than three rows the sides stand along the axes, both ways.
void ConeLemke::add_friction(std::size_t at, std::size_t sides, int closer)
{
    const ContactCone& cone = island_.cones[at];
    if (cone.rows == 3) {
        for (std::size_t k = 0; k < sides; ++k) {
            const double place = 2 * static_cast<double>(k) / static_cast<double>(sides) - 1;
            rows_.push_back({at, Kind::friction, side(cone, place, closer)});
        }
        return;
    }
    for (std::size_t k = 1; k < cone.rows; ++k)
        for (const double sense : {-1.0, 1.0}) {
            rows_.push_back({at, Kind::friction, {}});
            rows_.back().way[k] = sense;
        }
}

// A load keeps from closing. Friction one way keeps from sliding faster the other way than the
// point slides, which is the impulse of what is left: only where nothing is does it slide.
void ConeLemke::fill_table()
{
    const std::size_t rows = rows_.size();
    width_ = rows + 2;
    table_.assign(rows * width_, 0);
    for (std::size_t column = 0; column < rows; ++column) fill_column(column);
    double share = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        constexpr double kGolden = 0.61803398874989485;
        share += share < 1 - kGolden ? kGolden : kGolden - 1;
        at(row, rows) = 1;
        at(row, rows + 1) =
            dot(rows_[row].way, island_.cones[rows_[row].cone].free) + kApart * share;
    }
}

void ConeLemke::fill_column(std::size_t column)
{
    const Row& pushed = rows_[column];
    change_.assign(island_.columns(), BodySix::Zero());
    island_.apply_impulse(island_.cones[pushed.cone], pushed.way, change_);
    for (std::size_t i = 0; i < speed_.size(); ++i)
        speed_[i] = island_.seen(island_.cones[i], change_);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Row& row = rows_[i];
        if (row.kind != Kind::rest)
            at(i, column) = dot(row.way, speed_[row.cone]);
        else if (row.cone == pushed.cone && pushed.kind != Kind::rest)
            at(i, column) = pushed.kind == Kind::load ? 1 : -1;
        if (row.cone == pushed.cone && row.kind == Kind::friction && pushed.kind == Kind::rest)
            at(i, column) = 1;
    }
}

// The way there lifts all rows alike, as far as the lowest asks for.
bool ConeLemke::start()
{
    const std::size_t rows = rows_.size();
    basic_.resize(rows);
    zero_.resize(rows + 1);
    std::size_t least = 0;
    for (std::size_t i = 0; i < rows; ++i) {
        basic_[i] = i;
        zero_[i] = rows + i;
        if (at(i, rows + 1) < at(least, rows + 1)) least = i;
    }
    zero_[rows] = 2 * rows;
    if (!(at(least, rows + 1) < 0)) return false;
    exchange(least, rows);
    return true;
}

// Which row comes to 0 first where the column's grows; none is rows_.size(). The way wins a tie.
std::size_t ConeLemke::leaves_first(std::size_t column) const
{
    const std::size_t rows = rows_.size();
    std::size_t first = rows;
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rows; ++i) {
        if (!(at(i, column) < -kRounding)) continue;
        const double length = std::max(at(i, rows + 1), 0.0) / -at(i, column);
        if (length > shortest || (length == shortest && basic_[i] != 2 * rows)) continue;
        shortest = length;
        first = i;
    }
    return first;
}

void ConeLemke::exchange(std::size_t row, std::size_t column)
{
    double* const from = &at(row, 0);
    const double pivot = from[column];
    for (std::size_t j = 0; j < width_; ++j) from[j] /= -pivot;
    from[column] = 1 / pivot;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        double* const to = &at(i, 0);
        const double share = to[column];
        if (i == row || share == 0) continue;
        to[column] = 0;
        for (std::size_t j = 0; j < width_; ++j) to[j] += share * from[j];
    }
    std::swap(basic_[row], zero_[column]);
}

// What left last makes room for its counterpart, until the way itself leaves.
bool ConeLemke::pivot()
{
    const std::size_t rows = rows_.size();
    for (std::size_t column = rows, many = 0; many < kPivotsPerRow * rows; ++many) {
        const std::size_t left = zero_[column];
        const std::size_t enters = left < rows ? left + rows : left - rows;
        column =
            static_cast<std::size_t>(std::find(zero_.begin(), zero_.end(), enters) - zero_.begin());
        const std::size_t row = leaves_first(column);
        if (row == rows) return false;
        exchange(row, column);
        if (zero_[column] == 2 * rows) return true;
    }
    return false;
}

void ConeLemke::give()
{
    const std::size_t rows = rows_.size();
    for (ContactCone& cone : island_.cones) cone.impulse = {};
    for (std::size_t i = 0; i < rows; ++i) {
        if (basic_[i] < rows) continue;
        const Row& row = rows_[basic_[i] - rows];
        ConeVector& impulse = island_.cones[row.cone].impulse;
        impulse = sum(impulse, row.way, std::max(at(i, rows + 1), 0.0));
    }
    for (ContactCone& cone : island_.cones) cone.impulse = projected(cone.impulse);
}

bool ConeLemke::run(int closer)
{
    if (!choose_rows(closer)) return false;
    fill_table();
    if (!start() || !pivot()) return false;
    give();
    return true;
}

}  // namespace throng
