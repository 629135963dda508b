// Run stats: what a run has to tell, as JSON for programs and as lines for people.
#include "apps/throng/run_stats.hpp"

#include "apps/throng/effect_json.hpp"
#include "apps/throng/json_lines.hpp"
#include "scene/files/json.hpp"
#include "scene/files/json_writer.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"
#include "throng/version.hpp"

#include <algorithm>
#include <cstdio>
#include <sys/resource.h>

namespace throng {
namespace {

/// Dials as a scene file states them: numbers as numbers, all else as text.
std::string dials_json(const Settings& settings)
{
    JsonMembers members;
    for (const Dial& dial : dials()) members.add(dial.name, json_dial_value(dial.get(settings)));
    return members.text();
}

std::string stages_json(const StepTimes& times)
{
    return '['
        + joined(times.stages(), ",",
                 [](const StepTimes::OfStage& stage) {
                     return "\n    "
                         + JsonMembers()
                               .add_text("name", stage.name)
                               .add("ms_mean", stage.times.mean())
                               .add("ms_p99", stage.times.percentile(0.99))
                               .text();
                 })
        + ']';
}

// Its number, or null.
std::string body_json(BodyId body)
{
    return body.index == kNone ? "null" : std::to_string(body.index);
}

double peak_memory_mb()
{
    struct rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

double RunStats::realtime_factor() const
{
    const double seconds = times.steps().total() / 1e3;
    return seconds > 0 ? static_cast<double>(last.step) * settings.dt / seconds : 0;
}

RunStats collect_stats(World& world, StepTimes times)
{
    RunStats stats;
    stats.settings = world.settings();
    stats.threads = world.threads();
    stats.threads_met = world.threads_met();
    stats.threads_used = world.threads_used();
    for (const BodyId body : world.bodies()) {
        ++stats.bodies;
        stats.bodies_dynamic += world.motion(body) == Motion::dynamic ? 1 : 0;
        stats.bodies_quarantined += world.quarantined(body) ? 1 : 0;
    }
    stats.memory_bytes = world.memory_bytes();
    stats.effects = effect_ledger(world, times.mean_stages());
    stats.times = std::move(times);
    stats.last = world.report();
    stats.measures = world.measure();
    stats.state_hash = world.state_hash();
    stats.peak_rss_mb = peak_memory_mb();
    return stats;
}

void write_stats_json(const RunStats& stats, std::ostream& out)
{
    const TimeSample& steps = stats.times.steps();
    const double bodies = static_cast<double>(std::max<std::size_t>(stats.bodies, 1));
    JsonLines json(out);
    json.add("throng", json_string(version()));
    json.add("scene", json_string(stats.scene));
    json.add("seed", stats.seed);
    json.add("bodies", std::uint64_t{stats.bodies});
    json.add("bodies_dynamic", std::uint64_t{stats.bodies_dynamic});
    json.add("steps", stats.last.step);
    json.add("dt", stats.settings.dt);
    json.add("threads", static_cast<std::uint64_t>(stats.threads));
    json.add("threads_used", static_cast<std::uint64_t>(stats.threads_used));
    json.add("dials", dials_json(stats.settings));
    std::vector<std::string_view> on;
    for (const EffectEntry& entry : stats.effects)
        if (entry.on) on.push_back(name_of(entry.effect));
    json.add("effects", '[' + joined(on, ", ", json_string) + ']');
    json.add("effect_ledger", effect_ledger_json(stats.effects));
    json.add("ms_per_step",
             JsonMembers()
                 .add("mean", steps.mean())
                 .add("median", steps.percentile(0.5))
                 .add("p99", steps.percentile(0.99))
                 .add("greatest", steps.greatest())
                 .text());
    json.add("stages", stages_json(stats.times));
    json.add("realtime_factor", stats.realtime_factor());
    json.add("pairs", std::uint64_t{stats.last.pairs});
    json.add("contacts", std::uint64_t{stats.last.contacts});
    json.add("manifolds", std::uint64_t{stats.last.manifolds});
    json.add("islands", std::uint64_t{stats.last.islands});
    json.add("colors", std::uint64_t{stats.last.colors});
    json.add("relax_visits", stats.last.relax_iterations);
    json.add("max_overlap_m", stats.measures.greatest_overlap);
    json.add("mean_overlap_m", stats.measures.mean_overlap);
    json.add("overlapping_pairs", std::uint64_t{stats.measures.overlapping_pairs});
    json.add("kinetic_energy_j", stats.measures.kinetic_energy);
    json.add("potential_energy_j", stats.measures.potential_energy);
    json.add("energy_gained_j", stats.energy.gained());
    json.add("energy_net_j", stats.energy.net());
    json.add("energy_gained_steps",
             '[' + std::to_string(stats.energy.from_step()) + ", "
                 + std::to_string(stats.energy.to_step()) + ']');
    json.add("greatest_kinetic_energy_j", stats.energy.greatest_kinetic());
    json.add("step_error_m",
             JsonMembers()
                 .add("rms", stats.error.rms)
                 .add("last", stats.error.last.rms)
                 .add("greatest", stats.error.worst.greatest)
                 .add("greatest_step", std::to_string(stats.error.worst.step))
                 .add("greatest_body", body_json(stats.error.worst.worst))
                 .text());
    json.add("warnings", '[' + joined(stats.warnings, ", ", json_string) + ']');
    json.add("momentum", json_text(stats.measures.momentum));
    json.add("angular_momentum", json_text(stats.measures.angular_momentum));
    json.add("bodies_awake", std::uint64_t{stats.last.bodies_awake});
    json.add("bodies_quarantined", std::uint64_t{stats.bodies_quarantined});
    json.add("contacts_dropped", stats.last.contacts_dropped);
    json.add("fallbacks", stats.last.fallbacks);
    json.add("islands_escalated", stats.last.islands_escalated);
    json.add("escalation_missed", stats.last.escalation_missed);
    json.add("escalation_work", stats.last.escalation_work);
    if (stats.settings.solver == Solver::direct)
        json.add("direct_residual", stats.last.direct_residual);
    if (stats.settings.overlap == Overlap::subdivide) json.add("deepest_m", stats.last.deepest);
    json.add("peak_rss_mb", stats.peak_rss_mb);
    json.add("memory_bytes_per_body", static_cast<double>(stats.memory_bytes) / bodies);
    json.add("state_hash", json_string(stats.state_hash));
    json.end();
}

void write_summary(const RunStats& stats, std::ostream& out)
{
    const auto rounded = [](double number) {
        char text[32];
        std::snprintf(text, sizeof text, "%.4g", number);
        return std::string(text);
    };
    const TimeSample& steps = stats.times.steps();
    out << "scene: " << stats.scene << "\nbodies: " << stats.bodies
        << "\nsteps: " << stats.last.step << "\nthreads: " << stats.threads_met
        << "\nms_per_step: " << rounded(steps.mean())
        << "\nms_per_step_p99: " << rounded(steps.percentile(0.99))
        << "\nrealtime_factor: " << rounded(stats.realtime_factor())
        << "\ncontacts: " << stats.last.contacts
        << "\nmax_overlap_m: " << rounded(stats.measures.greatest_overlap)
        << "\nstep_error_m: " << rounded(stats.error.rms)
        << "\nkinetic_energy_j: " << rounded(stats.measures.kinetic_energy)
        << "\nbodies_awake: " << stats.last.bodies_awake
        << "\nbodies_quarantined: " << stats.bodies_quarantined
        << "\nstate_hash: " << stats.state_hash << '\n';
}

}  // namespace throng
