// Run: simulates a scene and writes what came of it.
#include "apps/throng/commands.hpp"
#include "apps/throng/events_option.hpp"
#include "apps/throng/interrupt.hpp"
#include "apps/throng/output_file.hpp"
#include "apps/throng/progress.hpp"
#include "apps/throng/run_frames.hpp"
#include "apps/throng/run_stats.hpp"
#include "apps/throng/scene_argument.hpp"
#include "apps/throng/trace_option.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"
#include "throng/final_csv.hpp"
#include "throng/run_file.hpp"

#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>
#include <utility>

namespace throng {
namespace {

constexpr std::int64_t kStandardSteps = 600;

constexpr Option kOptions[] = {
    {"--steps", "N", "steps to run, from 0 (default 600)"},
    kDtOption,
    kThreadsOption,
    kSetOption,
    kSeedOption,
    kMeshOption,
    {"--stats", "FILE.json", "times, counts, overlaps, energies and the fingerprint of the state"},
    {"--final", "FILE.csv", "poses and velocities after the last step, with all their digits"},
    {"--out", "RUN.h5", "the whole run as frames, in HDF5"},
    {"--every", "K",
     "steps from one frame of --out to the next (default: what keeps 600 frames or "
     "256 MB before compression)"},
    kEventsOption,
    kHitSpeedOption,
    kTraceOption,
    kTraceStepsOption,
    {"--quiet", "", "no progress, warnings or summary; --stats has the warnings all the same"},
};

/// Steps between frames that keep a run moderate: what a screen can show, on a disk that holds it.
std::int64_t standard_every(std::int64_t steps, std::size_t bodies)
{
    constexpr double kFrames = 600, kBytes = 256e6;
    const double fit = kBytes / (static_cast<double>(bodies + 1) * RunFile::kBytesPerBody);
    const double frames = std::max(1.0, std::min(kFrames, fit));
    return std::max<std::int64_t>(
        1, static_cast<std::int64_t>(std::ceil(static_cast<double>(steps) / frames)));
}

void warn(const SceneArgument& argument, const World& world)
{
    for (const std::string& sentence : unused_dials(argument.scene))
        std::cerr << "warning: " << sentence << '\n';
    if (world.threads_met() < world.threads())
        std::cerr << "warning: --threads: only " << world.threads_met() << " of " << world.threads()
                  << " threads run\n";
    std::cerr.flush();
}

/// What a run writes, but for its frames.
struct Outputs {
    explicit Outputs(const Options& options)
        : stats("--stats", options.text("--stats")), final("--final", options.text("--final")),
          frames("--out", options.text("--out")), events(options), trace(options)
    { }

    void refuse_same_files(const SceneArgument& argument) const
    {
        const std::pair<const OutputFile*, const char*> files[] = {{&stats, "--stats"},
                                                                   {&final, "--final"},
                                                                   {&frames, "--out"},
                                                                   {&events.file(), "--events"},
                                                                   {&trace.file(), "--trace"}};
        for (std::size_t i = 0; i < std::size(files); ++i) {
            const OutputFile& file = *files[i].first;
            refuse_same_file(file, argument.file, "the scene");
            refuse_same_file(file, argument.mesh, "--mesh");
            for (std::size_t k = 0; k < i; ++k)
                refuse_same_file(file, files[k].first->path(), files[k].second);
        }
    }
    // Whoever has a file sent to the standard output reads it from there.
    bool leave_stdout_free() const
    {
        return !stats.is_stdout() && !final.is_stdout() && !events.file().is_stdout()
            && !trace.file().is_stdout();
    }

    void discard()
    {
        for (OutputFile* file : {&stats, &final, &frames}) file->discard();
        events.discard();
        trace.discard();
    }

    OutputFile stats, final, frames;
    EventsOption events;
    TraceOption trace;
};

/// Who looks on before and after each step, where somebody wants to know; no time is taken of that.
struct Onlookers {
    std::optional<EnergyLedger> energy;
    std::optional<ErrorEstimate> error;

    void before_step(const World& world)
    {
        if (energy) energy->before_step(world);
        if (error) error->before_step(world);
    }
    void after_step(const World& world)
    {
        if (energy) energy->after_step(world);
        if (error) error->after_step(world);
    }
    StepError last_error() const { return error ? error->last() : StepError{}; }
};

StepTimes run_steps(World& world,
                    std::int64_t steps,
                    RunFrames& frames,
                    Outputs& outputs,
                    Onlookers& onlookers,
                    bool quiet)
{
    using Clock = std::chrono::steady_clock;
    StepTimes times;
    Progress progress(steps, !quiet);
    std::int64_t done = 0;
    TraceOption& trace = outputs.trace;
    StepGuard guard([&] {
        frames.close();
        outputs.discard();
    });
    frames.step_done(0, {}, false);
    while (done < steps && !interrupted()) {
        onlookers.before_step(world);
        trace.begin_step(static_cast<std::uint64_t>(done) + 1);
        guard.begin_step();
        const auto begin = Clock::now();
        world.step();
        const std::chrono::duration<double, std::milli> taken = Clock::now() - begin;
        guard.end_step();
        trace.end_step();
        onlookers.after_step(world);
        outputs.events.after_step(world);
        times.add(taken.count(), world.stages());
        frames.step_done(++done, onlookers.last_error(), false);
        progress.show(done, world.report().bodies_awake);
    }
    frames.step_done(done, onlookers.last_error(), true);
    return times;
}

// A hundredth of the greatest motion is more than soft contacts give back as they push bodies out
// of what they sank into one another.
std::string energy_warning(const EnergyLedger& ledger)
{
    const double greatest = ledger.greatest_kinetic();
    if (!(ledger.gained() > 0.01 * greatest)) return {};
    return "energy grew by " + number_text(ledger.gained()) + " J without a source from step "
        + std::to_string(ledger.from_step()) + " to " + std::to_string(ledger.to_step())
        + ", beside a kinetic energy of " + number_text(greatest)
        + " J at most; a shorter dt or more substeps help, and bodies that do not begin inside "
          "one another";
}

void name_quarantined(const World& world)
{
    constexpr std::size_t kMostNamed = 10;
    std::size_t count = 0;
    std::string named;
    for (const BodyId body : world.bodies()) {
        if (!world.quarantined(body) || count++ >= kMostNamed) continue;
        const std::string& name = world.name(body);
        named += (named.empty() ? "" : ", ") + std::to_string(body.index)
            + (name.empty() ? "" : ' ' + name);
    }
    std::cerr << "error: " << count << (count == 1 ? " body was" : " bodies were")
              << " put to rest after turning non-finite (quarantined): " << named
              << (count > kMostNamed ? ", ..." : "") << std::endl;
}

/// Writes what comes at the end of a run, stats last: they tell what of the others could not be
/// written. Answers what could not be.
std::vector<std::string>
write_outputs(World& world, RunStats& stats, RunFrames& frames, Outputs& outputs)
{
    std::vector<std::string> troubles;
    const auto note = [&](std::string trouble) {
        if (!trouble.empty()) troubles.push_back(std::move(trouble));
    };
    frames.effects_told(stats.effects);
    note(frames.close());
    if (outputs.final.asked_for()) write_final_csv(world, outputs.final.stream());
    note(outputs.final.try_keep());
    note(outputs.events.try_keep());
    note(outputs.trace.write(world, stats.scene));
    stats.warnings.insert(stats.warnings.end(), troubles.begin(), troubles.end());
    if (outputs.stats.asked_for()) write_stats_json(stats, outputs.stats.stream());
    note(outputs.stats.try_keep());
    return troubles;
}

int exit_code(const RunStats& stats, const std::vector<std::string>& troubles)
{
    if (!troubles.empty()) return kBadInput;
    if (interrupted()) return kInterrupted;
    return stats.bodies_quarantined > 0 ? kCaseFailed : kDone;
}

int run(const Options& options)
{
    const std::int64_t steps = options.whole("--steps", kStandardSteps, 0, kMostSteps);
    const int threads = threads_asked(options);
    const std::int64_t every_asked = options.whole("--every", 0, 1, kMostSteps);
    if (options.has("--every") && !options.has("--out"))
        throw BadInput("--every: says how often --out gets a frame; give --out as well");
    const bool quiet = options.has("--quiet");

    const SceneArgument argument = read_scene_argument(options);
    World world = make_world(argument, threads, quiet);

    note_interrupts();
    Outputs outputs(options);
    outputs.refuse_same_files(argument);
    outputs.trace.watch(world);
    outputs.events.listen(world);
    if (!quiet) warn(argument, world);

    const std::int64_t every =
        every_asked > 0 ? every_asked : standard_every(steps, world.body_count());
    Onlookers onlookers;
    // Who sees neither stats nor warnings spends nothing on them.
    if (outputs.stats.asked_for() || !quiet) onlookers.energy.emplace();
    RunFrames frames(outputs.frames, argument, world, every);
    if (outputs.stats.asked_for() || frames.asked_for() || !quiet) onlookers.error.emplace();
    StepTimes times = run_steps(world, steps, frames, outputs, onlookers, quiet);

    RunStats stats = collect_stats(world, std::move(times));
    stats.scene = argument.label;
    stats.seed = argument.seed;
    stats.warnings = world.warnings();
    if (onlookers.error)
        stats.error = {onlookers.error->rms(), onlookers.last_error(), onlookers.error->worst()};
    if (onlookers.energy) {
        stats.energy = *onlookers.energy;
        const std::string warning = energy_warning(stats.energy);
        if (!quiet && !warning.empty()) std::cerr << "warning: " << warning << '\n';
        if (!warning.empty()) stats.warnings.push_back(warning);
    }
    const std::vector<std::string> troubles = write_outputs(world, stats, frames, outputs);
    for (const std::string& trouble : troubles) std::cerr << "error: " << trouble << '\n';
    if (!quiet && outputs.leave_stdout_free()) write_summary(stats, std::cout);
    if (stats.bodies_quarantined > 0) name_quarantined(world);
    return exit_code(stats, troubles);
}

}  // namespace

const Command kRun = {
    {"run", "SCENE", "Simulates a scene and writes what came of it.", 1, 1, kOptions},
    run,
    print_dials,
};

}  // namespace throng
