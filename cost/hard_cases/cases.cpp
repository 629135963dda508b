#include "cost/hard_cases/cases.hpp"

#include "cost/hard_cases/hard_cases.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"
#include "throng/energy_ledger.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <utility>

namespace throng {

namespace {

constexpr HardCase kCases[] = {
    {"H1", "free tops turn as they should, by every integrator and rotation", case_free_top,
     Fault::spin},
    {"H2", "a top that flips keeps what should be kept for a hundred periods", case_long_flight,
     Fault::spin},
    {"H3", "a heavy top on a pivot nods in cusps", case_heavy_top, Fault::spin},
    {"H4", "a sleeping top stands or falls, either side of the limit", case_sleeping_top,
     Fault::spin},
    {"H5", "spinning fast: what one step turns by, and what many do", case_high_spin, Fault::spin},
    {"H6", "rotations stay rotations for millions of steps", case_rotation_drift, Fault::spin},
    {"H7", "boxes fly along their parabolas", case_ballistic, Fault::spin},
    {"H8", "a stack of equal boxes comes to rest and weighs what it weighs", case_stack,
     Fault::mass},
    {"H9", "heavy boxes rest on light ones", case_mass_ratio, Fault::mass},
    {"H10", "houses of cards stand, and tents either side of the limit", case_cards,
     Fault::friction},
    {"H11", "arches stand", case_arch, Fault::mass},
    {"H12", "a box slides to rest where Coulomb says, and straight", case_sliding, Fault::friction},
    {"H13", "a box on a slope sticks or slides, either side of the limit", case_slope_limit,
     Fault::friction},
    {"H14", "balls slip, then roll", case_rolling, Fault::friction},
    {"H15", "balls bounce as spin, friction and time have it", case_spin_bounce, Fault::friction},
    {"H16", "piles of balls: they overlap little, and keep their energy where they bounce",
     case_pile_of_balls, Fault::overlap},
    {"H17", "impacts pass through touching balls, by either law", case_cradle, Fault::mass},
    {"H18", "a billiard break is mirrored and loses nothing", case_break, Fault::mass},
    {"H19", "a coin rolls round on its rim, and one that is spun comes to lie", case_euler_disk,
     Fault::haste},
    {"H20", "a row of dominoes falls piece by piece, at one speed", case_dominoes, Fault::haste},
    {"H21",
     "rods slid where no law of motion holds, and rods whose ends strike in turn, come to rest",
     case_painleve, Fault::mass},
    {"H22", "logs and ladders stand or fall, either side of the limit", case_leaning,
     Fault::friction},
    {"H23", "a ball strikes a free rod, a block slides down a free wedge, and a rod tips",
     case_struck_rod, Fault::mass},
    {"H24", "a block on a turntable holds or slides, either side of the limit", case_turntable,
     Fault::friction},
    {"H25", "a tower of planks stands", case_planks, Fault::mass},
    {"H26", "a scene told in another way moves in the same way", case_invariance, Fault::unsteady},
    {"H28", "pairs that broke real libraries, at three scales and both ways round",
     case_broken_pairs, Fault::nudge},
    {"H29", "boxes a hair apart, touching and a hair overlapped", case_kissing, Fault::nudge},
    {"H30", "degenerate hulls are refused or answer as the clean one does", case_degenerate_hulls,
     Fault::nudge},
    {"H31", "needles and plates a million times longer than thick", case_slender, Fault::nudge},
    {"H32", "answers grow with the scale, and by nothing else", case_scaled, Fault::nudge},
    {"H33", "far from the origin a stack rests and pairs answer as they do at the origin",
     case_far_away, Fault::float_poses},
    {"H34", "boxes all but parallel: normals follow the tilt, contacts are whole",
     case_near_parallel, Fault::nudge},
    {"H35", "shapes about one center leave by the shortest way", case_concentric, Fault::nudge},
    {"H36", "the volume that two polytopes share", case_shared_volume, Fault::nudge},
    {"H37", "accelerations change the time and never the answer", case_same_answers, Fault::nudge},
    {"H38", "a bullet never comes through a plate, nor through a sheet", case_bullet_plate,
     Fault::late},
    {"H39", "a rod that turns by 150 degrees in a step meets the wall", case_spinning_rod,
     Fault::late},
    {"H40", "two fast bodies meet, graze or miss as they should", case_fast_pair, Fault::late},
    {"H41", "a ball strikes the next, and that the next, all in one step", case_backed_up,
     Fault::overlap},
    {"H42", "exact queries of public sets: no touch is missed", case_exact_paths, Fault::late},
    {"H43", "holes are gone through, chains hold and a bolt turns down its nut", case_through_hole,
     Fault::shrink},
    {"H44", "heaps of scans and lumps come to rest and hardly overlap", case_solid_heap,
     Fault::shrink},
    {"H45", "shared volumes and depths converge as they should", case_convergence, Fault::shrink},
    {"H46",
     "springs swing wider beyond the limit of who asked for it, which is told, and not within",
     case_spring_limit, Fault::stiffness},
    {"H47", "bodies made inside one another part slowly, and come to rest", case_recovery,
     Fault::haste},
    {"H48", "a tower stands without a touch, and what that costs", case_no_overlap, Fault::overlap},
    {"H71", "heaps of sticks, plates and slivers fall, and make no energy", case_sticks,
     Fault::haste},
    {"H74", "thin bodies that tip over win no energy", case_thin_falls, Fault::float_poses},
    {"H75", "slender bars that only turn are stopped by what they swing down on", case_slender_bars,
     Fault::float_poses},
    {"H80", "hulls with finely rounded rims come to rest, and sink into nothing", case_round_rims,
     Fault::float_poses},
    {"H81", "floors of tiles take no speed, and steps do", case_tiles, Fault::friction},
    {"H73", "what loses nothing in a closed room keeps its energy", case_closed_room,
     Fault::restitution},
    {"H77", "a ball that slides through its bounce is slowed by all that presses it",
     case_sliding_bounce, Fault::friction},
    {"H72", "springs on bodies in contact keep their swing and make no energy, however stiff",
     case_springs_in_contact, Fault::stiffness},
    {"H78", "springs on what turns fast, and pivots in contact, make no energy", case_fast_arms,
     Fault::haste},
    {"H82", "an open mesh holds from both sides, a closed one keeps out", case_both_sides,
     Fault::shrink},
    {"H83",
     "balls leave a hit as they touched, rough hits make no energy, heaps of balls lie still",
     case_hits_and_rest, Fault::restitution},
    {"H84", "plates that turn carry round what lies on them", case_carried_round, Fault::friction},
    {"H76", "heavy boxes on light ones, dice, cylinders and cards stand by the default dials",
     case_heavy_on_light, Fault::mass},
    {"H85", "walls of bricks stand, as high as soft contacts bear", case_tall_walls, Fault::sink},
    {"H86", "who is driven has the speed that it is driven at, whatever friction bears",
     case_walkers, Fault::haste},
    {"H87", "thin solids that a fall drives through one another are thrown by nothing",
     case_wedged_solids, Fault::haste},
    {"H88", "what falls on something light and bounces off nothing is thrown back by nothing",
     case_crushed, Fault::haste},
    {"H89", "who bounces wins nothing, whatever acts besides gravity", case_forced_bounces,
     Fault::haste},
    {"H90", "a column that falls on a floor and bounces off nothing stays there",
     case_landing_columns, Fault::haste},
    {"H91", "small bodies of unlike weight that fall as a column make no energy",
     case_small_columns, Fault::haste},
    {"H92", "stacks near attractors and on springs come to rest, and swings stay",
     case_rest_under_forces, Fault::haste},
    {"H93", "what is round rolls along at the same speed on a floor of any kind",
     case_rolling_along, Fault::haste},
    {"H94", "small hulls of many sides stay on a floor of any kind", case_pebbles, Fault::sink},
    {"H95", "who falls flat comes up flat, on however many shapes", case_flat_bounces,
     Fault::restitution},
    {"H96", "bodies that fall together to an attractor make no energy", case_attracted_heaps,
     Fault::haste},
    {"H97", "chains of links hold, hung and swung", case_link_chains, Fault::sink},
    {"H98", "what swings on a contact keeps its swing", case_swings, Fault::haste},
    {"H99", "what slides or rolls in a bent mesh loses what its edges take", case_bent_tracks,
     Fault::haste},
    {"H100", "heaps that land lie still by little more than usual work", case_landed_heaps,
     Fault::sink},
    {"H101", "what tumbles beside a wall keeps energy and momentum", case_near_walls, Fault::whirl},
    {"pairs", "every two values of dials run together, on any number of threads", case_dial_pairs,
     Fault::float_poses},
};

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

void CaseBench::run(const Scene& scene,
                    double time,
                    const std::function<bool(World&, double)>& watch,
                    EnergyLedger* ledger)
{
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    Scene planted = scene;
    plant(fault_, planted);
    World world(planted, threads_);
    EnergyLedger of_default;
    if (ledger == nullptr && listener_.energy && by_default(scene.settings)) ledger = &of_default;
    const double dt = scene.settings.dt;
    const int steps = static_cast<int>(std::llround(time / dt));
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
    if (listener_.energy && ledger != nullptr && by_default(scene.settings)) enter_energy(*ledger);
    lost_ += world.report().bodies_quarantined;
    missed_ = std::max(missed_, world.report().direct_residual);
    spent_ms_ += std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void CaseBench::inspect(const Scene& scene, const std::function<void(const World&)>& look)
{
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    Scene planted = scene;
    plant(fault_, planted);
    look(World(planted, threads_));
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
                               const std::string& met_by)
{
    CaseResult result =
        judged(std::move(setting), std::move(quantity), figure, bound, std::move(unit));
    if (result.verdict == Verdict::fail && result.why.empty()) {
        result.verdict = Verdict::missed;
        result.why = "met by " + met_by;
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

std::span<const HardCase> hard_cases() { return kCases; }

const HardCase* find_case(std::string_view name)
{
    const auto same = [](char a, char b) {
        return std::toupper(static_cast<unsigned char>(a))
            == std::toupper(static_cast<unsigned char>(b));
    };
    for (const HardCase& one : kCases)
        if (std::equal(name.begin(), name.end(), one.name.begin(), one.name.end(), same))
            return &one;
    return nullptr;
}

std::vector<CaseResult> run_case(const HardCase& which,
                                 Settings settings,
                                 Fault fault,
                                 int threads,
                                 Extent extent,
                                 CaseListener listener)
{
    return CaseBench(settings, fault, threads, extent, std::move(listener)).run(which);
}

}  // namespace throng
