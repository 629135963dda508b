#include "kernels/solver/direct/direct.hpp"

#include "kernels/solver/direct/cone_active_set.hpp"
#include "kernels/solver/direct/cone_augmented_lagrangian.hpp"
#include "kernels/solver/direct/cone_interior_point.hpp"
#include "kernels/solver/direct/cone_lemke.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace throng {

namespace {

// Residual at which nothing is to be gained, as a share of the one that is enough.
constexpr double kDone = 0.01;
// Holding is tried from here on, and again each time that the path has come a hundred times nearer.
constexpr double kNear = 1e-3, kNearer = 0.01;
constexpr int kHoldSteps = 8;  // factorisations of one try
// Steps of the path without getting nearer by a tenth, after which it is left.
constexpr int kPatience = 5;
// Sweeps before holding is tried again.
constexpr int kSweeps[] = {100, 200, 400};
// Residual from which an answer throws bodies about, and the sweeps that bring it down where no
// steps are left: together they cost what one or two do.
constexpr double kThrows = 1e-2;
constexpr int kLastSweeps = 200;
// By how much closer sides stand about the way of the friction found before, try by try.
constexpr int kCloser[] = {1, 2, 3, 4};

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Whether all numbers of a problem are finite.
bool is_finite(std::span<const DirectBody> bodies, std::span<const DirectPoint> points)
{
    const auto of_body = [](const DirectBody& body) {
        return std::isfinite(body.inverse_mass) && body.inverse_inertia.matrix().allFinite()
            && body.velocity.allFinite() && body.spin.allFinite();
    };
    const auto of_point = [](const DirectPoint& point) {
        return point.normal.allFinite() && point.arm_a.allFinite() && point.arm_b.allFinite()
            && std::isfinite(point.friction) && std::isfinite(point.rolling)
            && std::isfinite(point.least);
    };
    return std::all_of(bodies.begin(), bodies.end(), of_body)
        && std::all_of(points.begin(), points.end(), of_point);
}

}  // namespace

struct DirectSolver::Work {
    ContactCones island;
    BodyMatrix matrix;
    std::vector<ConeVector> best;  // impulses
    std::vector<BodySix> scratch;
    DirectAnswer answer;
    DirectEffort effort;
    int left = 0;          // steps
    int kept = 0;          // of them, for polish()
    bool solvable = true;  // for certain, as no point is asked to part

    double done() const { return kDone * effort.enough; }
    bool keep_if_better(double residual);
    bool hold();
    void go_back_to_best();
    bool start_from_guess();
    bool follow_path();
    bool hold_from_here();
    bool sweep_and_hold();
    bool pivot_and_hold();
    bool take_springs(int most);
    void find();
    void polish();
    void sweep_what_throws();
};

// True once it is good.
bool DirectSolver::Work::keep_if_better(double residual)
{
    if (residual < answer.residual) {
        answer.residual = residual;
        for (std::size_t i = 0; i < best.size(); ++i) best[i] = island.cones[i].impulse;
    }
    return answer.residual <= done();
}

bool DirectSolver::Work::hold()
{
    int most = std::min(left, kHoldSteps);
    left -= most;
    const double residual = ConeActiveSet(island, matrix).run(most);
    left += std::max(most, 0);
    return keep_if_better(residual);
}

// What rests goes on as it did: then not even a matrix is needed.
bool DirectSolver::Work::start_from_guess()
{
    if (keep_if_better(island.residual(scratch))) return true;
    matrix.lay_out(island.columns(), island.ties());
    const bool guessed = std::any_of(island.cones.begin(), island.cones.end(),
                                     [](const ContactCone& cone) { return cone.impulse[0] > 0; });
    return guessed && hold_from_here();
}

// From the impulses in the cones.
bool DirectSolver::Work::hold_from_here()
{
    ConeGaussSeidel(island).run(0);
    return hold();
}

void DirectSolver::Work::go_back_to_best()
{
    for (std::size_t i = 0; i < best.size(); ++i) island.cones[i].impulse = best[i];
}

bool DirectSolver::Work::follow_path()
{
    ConeInteriorPoint path(island, matrix);
    double try_below = kNear, nearest = kInfinite;
    for (int waited = 0; left > 0 && waited <= kPatience; ++waited) {
        --left;
        const bool went = path.step();
        path.show();
        const double now = island.residual(scratch);
        if (keep_if_better(now)) return true;
        if (now < 0.9 * nearest) nearest = now, waited = 0;
        if (now < try_below) {
            if (hold() || answer.residual < effort.enough) return true;
            try_below = now * kNearer;
        }
        if (!went) return false;
    }
    return false;
}

// From the impulses in the cones. Sweeps tell the kinds where the path has lost its way.
bool DirectSolver::Work::sweep_and_hold()
{
    ConeGaussSeidel iterations(island);
    std::vector<ConeVector> swept(best.size());
    for (const int many : kSweeps) {
        if (left <= 0) return false;
        iterations.run(many);
        if (keep_if_better(island.residual(scratch))) return true;
        for (std::size_t i = 0; i < swept.size(); ++i) swept[i] = island.cones[i].impulse;
        const double before = answer.residual;
        if (hold() || answer.residual < effort.enough) return true;
        if (answer.residual < before) continue;
        for (std::size_t i = 0; i < swept.size(); ++i) island.cones[i].impulse = swept[i];
    }
    return false;
}

// Pivots come near to an answer where all else is caught by what only looks like one. They are off
// by the width of their sides, so these come closer from try to try.
bool DirectSolver::Work::pivot_and_hold()
{
    ConeLemke pivots(island);
    std::vector<ConeVector> found(best.size());
    for (const int closer : kCloser) {
        if (left <= 0 || !pivots.run(closer)) return false;
        for (std::size_t i = 0; i < found.size(); ++i) found[i] = island.cones[i].impulse;
        if (hold_from_here() || answer.residual < effort.enough) return true;
        for (std::size_t i = 0; i < found.size(); ++i) island.cones[i].impulse = found[i];
        if (sweep_and_hold()) return true;
        for (std::size_t i = 0; i < found.size(); ++i) island.cones[i].impulse = found[i];
    }
    return false;
}

// From the impulses in the cones.
bool DirectSolver::Work::take_springs(int most)
{
    most = std::min(most, left);
    left -= most;
    const double residual =
        ConeAugmentedLagrangian(island, matrix).run(done(), effort.enough, most);
    left += most;
    return keep_if_better(residual) || answer.residual < effort.enough;
}

// The path leads to the middle of all answers, whatever it starts from. Where it stalls each way is
// surer than the one before, and slower.
void DirectSolver::Work::find()
{
    if (start_from_guess()) return;
    if (follow_path()) return;
    go_back_to_best();
    if (sweep_and_hold()) return;
    go_back_to_best();
    if (solvable) {
        if (take_springs(left / 2) || (effort.pivots && pivot_and_hold())) return;
        go_back_to_best();
    }
    if (take_springs(left)) return;
    for (ContactCone& cone : island.cones) cone.impulse = {};
    take_springs(left);
}

// Where the steps have run out beside the answer some more lead there, from the best so far.
void DirectSolver::Work::polish()
{
    if (kept == 0 || !(answer.residual > kDirectResidual)) return;
    left += std::exchange(kept, 0);
    go_back_to_best();
    if (sweep_and_hold()) return;
    go_back_to_best();
    take_springs(left);
}

// Where steps run out along the path, its impulses are nobody's answer, and may give energy. What
// they only take too much of is left: sweeps come nearer to the law and let more sink in.
void DirectSolver::Work::sweep_what_throws()
{
    if (!(answer.residual > kThrows)) return;
    go_back_to_best();
    if (!(island.work(scratch) > 0)) return;
    ConeGaussSeidel(island).run(kLastSweeps);
    keep_if_better(island.residual(scratch));
}

DirectSolver::DirectSolver() : work_(std::make_unique<Work>()) { }
DirectSolver::~DirectSolver() = default;
DirectSolver::DirectSolver(DirectSolver&&) noexcept = default;
DirectSolver& DirectSolver::operator=(DirectSolver&&) noexcept = default;

DirectAnswer DirectSolver::solve(std::span<DirectBody> bodies,
                                 std::span<DirectPoint> points,
                                 const DirectEffort& effort)
{
    Work& work = *work_;
    work.answer = {};
    const bool finite = is_finite(bodies, points);
    if (!finite || !work.island.take(bodies, points)) {
        for (DirectPoint& point : points) point.impulse = point.torque = Vec3::Zero();
        if (!finite) work.answer.residual = kInfinite;
        return work.answer;
    }
    work.best.assign(work.island.cones.size(), ConeVector{});
    work.answer.residual = kInfinite;
    work.effort = effort;
    work.kept = effort.pivots ? effort.steps / 2 : 0;
    work.left = effort.steps - work.kept;
    work.solvable = std::all_of(points.begin(), points.end(),
                                [](const DirectPoint& point) { return !(point.least > 0); });
    work.find();
    work.polish();
    work.sweep_what_throws();
    work.go_back_to_best();
    work.island.give(bodies, points);
    if (!is_finite(bodies, points)) work.answer.residual = kInfinite;
    work.answer.steps = effort.steps - work.left - work.kept;
    return work.answer;
}

}  // namespace throng
