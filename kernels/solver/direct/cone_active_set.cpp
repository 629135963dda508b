#include "kernels/solver/direct/cone_active_set.hpp"

#include <limits>

namespace throng {

namespace {

// How hard rows are held, of their own mass: an iteration leaves a share of one over that of the
// error of what hardly resists, and loses as many digits.
constexpr double kHold = 1e7;
constexpr double kWorse = 100;  // than the best met so far: these kinds lead nowhere
constexpr int kMostVisits = 40;
constexpr double kEnough = 1e-14;  // residual: rounding
// An iteration that leaves more of the residual than this calls for other kinds or another matrix.
constexpr double kSlow = 0.3;
constexpr double kRounding = 1e-12;
// Slower than this, of the greatest speed, a point is on the verge of sliding.
constexpr double kVerge = 1e-10;

}  // namespace

ConeActiveSet::ConeActiveSet(ContactCones& island, BodyMatrix& matrix)
    : island_(island), matrix_(matrix), states_(island.cones.size())
{ }

std::size_t ConeActiveSet::held(std::size_t cone) const
{
    switch (states_[cone].kind) {
    case Kind::parts:
        return 0;
    case Kind::slides:
        return 1;
    default:
        return island_.cones[cone].rows;
    }
}

// Of one on the verge, the way that its friction resists.
ConeVector ConeActiveSet::way_of(const ContactCone& cone) const
{
    const double speed = width(cone.speed), impulse = width(cone.impulse);
    const bool moves = speed > kVerge;
    const double scale = moves ? 1 / speed : impulse > 0 ? -1 / impulse : 0;
    ConeVector way{};
    for (std::size_t k = 1; k < cone.rows; ++k)
        way[k] = (moves ? cone.speed : cone.impulse)[k] * scale;
    return way;
}

// Of the greater and the lesser root of speed and impulse, one of each pair fades.
void ConeActiveSet::tell_kinds()
{
    for (std::size_t i = 0; i < states_.size(); ++i) {
        ContactCone& cone = island_.cones[i];
        const double speed = width(cone.speed), impulse = width(cone.impulse);
        if (cone.speed[0] - speed > cone.impulse[0] + impulse)
            states_[i].kind = Kind::parts;
        else if (cone.rows == 1 || cone.speed[0] + speed < cone.impulse[0] - impulse)
            states_[i].kind = Kind::sticks;
        else
            states_[i].kind = Kind::slides;
        if (states_[i].kind == Kind::parts) cone.impulse = {};
    }
}

// The speeds that the impulses make.
void ConeActiveSet::look()
{
    island_.push_all(change_);
    for (ContactCone& cone : island_.cones)
        cone.speed = sum(cone.free, island_.seen(cone, change_));
}

void ConeActiveSet::sort_out()
{
    for (std::size_t i = 0; i < states_.size(); ++i) {
        ContactCone& cone = island_.cones[i];
        Kind& kind = states_[i].kind;
        if (kind != Kind::parts && cone.impulse[0] < -kRounding)
            kind = Kind::parts, cone.impulse = {};
        else if (kind == Kind::sticks && cone.rows > 1
                 && width(cone.impulse) > cone.impulse[0] * (1 + kRounding))
            kind = Kind::slides;
        // What would slide back need not have its friction full.
        else if ((kind == Kind::parts && cone.speed[0] < -kRounding)
                 || (kind == Kind::slides && dot(states_[i].way, cone.speed) < -kRounding))
            kind = Kind::sticks;
        states_[i].way = way_of(cone);
        const double speed = width(cone.speed);
        states_[i].stiffness =
            std::min(kHold, speed > 0 ? std::max(cone.impulse[0], 0.0) / speed : kHold);
    }
}

// What a change of speed does to the impulse: held rows resist it, friction of what slides keeps to
// its normal impulse and turns with the sliding.
ConeVector ConeActiveSet::answer(std::size_t at, const ConeVector& change) const
{
    const State& state = states_[at];
    ConeVector impulse{};
    for (std::size_t k = 0; k < held(at); ++k) impulse[k] = -kHold * change[k];
    if (state.kind != Kind::slides) return impulse;
    const double along = dot(state.way, change);
    for (std::size_t k = 1; k < island_.cones[at].rows; ++k)
        impulse[k] =
            -state.stiffness * (change[k] - state.way[k] * along) - impulse[0] * state.way[k];
    return impulse;
}

bool ConeActiveSet::factorise()
{
    matrix_.clear();
    for (std::size_t i = 0; i < states_.size(); ++i) {
        if (states_[i].kind == Kind::parts) continue;
        const ContactCone& cone = island_.cones[i];
        const auto rows = static_cast<Eigen::Index>(cone.rows);
        ConeWeight weight(rows, rows);
        for (std::size_t j = 0; j < cone.rows; ++j) {
            ConeVector unit{};
            unit[j] = 1;
            const ConeVector column = answer(i, unit);
            for (std::size_t k = 0; k < cone.rows; ++k)
                weight(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) = -column[k];
        }
        matrix_.add(i, cone.of_a, cone.of_b, weight);
    }
    return matrix_.factorise();
}

// Multipliers take up what is left of the speed of held rows, and friction of what slides comes to
// where it should be.
void ConeActiveSet::solve_once()
{
    step_.assign(change_.size(), BodySix::Zero());
    for (std::size_t i = 0; i < states_.size(); ++i) {
        State& state = states_[i];
        const ContactCone& cone = island_.cones[i];
        ConeVector held_speed{};
        for (std::size_t k = 0; k < held(i); ++k) held_speed[k] = cone.speed[k];
        state.pull = answer(i, held_speed);
        if (state.kind == Kind::slides) {
            const ConeVector way = way_of(cone);
            for (std::size_t k = 1; k < cone.rows; ++k)
                state.pull[k] -= cone.impulse[0] * way[k] + cone.impulse[k];
        }
        island_.apply_impulse(cone, state.pull, step_);
    }
    matrix_.solve(step_);
    for (std::size_t i = 0; i < states_.size(); ++i) {
        ContactCone& cone = island_.cones[i];
        if (states_[i].kind == Kind::parts) continue;
        cone.impulse = sum(cone.impulse, states_[i].pull);
        cone.impulse = sum(cone.impulse, answer(i, island_.seen(cone, step_)));
    }
}

double ConeActiveSet::run(int& most)
{
    double best = std::numeric_limits<double>::infinity(), last = best;
    bool stale = true;
    tell_kinds();
    for (int i = 0; i < kMostVisits; ++i) {
        look();
        if (stale) {
            sort_out();
            if (most-- <= 0 || !factorise()) break;
        }
        solve_once();
        const double now = island_.residual(step_);
        if (now < best) {
            best = now;
            for (std::size_t k = 0; k < states_.size(); ++k)
                states_[k].best = island_.cones[k].impulse;
        }
        if (!(now > kEnough) || now > kWorse * best || !std::isfinite(now)) break;
        stale = !(now < kSlow * last);
        last = now;
    }
    for (std::size_t k = 0; k < states_.size(); ++k) island_.cones[k].impulse = states_[k].best;
    return best;
}

}  // namespace throng
