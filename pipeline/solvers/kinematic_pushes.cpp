// Kinematic pushes: bodies that overlap are put side by side as they are, and none turns. Places
// change no faster than the push limit lets a pair part.
//
// Of each velocity the part along the normal that closes is taken away, half of it from each of two
// that can move, whatever their masses; the part across is slowed by friction. Nothing is
// conserved.
#include "pipeline/solvers/island_solver.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

int iterations_of(const SolverParameters& parameters)
{
    constexpr int kIterations = 8;
    return parameters.iterations > 0 ? parameters.iterations : kIterations;
}

}  // namespace

// kg, what a change of the speed of b against a takes: the mean over those that can move, as each
// is changed by its share whatever it weighs.
double IslandSolver::mass_of(const DirectPoint& point) const
{
    double sum = 0;
    int moving = 0;
    const auto [a, b] = shares_of(point);
    for (const auto& [body_index, share] : {std::pair(point.a, a), std::pair(point.b, b)}) {
        if (!(share > 0)) continue;
        sum += share / after_[static_cast<std::size_t>(body_index)].inverse_mass;
        ++moving;
    }
    return moving > 0 ? sum / moving : 0;
}

// How much of a push falls to each: half, or all of it where the other cannot move.
std::pair<double, double> IslandSolver::shares_of(const DirectPoint& point) const
{
    const auto moves = [&](std::int32_t body_index) {
        return body_index >= 0 && after_[static_cast<std::size_t>(body_index)].inverse_mass > 0;
    };
    const bool a = moves(point.a), b = moves(point.b);
    return {a ? b ? 0.5 : 1.0 : 0.0, b ? a ? 0.5 : 1.0 : 0.0};
}

void IslandSolver::stop_approach(std::size_t at)
{
    DirectPoint& point = points_[at];
    const double closing = -approach(at, after_);
    if (separations_[at] > 0 || !(closing > 0)) return;
    const auto velocity = [&](std::int32_t body_index) -> Vec3 {
        return body_index < 0 ? Vec3(Vec3::Zero())
                              : after_[static_cast<std::size_t>(body_index)].velocity;
    };
    const Vec3 between = velocity(point.b) - velocity(point.a) - point.walk;
    const Vec3 sliding = between - point.normal * point.normal.dot(between);
    const double fast = std::sqrt(sliding.squaredNorm());
    Vec3 change = point.normal * closing;
    if (fast > 0) change -= sliding * std::min(1.0, point.friction * closing / fast);
    point.impulse += change * mass_of(point);
    const auto [a, b] = shares_of(point);
    if (a > 0) after_[static_cast<std::size_t>(point.a)].velocity -= a * change;
    if (b > 0) after_[static_cast<std::size_t>(point.b)].velocity += b * change;
}

// By so much at most from where place_points() found the two.
void IslandSolver::push_out_of(std::size_t at, double most)
{
    if (!(separations_[at] < -contacts_[at].tolerance)) return;
    const double way = std::min(0.0, separations_[at] + most) - separation_now(at);
    if (!(way > 0)) return;
    const DirectPoint& point = points_[at];
    const auto [a, b] = shares_of(point);
    if (a > 0) bodies_[static_cast<std::size_t>(point.a)].moved -= a * way * point.normal;
    if (b > 0) bodies_[static_cast<std::size_t>(point.b)].moved += b * way * point.normal;
}

void IslandSolver::stop_approaches(const StepContext&, double)
{
    for (DirectPoint& point : points_) point.impulse = point.torque = Vec3::Zero();
    for (int iteration = 0; iteration < iterations_of(parameters_); ++iteration)
        for (std::size_t i = 0; i < contacts_.size(); ++i) stop_approach(i);
    going_ = after_;
}

// That forces make which act after bodies moved.
void IslandSolver::stop_late_approaches(const StepContext&, double)
{
    if (!end_state_forces()) return;
    place_points();
    for (int iteration = 0; iteration < iterations_of(parameters_); ++iteration)
        for (std::size_t i = 0; i < contacts_.size(); ++i) stop_approach(i);
}

void IslandSolver::push_out(const StepContext&, double time)
{
    place_points();
    const double most = parameters_.push_limit * time;
    for (int iteration = 0; iteration < iterations_of(parameters_); ++iteration)
        for (std::size_t i = 0; i < contacts_.size(); ++i) push_out_of(i, most);
}

}  // namespace throng
