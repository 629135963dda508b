#include "kernels/solve/direct.hpp"

#include "kernels/solve/cone_hold.hpp"
#include "kernels/solve/cone_path.hpp"

#include <limits>

namespace throng {

namespace {

// Residual at which nothing is to be gained, and one that will do once holding has failed.
constexpr double kDone = 1e-11, kGood = 1e-10;
// Holding is tried from here on, and again each time that the path has come a hundred times nearer.
constexpr double kNear = 1e-3, kNearer = 0.01;
constexpr int kHoldSteps = 8;  // factorisations of one try
// Steps of the path without getting nearer by a tenth, after which it is followed the other way;
// and how often that may be.
constexpr int kPatience = 5, kTurns = 6;

}  // namespace

struct DirectSolver::Work {
    ContactCones island;
    BodyMatrix matrix;
    std::vector<ConeVector> best;  // impulses
    std::vector<BodySix> scratch;
    DirectAnswer answer;
    int left = 0;  // steps

    bool keep_if_better(double residual);
    bool hold();
    bool start_from_guess();
    void follow_path();
};

// True once it is good.
bool DirectSolver::Work::keep_if_better(double residual)
{
    if (residual < answer.residual) {
        answer.residual = residual;
        for (std::size_t i = 0; i < best.size(); ++i) best[i] = island.cones[i].impulse;
    }
    return answer.residual <= kDone;
}

bool DirectSolver::Work::hold()
{
    int most = std::min(left, kHoldSteps);
    left -= most;
    const double residual = ConeHold(island, matrix).run(most);
    left += std::max(most, 0);
    return keep_if_better(residual);
}

// What rests goes on as it did: then not even a matrix is needed.
bool DirectSolver::Work::start_from_guess()
{
    if (keep_if_better(island.residual(scratch))) return true;
    matrix.lay_out(island.columns(), island.ties());
    bool any = false;
    for (const ContactCone& cone : island.cones) any = any || cone.impulse[0] > 0;
    if (!any) return false;
    island.push_all(scratch);
    for (ContactCone& cone : island.cones) {
        cone.speed = sum(cone.free, island.seen(cone, scratch));
        cone.speed[0] += width(cone.speed);
    }
    return hold();
}

void DirectSolver::Work::follow_path()
{
    ConePath path(island, matrix);
    double try_below = kNear, nearest = std::numeric_limits<double>::infinity();
    bool follows = true;
    for (int waited = 0, turns = 0; left > 0; ++waited) {
        if (waited > kPatience) {
            if (++turns > kTurns) return;
            path.follow_sliding(follows = !follows);
            waited = 0;
            nearest = std::numeric_limits<double>::infinity();
        }
        --left;
        const bool went = path.step();
        path.show();
        const double now = island.residual(scratch);
        if (keep_if_better(now)) return;
        if (now < 0.9 * nearest) nearest = now, waited = 0;
        if (now < try_below) {
            if (hold() || answer.residual < kGood) return;
            try_below = now * kNearer;
        }
        if (!went) return;
    }
}

DirectSolver::DirectSolver() : work_(std::make_unique<Work>()) { }
DirectSolver::~DirectSolver() = default;
DirectSolver::DirectSolver(DirectSolver&&) noexcept = default;
DirectSolver& DirectSolver::operator=(DirectSolver&&) noexcept = default;

DirectAnswer
DirectSolver::solve(std::span<DirectBody> bodies, std::span<DirectPoint> points, int most_steps)
{
    Work& work = *work_;
    work.answer = {};
    if (!work.island.take(bodies, points)) {
        for (DirectPoint& point : points) point.impulse = point.torque = Vec3::Zero();
        return work.answer;
    }
    work.best.assign(work.island.cones.size(), ConeVector{});
    work.answer.residual = std::numeric_limits<double>::infinity();
    work.left = most_steps;
    if (!work.start_from_guess()) work.follow_path();
    for (std::size_t i = 0; i < work.best.size(); ++i) work.island.cones[i].impulse = work.best[i];
    work.island.give(bodies, points);
    work.answer.steps = most_steps - work.left;
    return work.answer;
}

}  // namespace throng
