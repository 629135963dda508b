#include "cost/windows/windows.hpp"

#include "cost/changes.hpp"
#include "cost/clock.hpp"
#include "cost/windows/laws.hpp"
#include "kernels/math/hash.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"
#include "throng/energy_ledger.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Bodies from which the run that windows start from is as coarse as the scene's own: it is the
// longest of all, and any states that the scene comes by will do.
constexpr std::size_t kCrowd = 1000;
// The golden ratio: windows lie unlike the beats that a scene may have.
constexpr double kGolden = 0.6180339887498949;
// The longest step of the run that windows start from, and of the reference, whatever the scene's
// own: settings that are compared on two scenes alike but for their step see the same windows.
constexpr double kFine = 1.0 / 480;  // s
constexpr int kMostHalvings = 7;
constexpr double kEnough = 0.1;           // of the error that is wanted
constexpr double kNearer = 0.75;          // what a halving has to bring the change down to
constexpr double kMoves = 1e-6;           // m
constexpr double kNothing = 1e-9;         // m, below which the ends did not move
constexpr std::size_t kStageWindows = 8;  // that stages are timed in

// The ways to the reference.
//
// In short steps soft contacts are stiff, and what overlapped as a window began is driven apart,
// the faster the shorter they are: the push limit keeps that from being all that is seen. And with
// one iteration a substep what an impact comes to goes by the moment of the substep that it falls
// into, however short they are.
const Changes kDirect = {{"solver", "direct"}, {"substeps", "1"}};
const Changes kSweeps = {
    {"solver", "pgs"}, {"iterations", "60"}, {"substeps", "1"}, {"push_limit", "0.02"}};
const Changes kSoft = {
    {"iterations", "8"}, {"relax_iterations", "8"}, {"substeps", "2"}, {"push_limit", "0.02"}};
const Changes kFlight = {{"integrator", "rk4"}, {"substeps", "1"}};
const std::vector<Changes> kOfContacts = {kDirect, kSweeps, kSoft}, kOfFlight = {kFlight};

// What a scene is, and no matter of how exactly it is stepped, stays as the scene has it.
Scene reference_scene(const Scene& scene, const Changes& way, double dt)
{
    const Settings& own = scene.settings;
    Scene by = scene;
    Settings& settings = by.settings = {};
    settings.dt = dt;
    settings.precision = Precision::double_;
    settings.sleep = false;
    settings.escalation = Escalation::off;
    settings.nonconvex = own.nonconvex;
    settings.voxel_size = own.voxel_size;
    settings.image_resolution = own.image_resolution;
    settings.sphere_levels = own.sphere_levels;
    settings.max_parts = own.max_parts;
    settings.friction_cone = own.friction_cone;
    settings.impact_law = own.impact_law;
    return changed(by, way);
}

std::string text_of(const Changes& way, double dt)
{
    Settings settings;
    settings.dt = dt;
    return "precision=double dt=" + dial_value(settings, "dt") + ' ' + throng::text_of(way);
}

int steps_in(double length, double dt) { return static_cast<int>(std::lround(length / dt)); }

}  // namespace

Windows::Windows(
    const Scene& scene, const WindowPlan& plan, double wanted, double patience, const Watch& watch)
    : threads_(plan.threads), watch_(watch)
{
    const double dt = scene.settings.dt;
    length_ = dt * std::max(1.0, std::ceil(plan.length / dt - 1e-9));
    fine_ = length_ / std::max(1.0, std::ceil(length_ / std::min(kFine, dt) - 1e-9));
    find_starts(scene, plan);
    find_reference(scene, wanted, patience);
}

void Windows::check() const
{
    if (watch_.ended && watch_.ended()) throw Interrupted{};
}

// States that the scene comes by, stepped finely.
void Windows::find_starts(const Scene& scene, const WindowPlan& plan)
{
    const bool crowded = scene.bodies.size() > kCrowd;
    const double dt = crowded ? scene.settings.dt : fine_;
    Scene by = reference_scene(scene, kSoft, dt);
    if (crowded) by.settings.precision = Precision::float_;
    World world(by, threads_);
    touches_ = world.effects().on.has(Effect::contact);
    if (touches_)
        geometry_ = std::make_unique<World>(reference_scene(scene, kSoft, fine_), threads_);
    std::int64_t step = 0;
    for (std::size_t k = 0; k < plan.count; ++k) {
        const double part = static_cast<double>(k) * kGolden;
        const double share =
            (static_cast<double>(k) + part - std::floor(part)) / static_cast<double>(plan.count);
        const auto until = static_cast<std::int64_t>(share * plan.seconds / dt);
        for (; step < until; ++step) {
            check();
            world.step();
            if (watch_.show && step % 16 == 0)
                watch_.show("states to start from, "
                            + number_text(std::round(100.0 * static_cast<double>(step) * dt) / 100)
                            + " s of " + number_text(plan.seconds));
        }
        windows_.push_back({static_cast<double>(step) * dt, states_of(world), {}});
    }
}

World Windows::begun(const Scene& scene, std::size_t window) const
{
    World world(scene, threads_);
    put_states(world, windows_[window].start);
    return world;
}

// Empty where they are not there in time.
std::vector<BodyStates> Windows::ends_by(const Scene& scene, double patience) const
{
    const WallClock::time_point begin = WallClock::now();
    std::vector<BodyStates> ends;
    for (std::size_t k = 0; k < windows_.size(); ++k) {
        World world = begun(scene, k);
        for (int step = steps_in(length_, scene.settings.dt); step > 0; --step) {
            check();
            if (seconds_since(begin) > patience) return {};
            world.step();
        }
        ends.push_back(states_of(world));
    }
    return ends;
}

Errors Windows::moved(const std::vector<BodyStates>& from, const std::vector<BodyStates>& to) const
{
    std::vector<Errors> windows(to.size());
    for (std::size_t k = 0; k < to.size(); ++k) compare(from[k], to[k], windows[k]);
    Errors all{};
    for (const Measure each : {Measure::drift, Measure::turn, Measure::velocity})
        of(all, each) = rms(windows, place_of(each));
    return all;
}

// By each way the step is halved once, and by the one whose ends that moved least until they stay
// where they are.
void Windows::find_reference(const Scene& scene, double wanted, double patience)
{
    const WallClock::time_point begin = WallClock::now();
    struct Found {
        Changes way;
        double dt = 0, took = 0;
        std::vector<BodyStates> ends;
        Errors moved{};
    };
    const auto drift_of = [](const Found& found) { return of(found.moved, Measure::drift); };
    const auto ends_of = [&](Found& found, double within) {
        if (watch_.show)
            watch_.show("reference, " + text_of(found.way, found.dt) + ", "
                        + std::to_string(windows_.size()) + " windows");
        const WallClock::time_point since = WallClock::now();
        std::vector<BodyStates> ends = ends_by(reference_scene(scene, found.way, found.dt), within);
        found.took = seconds_since(since);
        return ends;
    };
    Found best;
    const std::vector<Changes>& ways = touches_ ? kOfContacts : kOfFlight;
    for (const Changes& way : ways) {
        Found found{way, fine_, 0, {}, {}};
        // The last has to be had, however long it takes.
        const bool last = &way == &ways.back() && best.ends.empty();
        const double within = last ? std::numeric_limits<double>::infinity() : patience / 8;
        std::vector<BodyStates> before = ends_of(found, within);
        if (before.empty()) continue;
        found.dt /= 2;
        found.ends = ends_of(found, 2 * within);
        if (found.ends.empty()) continue;
        found.moved = moved(before, found.ends);
        if (best.ends.empty() || drift_of(found) < drift_of(best)) best = std::move(found);
        if (drift_of(best) < kNothing) break;
    }
    reference_.settles = true;
    for (int halving = 2; halving <= kMostHalvings; ++halving) {
        if (drift_of(best) < std::max(kNothing, kEnough * wanted)) break;
        // The next takes twice as long.
        if (seconds_since(begin) + 2 * best.took > patience) break;
        Found finer{best.way, best.dt / 2, 0, {}, {}};
        finer.ends = ends_of(finer, std::numeric_limits<double>::infinity());
        finer.moved = moved(best.ends, finer.ends);
        reference_.settles = drift_of(finer) <= std::max(kNothing, kNearer * drift_of(best));
        if (!(drift_of(finer) < drift_of(best))) break;
        best = std::move(finer);
    }
    reference_.remaining = best.moved;
    reference_.settings = text_of(best.way, best.dt);
    for (std::size_t k = 0; k < windows_.size(); ++k)
        windows_[k].reference = std::move(best.ends[k]);
}

std::string Windows::state_hash() const
{
    Hash hash;
    const auto add = [&](const Vec3& vector) {
        for (int k = 0; k < 3; ++k) hash.add(vector[k]);
    };
    for (const Window& window : windows_)
        for (const BodyStates* states : {&window.start, &window.reference})
            for (const BodyState& state : *states) {
                add(state.center);
                add(state.pose.orientation.vec());
                add(state.velocity);
                add(state.spin);
            }
    return hash.text();
}

bool Windows::holds_whole_steps(double dt) const
{
    const double steps = length_ / dt;
    return steps > 0.5 && std::abs(steps - std::round(steps)) < 1e-9 * steps;
}

std::size_t Windows::at_rest() const
{
    return static_cast<std::size_t>(
        std::count_if(windows_.begin(), windows_.end(), [](const Window& window) {
            for (std::size_t i = 0; i < window.start.size(); ++i)
                if ((window.start[i].center - window.reference[i].center).norm() > kMoves)
                    return false;
            return true;
        }));
}

// Of a run that lost a body there is nothing good to tell.
void Windows::measure_laws(const World& world, std::size_t window, Errors& errors) const
{
    const Window& of_window = windows_[window];
    if (std::isinf(of(errors, Measure::drift))) {
        for (const Measure each :
             {Measure::momentum, Measure::complementarity, Measure::friction_cone,
              Measure::missed_contacts, Measure::force_error})
            of(errors, each) = std::numeric_limits<double>::infinity();
        return;
    }
    of(errors, Measure::missed_contacts) = geometry_ ? missed_squared(world, *geometry_) : 0;
    of(errors, Measure::force_error) =
        force_squared(world, resting(of_window.start, of_window.reference));
}

WindowRun Windows::run(const Scene& scene, std::size_t window, double patience) const
{
    World world = begun(scene, window);
    EnergyLedger ledger;
    LawWatch laws;
    const int steps = steps_in(length_, scene.settings.dt), skipped = steps / 3;
    const WorkClock clock(threads_);
    double time_ms = 0, all = 0;
    for (int step = 0; step < steps; ++step) {
        check();
        ledger.before_step(world);
        laws.before_step(world, step == steps - 1);
        const WallClock::time_point waited = WallClock::now();
        const double begin = clock.now();
        world.step();
        const double taken = clock.since(begin);
        all += seconds_since(waited);
        if (all > patience) throw TooSlow{};
        if (step >= skipped) time_ms += 1e3 * taken;
        ledger.after_step(world);
        laws.after_step(world, step == steps - 1);
    }
    WindowRun run;
    compare(states_of(world), windows_[window].reference, run.errors);
    const double overlap = world.measure().greatest_overlap, energy = ledger.gained();
    of(run.errors, Measure::overlap) = overlap * overlap;
    of(run.errors, Measure::energy) = energy * energy;
    laws.put_into(run.errors);
    measure_laws(world, window, run.errors);
    run.time_ms = time_ms * kFrame / (scene.settings.dt * (steps - skipped));
    return run;
}

double Windows::time_ms(const Scene& scene, std::size_t window) const
{
    World world = begun(scene, window);
    const int steps = steps_in(length_, scene.settings.dt), skipped = steps / 3;
    for (int step = 0; step < skipped; ++step) world.step();
    check();
    const WorkClock clock(threads_);
    const double begin = clock.now();
    for (int step = skipped; step < steps; ++step) world.step();
    return 1e3 * clock.since(begin) * kFrame / (scene.settings.dt * (steps - skipped));
}

std::vector<StageTime> Windows::stage_times(const Scene& scene) const
{
    std::vector<StageTime> stages;
    const std::size_t count = std::min(kStageWindows, windows_.size());
    const int steps = steps_in(length_, scene.settings.dt), skipped = steps / 3;
    const double share =
        kFrame / (scene.settings.dt * (steps - skipped) * static_cast<double>(count));
    for (std::size_t k = 0; k < count; ++k) {
        World world = begun(scene, k * windows_.size() / count);
        for (int step = 0; step < steps; ++step) {
            check();
            world.step();
            if (step < skipped) continue;
            // Stages come with what calls for them, and go.
            for (const StageReport& of : world.stages()) {
                const auto found =
                    std::find_if(stages.begin(), stages.end(),
                                 [&](const StageTime& each) { return each.name == of.name; });
                if (found == stages.end())
                    stages.push_back({std::string(of.name), share * of.time_ms});
                else
                    found->time_ms += share * of.time_ms;
            }
        }
    }
    return stages;
}

}  // namespace throng
