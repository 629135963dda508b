// Case bench: runs the scenes of a case, and judges its lines.
#include "cost/hard_cases/cases.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace throng {

namespace {

constexpr double kShrunk = 0.9;
constexpr double kEnergyGained = 1e-3;  // of the greatest kinetic energy

void shrink(ShapeDescription& shape)
{
    if (auto* mesh = std::get_if<MeshShape>(&shape.shape))
        for (Vec3& vertex : mesh->vertices) vertex *= kShrunk;
}

// Where a question is asked of them, not what stands in a scene.
ShapeDescription shrunk(ShapeDescription shape)
{
    shrink(shape);
    if (auto* sphere = std::get_if<SphereShape>(&shape.shape)) sphere->radius *= kShrunk;
    if (auto* box = std::get_if<BoxShape>(&shape.shape)) box->half_extents *= kShrunk;
    return shape;
}

void scale_friction(Scene& scene, double by)
{
    for (Material& material : scene.materials) material.friction *= by;
    for (MaterialPairDescription& pair : scene.pairs)
        if (pair.friction) *pair.friction *= by;
}

void plant(Fault fault, Scene& scene)
{
    switch (fault) {
    case Fault::friction:
        scale_friction(scene, 0.9);
        break;
    case Fault::grip:
        scale_friction(scene, 1.1);
        break;
    case Fault::restitution:
        for (Material& material : scene.materials) material.restitution *= 0.9;
        break;
    case Fault::mass:
        for (BodyDescription& body : scene.bodies)
            if (body.mass) *body.mass *= 1.1;
        break;
    case Fault::spin:
        for (BodyDescription& body : scene.bodies) body.angular_velocity *= 1.05;
        break;
    case Fault::stiffness:
        for (Spring& spring : scene.springs) spring.stiffness *= 1.1;
        break;
    case Fault::overlap:
        scene.settings.overlap = Overlap::allow;
        break;
    case Fault::shrink:
        for (ShapeDescription& shape : scene.shapes) shrink(shape);
        break;
    default:
        break;
    }
}

Vec3 rounded(const Vec3& place) { return place.cast<float>().cast<double>(); }

template <class Place>
void place_anew(World& world, const Place& place)
{
    for (const BodyId body : world.bodies()) {
        if (world.motion(body) != Motion::dynamic) continue;
        Pose pose = world.pose(body);
        pose.position = place(pose.position);
        world.set_pose(body, pose);
    }
}

void round_poses(World& world) { place_anew(world, rounded); }

constexpr double kHaste = 1.05;

// Of who moves by itself.
template <class Change>
void change_velocities(World& world, const Change& change)
{
    for (const BodyId body : world.bodies()) {
        if (world.motion(body) != Motion::dynamic) continue;
        Vec3 velocity = world.velocity(body), spin = world.angular_velocity(body);
        change(velocity, spin);
        world.set_velocity(body, velocity, spin);
    }
}

void hasten(World& world)
{
    change_velocities(world, [](Vec3& velocity, Vec3& spin) {
        velocity *= kHaste;
        spin *= kHaste;
    });
}

void whirl(World& world)
{
    change_velocities(world, [](Vec3&, Vec3& spin) { spin += Vec3::UnitZ(); });
}

void shift_poses(World& world, double by)
{
    place_anew(world, [&](const Vec3& at) -> Vec3 { return at + Vec3::Constant(by); });
}

void sink(World& world)
{
    const Vec3 down = world.gravity().normalized();  // zero stays zero
    place_anew(world, [&](const Vec3& at) -> Vec3 { return at + 1e-3 * down; });
}

constexpr double kSkew = 1e-6;  // m and m/s, times a body's place in the list

void skew(World& world)
{
    double by = 0;
    place_anew(world, [&](const Vec3& at) -> Vec3 { return at + Vec3::Constant(by += kSkew); });
    by = 0;
    change_velocities(world,
                      [&](Vec3& velocity, Vec3&) { velocity += Vec3::Constant(by += kSkew); });
}

// Aslant, so that no face of a pair lets it pass.
Pose nudged(const Pose& pose, double size)
{
    const Vec3 aslant = Vec3(0.5, 0.6, 0.62);
    return {pose.position + 1e-6 * size * aslant, pose.orientation * exponential(1e-6 * aslant)};
}

// Whether nobody chose another value than the default, but for the step and for sleep.
bool by_default(Settings settings)
{
    settings.dt = Settings().dt;
    settings.sleep = Settings().sleep;
    return std::all_of(dials().begin(), dials().end(), [&](const Dial& dial) {
        return dial_value(settings, dial.name) == dial_value(Settings(), dial.name);
    });
}

std::string name_of(ToiMethod method)
{
    Settings settings;
    settings.toi_method = method;
    return dial_value(settings, "toi_method");
}

}  // namespace

CaseBench::CaseBench(
    Settings settings, Fault fault, int threads, Extent extent, CaseListener listener)
    : settings_(settings), fault_(fault), threads_(threads), extent_(extent),
      listener_(std::move(listener))
{ }

void CaseBench::stop_where_enough() const
{
    if (listener_.enough()) throw Stopped();
}

void CaseBench::keep(CaseResult result)
{
    result.name = name_;
    listener_.line(result);
    results_.push_back(std::move(result));
    stop_where_enough();
}

std::vector<CaseResult> CaseBench::run(const HardCase& which)
{
    name_ = which.name;
    try {
        which.run(*this);
        if (energy_runs_ > 0) report_energy();
    } catch (const Stopped&) {
        // What came before it stands.
    }
    return std::move(results_);
}

void CaseBench::enter_energy(const EnergyLedger& ledger)
{
    ++energy_runs_;
    const EnergyOfRun run{ledger.gained(), ledger.greatest_kinetic(), {}};
    if (run.is_worse_than(energy_)) energy_ = run;
}

void CaseBench::fold_energy(const std::string& setting)
{
    if (energy_.is_worse_than(worst_energy_)) {
        worst_energy_ = energy_;
        worst_energy_.setting = setting;
    }
    energy_ = {};
}

void CaseBench::report_energy()
{
    fold_energy("after the last line");
    std::string runs = std::to_string(energy_runs_) + " runs by default";
    const auto& [gained, kinetic, setting] = worst_energy_;
    if (gained > 0)
        runs += ", worst: " + setting + ", " + number_text(gained) + " of " + number_text(kinetic)
            + " J";
    report(runs, "energy nobody gave, beside the greatest kinetic",
           gained > 0 ? gained / kinetic : 0, kEnergyGained, "1");
}

Scene CaseBench::scene() const
{
    Scene scene;
    scene.settings = settings_;
    return scene;
}

Scene CaseBench::as_run(const Scene& scene) const
{
    Scene by = forced_.empty() ? scene : changed(scene, forced_);
    plant(fault_, by);
    return by;
}

void CaseBench::run(const Scene& scene,
                    double time,
                    const std::function<bool(World&, double)>& watch,
                    EnergyLedger* ledger)
{
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const Scene by = as_run(scene);
    World world(by, threads_);
    EnergyLedger of_default;
    const bool enters = listener_.energy && by_default(scene.settings);
    if (ledger == nullptr && enters) ledger = &of_default;
    const double own_dt = scene.settings.dt, dt = by.settings.dt;
    const double duration = own_dt * static_cast<double>(std::llround(time / own_dt));
    const int steps = static_cast<int>(std::llround(duration / dt));
    step_ms_ = steps_ = 0;
    ++runs_;
    for (int step = 1; step <= steps; ++step) {
        if (ledger != nullptr) ledger->before_step(world);
        world.step();
        step_ms_ += world.report().time_ms;
        ++steps_;
        if (fault_ == Fault::float_poses) round_poses(world);
        if (fault_ == Fault::haste) hasten(world);
        if (fault_ == Fault::unsteady) shift_poses(world, 1e-8 * runs_);
        if (fault_ == Fault::sink) sink(world);
        if (fault_ == Fault::skew) skew(world);
        if (fault_ == Fault::whirl) whirl(world);
        if (ledger != nullptr) ledger->after_step(world);
        stop_where_enough();
        if (!watch(world, step * dt)) break;
    }
    if (enters) enter_energy(*ledger);
    const std::size_t lost = world.report().bodies_quarantined;
    lost_ += lost;
    missed_ = std::max(missed_, world.report().direct_residual);
    listener_.ran({by, duration, steps_ * dt, step_ms_, lost});
    spent_ms_ += std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void CaseBench::inspect(const Scene& scene, const std::function<void(const World&)>& look)
{
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    look(World(as_run(scene), threads_));
    spent_ms_ += std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

CaseResult CaseBench::judged(
    std::string setting, std::string quantity, double figure, double bound, std::string unit)
{
    CaseResult result;
    result.setting = std::move(setting);
    result.quantity = std::move(quantity);
    result.figure = figure;
    result.bound = bound;
    result.unit = std::move(unit);
    // A figure that is not a number is no pass; nor is one that a body taken out of the run is in,
    // or of contacts that missed their law.
    const bool missed = missed_ > kMissedResidual;
    result.verdict = figure <= bound && lost_ == 0 && !missed ? Verdict::pass : Verdict::fail;
    if (missed) result.why = "residual of solver direct: " + number_text(missed_);
    if (lost_ > 0) result.why = "bodies quarantined: " + std::to_string(lost_);
    lost_ = 0;
    missed_ = 0;
    fold_energy(result.setting);
    result.time_ms = spent_ms_;
    spent_ms_ = 0;
    return result;
}

void CaseBench::report(
    std::string setting, std::string quantity, double figure, double bound, std::string unit)
{
    keep(judged(std::move(setting), std::move(quantity), figure, bound, std::move(unit)));
}

void CaseBench::report_default(std::string setting,
                               std::string quantity,
                               double figure,
                               double bound,
                               std::string unit,
                               std::string_view met_by)
{
    CaseResult result =
        judged(std::move(setting), std::move(quantity), figure, bound, std::move(unit));
    if (result.verdict == Verdict::fail && result.why.empty() && !met_by.empty()) {
        result.verdict = Verdict::missed;
        result.why = "met by " + std::string(met_by);
    }
    keep(std::move(result));
}

void CaseBench::show(std::string setting, std::string quantity, double figure, std::string unit)
{
    CaseResult result = judged(std::move(setting), std::move(quantity), figure, 0, std::move(unit));
    result.verdict = Verdict::shown;
    if (result.why.empty()) result.why = "measured, held to nothing";
    keep(std::move(result));
}

void CaseBench::report_time(std::string setting, std::string quantity, double ns)
{
    if (!brief()) show(std::move(setting), std::move(quantity), ns, "ns");
}

ConvexAnswer CaseBench::ask(ConvexQuery& query,
                            std::string_view method,
                            const Pose& a,
                            const Pose& b,
                            double size,
                            MethodStart start)
{
    return timed(method, a, b, size,
                 [&](const Pose& seen) { return query.ask(method, seen, start); });
}

ConvexAnswer CaseBench::touch(
    const ConvexQuery& query, Precision precision, const Pose& a, const Pose& b, double size)
{
    return timed("auto", a, b, size,
                 [&](const Pose& seen) { return query.touch(seen, precision); });
}

VolumeAnswer CaseBench::ask_volume(std::string_view way,
                                   const ShapeDescription& a,
                                   const ShapeDescription& b,
                                   const Pose& b_in_a,
                                   int resolution)
{
    using Clock = std::chrono::steady_clock;
    stop_where_enough();
    const bool small = fault_ == Fault::shrink;
    VolumeQuery query(small ? shrunk(a) : a, small ? shrunk(b) : b);
    const auto begin = Clock::now();
    VolumeAnswer answer = query.ask(way, b_in_a, resolution);
    spent_ms_ += std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    return answer;
}

ImpactAnswer CaseBench::timed_impact(ToiMethod method, const std::function<ImpactAnswer()>& asked)
{
    stop_where_enough();
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    ImpactAnswer answer = asked();
    method_ms_[name_of(method)] +=
        std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    if (fault_ != Fault::late) return answer;
    answer.time *= 1.01;
    answer.meets = answer.meets && !answer.touching;
    return answer;
}

ImpactAnswer CaseBench::ask_impact(const ImpactQuery& query,
                                   ToiMethod method,
                                   const ShapeMotion& a,
                                   const ShapeMotion& b,
                                   double duration)
{
    return timed_impact(method,
                        [&] { return query.ask(a, b, duration, method, settings_.toi_tolerance); });
}

ImpactAnswer
CaseBench::ask_linear_paths(const LinearQuestion& question, ToiMethod method, double tolerance)
{
    return timed_impact(method,
                        [&] { return throng::ask_linear_paths(question, method, tolerance); });
}

ConvexAnswer CaseBench::timed(std::string_view method,
                              const Pose& a,
                              const Pose& b,
                              double size,
                              const std::function<ConvexAnswer(const Pose&)>& asked)
{
    stop_where_enough();
    using Clock = std::chrono::steady_clock;
    Pose at_a = a, at_b = b;
    if (fault_ == Fault::nudge) at_b = nudged(at_b, size);
    if (fault_ == Fault::float_poses) {
        at_a.position = rounded(at_a.position);
        at_b.position = rounded(at_b.position);
    }
    const auto begin = Clock::now();
    ConvexAnswer answer = asked(seen_from(at_a, at_b));
    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    const auto spent = method_ms_.find(method);
    if (spent != method_ms_.end())
        spent->second += ms;
    else
        method_ms_.emplace(method, ms);
    return answer;
}

void CaseBench::report_method(std::string_view method,
                              std::string_view setting,
                              std::string quantity,
                              double figure,
                              double bound,
                              std::string unit)
{
    const std::string where(setting);
    CaseResult result = judged(std::string(method) + (where.empty() ? "" : ", " + where),
                               std::move(quantity), figure, bound, std::move(unit));
    result.method = method;
    result.time_ms = std::exchange(method_ms_[std::string(method)], 0);
    keep(std::move(result));
}

double CaseBench::spent_on(std::string_view method) const
{
    const auto spent = method_ms_.find(method);
    return spent == method_ms_.end() ? 0 : spent->second;
}

void CaseBench::skip(std::string setting, std::string quantity, std::string why)
{
    CaseResult result;
    result.setting = std::move(setting);
    result.quantity = std::move(quantity);
    result.verdict = Verdict::skipped;
    result.why = std::move(why);
    keep(std::move(result));
}

}  // namespace throng
