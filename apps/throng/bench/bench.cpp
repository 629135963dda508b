// Bench: times catalogue scenes of several sizes on several numbers of threads, beside other
// engines.
#include "apps/throng/bench/peers.hpp"
#include "apps/throng/bench/report.hpp"
#include "apps/throng/commands.hpp"
#include "apps/throng/interrupt.hpp"
#include "apps/throng/output_file.hpp"
#include "apps/throng/scene_argument.hpp"
#include "apps/throng/trace_option.hpp"

#include <iostream>

namespace throng {
namespace {

using bench::Case;
using bench::EngineKind;
using bench::Plan;
using bench::PlannedScene;
using bench::ThrongRun;

std::vector<Option> all_options()
{
    std::vector<Option> options(bench::plan_options().begin(), bench::plan_options().end());
    options.push_back({"--json", "FILE.json", "every figure, and the time of every step"});
    options.push_back(kTraceOption);
    options.push_back(kTraceStepsOption);
    return options;
}

/// Throng on each number of threads, by each width of its kernels, with each value of a dial that
/// is varied, then the peers that are to be had; the plan's are those.
std::vector<EngineKind> engines_of(Plan& plan, TraceOption* trace)
{
    std::vector<EngineKind> kinds;
    const auto or_none = [](const std::vector<std::string>& list) {
        return list.empty() ? std::vector<std::string>{""} : list;
    };
    for (const int threads : plan.threads)
        for (const std::string& width : or_none(plan.lanes))
            for (const std::string& value : or_none(plan.varied.values)) {
                ThrongRun run{threads, 0, trace, width, plan.varied.dial, value};
                kinds.push_back(bench::throng_engine(run));
                if (!plan.efficiency || threads == 1) continue;
                run.threads = 1;
                run.beside = threads - 1;
                kinds.push_back(bench::throng_engine(run));
            }
    std::vector<EngineKind> peers = bench::peer_engines(plan.peers, plan.peers_asked_for);
    plan.peers.clear();
    for (EngineKind& peer : peers) {
        plan.peers.push_back(peer.name);
        kinds.push_back(std::move(peer));
    }
    for (const bench::PeerAt& at : plan.peers_at) {
        plan.peers.push_back(at.name);
        for (EngineKind& peer : bench::engines_at(at, plan.threads))
            kinds.push_back(std::move(peer));
    }
    return kinds;
}

int run_bench(const Options& options)
{
    Plan plan = bench::read_plan(options);
    if (options.has("--trace")
        && planned_scenes(plan, 1).size() * plan.threads.size()
                * std::max<std::size_t>(1, plan.varied.values.size())
                * std::max<std::size_t>(1, plan.lanes.size()) * (plan.efficiency ? 2 : 1)
            != 1)
        throw BadInput(
            "--trace: is of one run; give one scene, one of --sizes, one of --threads "
            "and no more than one value to --dt, --lanes and --vary, and no --efficiency");
    const MeshOption mesh(options);
    for (const CatalogEntry* entry : plan.scenes) mesh.check(*entry);
    plan.mesh = mesh.file();
    Scene unused;
    set_dials(unused, options);  // refused now rather than at the first scene
    TraceOption trace(options);
    const std::vector<EngineKind> kinds = engines_of(plan, trace.asked_for() ? &trace : nullptr);
    note_interrupts();
    OutputFile json("--json", options.text("--json"));
    refuse_same_file(trace.file(), json.path(), "--json");
    refuse_same_file(json, plan.mesh, "--mesh");
    refuse_same_file(trace.file(), plan.mesh, "--mesh");
    const bool tables = !json.is_stdout() && !trace.file().is_stdout();
    if (tables) bench::print_heading(plan, std::cout);

    const std::vector<PlannedScene> planned = planned_scenes(plan, unused.settings.dt);
    std::int64_t steps = 0;
    for (const PlannedScene& one : planned) steps += one.steps;
    const std::int64_t runs = plan.repeats + (plan.errors ? 1 : 0);
    Progress progress(static_cast<std::int64_t>(kinds.size()) * runs * steps, true);
    std::int64_t steps_done = 0;
    std::vector<Case> cases;
    bool agree = true;
    for (const PlannedScene& one : planned) {
        if (interrupted()) break;
        Scene scene = mesh.make(*one.entry, one.size, plan.seed);
        scene.settings.sleep = false;  // what has come to rest is to be timed, too
        set_dials(scene, options);
        scene.settings.dt = one.dt;
        cases.push_back(bench::run_case(plan, one, scene, kinds, progress, steps_done));
        progress.clear();
        if (tables) bench::print_case(plan, cases.back(), std::cout);
        agree = agree && bench::hashes_agree(cases.back());
    }
    if (tables) bench::print_growth(bench::growth_of(cases), std::cout);
    if (json.asked_for()) bench::write_json(plan, cases, !interrupted(), json.stream());
    json.keep();
    if (interrupted()) return kInterrupted;
    if (!agree) std::cerr << "error: runs of the same steps came to different states" << std::endl;
    return agree ? kDone : kCaseFailed;
}

}  // namespace

const Command kBench = {
    {"bench", "", "Times scenes of the catalogue, and other engines on the same scenes.", 0, 0,
     [] {
         static const std::vector<Option> kOptions = all_options();
         return std::span<const Option>(kOptions);
     }()},
    run_bench,
    nullptr,
};

}  // namespace throng
