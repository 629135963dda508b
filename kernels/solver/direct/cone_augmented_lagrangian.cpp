#include "kernels/solver/direct/cone_augmented_lagrangian.hpp"

#include <limits>

namespace throng {

namespace {

// Stiffness of the springs, impulse over speed of rows whose own answer is 1: to begin with, and
// within which it is kept. The stiffest leave a few digits to the velocities.
constexpr double kFirst = 100, kSoftest = 1, kStiffest = 1e7;
constexpr double kStiffer = 10, kSofter = 0.1;
// Sweeps before a try: at most after it went well, and as it went badly.
constexpr int kSweeps = 25, kMostSweeps = 3200;
constexpr int kMostDue = 8;
constexpr int kTries = 60;
constexpr int kNewtonSteps = 8;  // of one try
constexpr int kHalvings = 10;    // of a step of Newton's
constexpr double kLeast = 0.02;  // share of such a step, less of which leads nowhere
constexpr double kGain = 0.1;    // share of what a step promises that it has to keep
// A try has come to rest where so little is left of what was missing, or nothing but rounding.
constexpr double kRest = 1e-4, kRounding = 1e-15;
// The stiffest springs show what no impulse can solve: nothing changes from try to try.
constexpr double kVeryStiff = 1e6, kSame = 1e-3;
constexpr int kMostSame = 3;

}  // namespace

ConeAugmentedLagrangian::ConeAugmentedLagrangian(ContactCones& island, BodyMatrix& matrix)
    : island_(island), matrix_(matrix), gauss_seidel_(island), states_(island.cones.size())
{ }

double ConeAugmentedLagrangian::keep_if_best()
{
    const double now = island_.residual(step_);
    if (now < best_) {
        best_ = now;
        for (std::size_t i = 0; i < states_.size(); ++i) states_[i].best = island_.cones[i].impulse;
    }
    return now;
}

// Impulses of the springs where velocities change so, and into missing_ what these would make of
// the velocities less what they are; gives its length.
double ConeAugmentedLagrangian::stretch(std::span<const BodySix> change)
{
    missing_.assign(change.size(), BodySix::Zero());
    for (std::size_t i = 0; i < states_.size(); ++i) {
        State& state = states_[i];
        const ContactCone& cone = island_.cones[i];
        const ConeVector speed = sum(cone.free, island_.seen(cone, change));
        state.wanted = sum(state.start, speed, -stiffness_);
        state.is = {};
        state.kind = Kind::parts;
        const double load = state.wanted[0], across = width(state.wanted);
        if (!(load > 0)) continue;
        state.kind = across > load ? Kind::slides : Kind::sticks;
        state.is = state.wanted;
        if (across > load)
            for (std::size_t k = 1; k < cone.rows; ++k) state.is[k] *= load / across;
        island_.apply_impulse(cone, state.is, missing_);
    }
    double squares = 0;
    for (std::size_t i = 0; i < missing_.size(); ++i) {
        missing_[i] -= change[i];
        squares += missing_[i].squaredNorm();
    }
    return std::sqrt(squares);
}

// How the impulse falls with speed: friction of what slides follows its load, and turns with it.
ConeWeight ConeAugmentedLagrangian::weight_of(const State& state, std::size_t rows) const
{
    const auto size = static_cast<Eigen::Index>(rows);
    ConeWeight weight = ConeWeight::Zero(size, size);
    weight.diagonal().setConstant(stiffness_);
    if (state.kind == Kind::sticks) return weight;
    const double across = width(state.wanted), share = state.wanted[0] / across;
    for (Eigen::Index j = 1; j < size; ++j) {
        const double way = state.wanted[static_cast<std::size_t>(j)] / across;
        weight(j, 0) = stiffness_ * way;
        for (Eigen::Index k = 1; k < size; ++k) {
            const double other = state.wanted[static_cast<std::size_t>(k)] / across;
            weight(j, k) = stiffness_ * share * ((j == k ? 1 : 0) - way * other);
        }
    }
    return weight;
}

bool ConeAugmentedLagrangian::factorise()
{
    matrix_.clear();
    for (std::size_t i = 0; i < states_.size(); ++i) {
        if (states_[i].kind == Kind::parts) continue;
        const ContactCone& cone = island_.cones[i];
        matrix_.add(i, cone.of_a, cone.of_b, weight_of(states_[i], cone.rows));
    }
    return matrix_.factorise();
}

// Goes along the step as far as that leaves less missing; gives what is left.
double ConeAugmentedLagrangian::shorten(double missing, double& length)
{
    double now = missing;
    length = 1;
    for (int i = 0; i < kHalvings; ++i, length /= 2) {
        further_ = change_;
        for (std::size_t k = 0; k < further_.size(); ++k) further_[k] += step_[k] * length;
        now = stretch(further_);
        if (now < (1 - kGain * length) * missing) break;
    }
    change_.swap(further_);
    return now;
}

// Newton's method with its steps shortened, from where the impulses now lead.
ConeAugmentedLagrangian::Try ConeAugmentedLagrangian::find_rest(int& most)
{
    Try now;
    for (std::size_t i = 0; i < states_.size(); ++i) states_[i].start = island_.cones[i].impulse;
    island_.push_all(change_);
    double missing = stretch(change_);
    const double rest = std::max(kRest * missing, kRounding * stiffness_);
    for (; missing > rest; ++now.steps) {
        if (now.steps >= kNewtonSteps || most <= 0) return now;
        --most;
        if (!factorise()) return now;
        step_ = missing_;
        matrix_.solve(step_);
        double length = 1;
        missing = shorten(missing, length);
        now.shortest = std::min(now.shortest, length);
        if (length < kLeast) return now;
    }
    now.rests = std::isfinite(missing);
    return now;
}

void ConeAugmentedLagrangian::choose_stiffness(const Try& last)
{
    if (!last.rests) {
        stiffness_ = std::max(stiffness_ * kSofter, kSoftest);
        many_ = std::min(2 * many_, kMostSweeps);
        due_ = std::min(2 * due_, kMostDue);
        rested_ = 0;
    } else if (last.shortest >= 0.25 && last.steps <= 5 && ++rested_ >= due_) {
        stiffness_ = std::min(stiffness_ * kStiffer, kStiffest);
        rested_ = 0;
    }
}

double ConeAugmentedLagrangian::run(double enough, double good, int& most)
{
    best_ = std::numeric_limits<double>::infinity();
    keep_if_best();
    stiffness_ = kFirst;
    many_ = kSweeps;
    rested_ = 0, due_ = 1;
    Try last;
    double before = 0;
    for (int i = 0, same = 0; i < kTries && most > 0; ++i) {
        gauss_seidel_.run(last.rests ? kSweeps : many_);
        if (keep_if_best() <= enough) break;
        last = find_rest(most);
        if (last.rests)
            for (std::size_t k = 0; k < states_.size(); ++k)
                island_.cones[k].impulse = states_[k].is;
        const double now = keep_if_best();
        if (best_ <= enough || (best_ <= good && now > 0.5 * best_)) break;
        const bool stays = std::abs(now - before) < kSame * now;
        same = stays && last.rests && stiffness_ >= kVeryStiff ? same + 1 : 0;
        if (same >= kMostSame) break;
        before = now;
        choose_stiffness(last);
    }
    for (std::size_t i = 0; i < states_.size(); ++i) island_.cones[i].impulse = states_[i].best;
    return best_;
}

}  // namespace throng
