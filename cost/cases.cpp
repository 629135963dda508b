#include "cost/cases.hpp"

#include "cost/hard_cases/hard_cases.hpp"
#include "pipeline/world.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>

namespace throng {

namespace {

constexpr HardCase kCases[] = {
    {"H8", "a stack of equal boxes comes to rest and weighs what it weighs", case_stack,
     Fault::mass},
    {"H12", "a box slides to rest where Coulomb says, and straight", case_sliding, Fault::friction},
    {"H13", "a box on a slope sticks or slides, either side of the limit", case_slope_limit,
     Fault::friction},
    {"H22", "logs and ladders stand or fall, either side of the limit", case_leaning,
     Fault::friction},
    {"H33", "a stack far from the origin rests as it does at the origin", case_far_away,
     Fault::float_poses},
};

void plant(Fault fault, Scene& scene)
{
    switch (fault) {
    case Fault::friction:
        for (Material& material : scene.materials) material.friction *= 0.9;
        for (MaterialPair& pair : scene.pairs)
            if (pair.friction) *pair.friction *= 0.9;
        break;
    case Fault::mass:
        for (BodyDescription& body : scene.bodies)
            if (body.mass) *body.mass *= 1.1;
        break;
    default:
        break;
    }
}

void round_poses(World& world)
{
    for (const BodyId body : world.bodies()) {
        if (world.motion(body) != Motion::dynamic) continue;
        Pose pose = world.pose(body);
        pose.position = pose.position.cast<float>().cast<double>();
        world.set_pose(body, pose);
    }
}

}  // namespace

CaseBench::CaseBench(Settings settings, Fault fault, int threads)
    : settings_(settings), fault_(fault), threads_(threads)
{ }

Scene CaseBench::scene() const
{
    Scene scene;
    scene.settings = settings_;
    return scene;
}

void CaseBench::run(const Scene& scene,
                    double time,
                    const std::function<bool(World&, double)>& watch)
{
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    Scene planted = scene;
    plant(fault_, planted);
    World world(planted, threads_);
    const double dt = scene.settings.dt;
    const int steps = static_cast<int>(std::llround(time / dt));
    for (int step = 1; step <= steps; ++step) {
        world.step();
        if (fault_ == Fault::float_poses) round_poses(world);
        if (!watch(world, step * dt)) break;
    }
    lost_ += world.report().bodies_quarantined;
    spent_ms_ += std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void CaseBench::report(
    std::string setting, std::string quantity, double figure, double bound, std::string unit)
{
    CaseResult result;
    result.setting = std::move(setting);
    result.quantity = std::move(quantity);
    result.figure = figure;
    result.bound = bound;
    result.unit = std::move(unit);
    // A figure that is not a number is no pass; nor is one that a body taken out of the run is in.
    result.verdict = figure <= bound && lost_ == 0 ? Verdict::pass : Verdict::fail;
    if (lost_ > 0) result.why = "bodies quarantined: " + std::to_string(lost_);
    lost_ = 0;
    result.time_ms = spent_ms_;
    spent_ms_ = 0;
    results_.push_back(std::move(result));
}

std::vector<CaseResult> CaseBench::take_results(std::string_view name)
{
    for (CaseResult& result : results_) result.name = name;
    return std::move(results_);
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

std::vector<CaseResult> run_case(const HardCase& which, Settings settings, Fault fault, int threads)
{
    CaseBench bench(settings, fault, threads);
    which.run(bench);
    return bench.take_results(which.name);
}

}  // namespace throng
