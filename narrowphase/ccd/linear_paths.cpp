#include "narrowphase/ccd/linear_paths.hpp"

#include "kernels/geometry/closest_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

// What is not settled by then grazes, and is told early.
constexpr int kMostRounds = 256, kMostAdvances = 4096;

// Those of the first side come first.
std::size_t count_of_a(PathKind kind) { return kind == PathKind::vertex_face ? 1 : 2; }

class Paths {
public:
    explicit Paths(const LinearPaths& paths) : paths_(paths), rounding_(rounding_of(paths))
    {
        for (std::size_t i = 0; i < 4; ++i) way_[i] = paths.to[i] - paths.from[i];
    }

    /// From the nearest point of the one to that of the other: of no length where they touch.
    Vec3 between(double time) const
    {
        std::array<Vec3, 4> at;
        for (std::size_t i = 0; i < 4; ++i) at[i] = place(i, time);
        if (paths_.kind == PathKind::vertex_face)
            return closest_on_triangle<double>(at[0], at[1], at[2], at[3]).point - at[0];
        const auto nearest = closest_points<double>({at[0], at[1]}, {at[2], at[3]});
        return nearest.on_b - nearest.on_a;
    }

    SeparationRate separation_rate(const Vec3& normal, double time) const
    {
        SeparationRate separation{std::numeric_limits<double>::infinity(), 0};
        SeparationRate of_a{-std::numeric_limits<double>::infinity(), 0};
        for (std::size_t i = 0; i < 4; ++i) {
            const double along = normal.dot(place(i, time));
            if (i < count_of_a(paths_.kind)) {
                if (along > of_a.value) of_a = {along, normal.dot(way_[i])};
            } else if (along < separation.value) {
                separation = {along, normal.dot(way_[i])};
            }
        }
        return {separation.value - of_a.value - rounding_, separation.slope - of_a.slope};
    }

    double greatest_speed(const Vec3& normal) const
    {
        double of_a = -std::numeric_limits<double>::infinity(), of_b = -of_a;
        for (std::size_t i = 0; i < 4; ++i) {
            const double along = normal.dot(way_[i]);
            if (i < count_of_a(paths_.kind))
                of_a = std::max(of_a, along);
            else
                of_b = std::min(of_b, along);
        }
        return of_a - of_b;
    }

    double rounding() const { return rounding_; }

private:
    // The ends are the very points that were given.
    Vec3 place(std::size_t i, double time) const
    {
        return time < 1 ? Vec3(paths_.from[i] + time * way_[i]) : paths_.to[i];
    }

    const LinearPaths& paths_;
    double rounding_;
    std::array<Vec3, 4> way_;
};

}  // namespace

double rounding_of(const LinearPaths& paths)
{
    // A place is off by 3 roundings of its size, a sum of three products by as many again.
    constexpr double kRoundings = 32 * std::numeric_limits<double>::epsilon();
    double most = std::numeric_limits<double>::min();
    for (std::size_t i = 0; i < 4; ++i)
        most = std::max(
            {most, paths.from[i].cwiseAbs().maxCoeff(), paths.to[i].cwiseAbs().maxCoeff()});
    return kRoundings * most;
}

Impact time_of_impact(const LinearPaths& paths, ToiMethod method, double tolerance)
{
    const Paths ways(paths);
    const ImpactRule rule = impact_rule(method, std::max(tolerance, 8 * ways.rounding()));
    Impact impact;
    double time = 0;
    const int most = method == ToiMethod::conservative ? kMostAdvances : kMostRounds;
    for (int round = 0;; ++round) {
        const Vec3 between = ways.between(time);
        const double length = between.norm();
        ++impact.evaluations;
        impact.time = time;
        SeparationRate separation;
        if (length > 0) {
            impact.normal = between / length;
            separation = ways.separation_rate(impact.normal, time);
        }
        impact.distance = std::max(0.0, separation.value);
        if (!(separation.value > rule.close)) {
            impact.state = round == 0 ? ToiState::touching_at_start : ToiState::hit;
            return impact;
        }
        if (round == most) break;
        const auto separation_at = [&](double at) {
            ++impact.evaluations;
            return ways.separation_rate(impact.normal, at);
        };
        const Crossing crossing = first_crossing(rule, separation_at, time, separation, 1.0,
                                                 {0, ways.greatest_speed(impact.normal)});
        if (crossing.clear) {
            impact.time = 1;
            return impact;
        }
        if (!(crossing.time > time)) break;
        time = crossing.time;
    }
    impact.state = ToiState::hit;
    impact.cut_short = true;
    return impact;
}

}  // namespace throng
