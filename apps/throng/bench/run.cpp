// Run: engines step the same scene in turns, and what each step took is kept.
#include "apps/throng/bench/run.hpp"

#include "apps/throng/bench/memory.hpp"
#include "apps/throng/interrupt.hpp"
#include "cost/answers/answers.hpp"

#include <chrono>
#include <ctime>
#include <iostream>

namespace throng::bench {
namespace {

// Steps a turn. Long enough that a step that begins with another engine's data in the caches is one
// of many, short enough that a busy spell of the machine meets everybody.
constexpr std::int64_t kTurn = 20;

double milliseconds(clockid_t clock)
{
    timespec now = {};
    ::clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) / 1e6;
}

/// An engine on its way.
class Contestant {
public:
    Contestant(const EngineKind& kind, const Scene& scene, int repeat, std::int64_t steps)
        : steps_(steps),
          cpu_clock_(kind.threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID)
    {
        run_.engine = kind.name;
        run_.setting = kind.setting;
        run_.alike = kind.alike;
        run_.threads = kind.threads;
        run_.beside = kind.beside;
        run_.repeat = repeat;
        memory_.begin();
        const double begin = milliseconds(CLOCK_MONOTONIC);
        engine_ = kind.make(scene);
        run_.make_ms = milliseconds(CLOCK_MONOTONIC) - begin;
        memory_.end();
        run_.threads_met = engine_->threads_met();
        run_.settings = engine_->settings();
    }

    bool is_done(const Plan& plan) const
    {
        return static_cast<std::int64_t>(run_.steps()) >= steps_
            || spent_ms_ >= plan.max_seconds * 1e3;
    }

    template <class After>
    void take_turn(const Plan& plan, const After& after)
    {
        memory_.begin();
        engine_->begin_turn();
        for (std::int64_t i = 0; i < kTurn && !is_done(plan) && !interrupted(); ++i) {
            step();
            after(run_);
        }
        engine_->end_turn();
        memory_.end();
    }

    /// What there is to tell in the end; whoever was interrupted is not judged.
    Run finish(std::string_view label, bool last_repeat)
    {
        if (last_repeat) engine_->finish(label);
        if (!interrupted()) {
            if (run_.repeat == 0) run_.quality = engine_->judge();
            run_.state_hash = engine_->state_hash();
        }
        run_.state_bytes = static_cast<double>(engine_->state_bytes());
        run_.heap_bytes = memory_.heap();
        run_.resident_bytes = memory_.resident();
        return std::move(run_);
    }

private:
    void step()
    {
        const double cpu = milliseconds(cpu_clock_), begin = milliseconds(CLOCK_MONOTONIC);
        engine_->step();
        const double taken = milliseconds(CLOCK_MONOTONIC) - begin;
        run_.cpu_ms.push_back(milliseconds(cpu_clock_) - cpu);
        run_.ms.push_back(taken);
        spent_ms_ += taken;
        run_.contacts.push_back(engine_->contacts());
        keep_stages(engine_->stages());
    }

    void keep_stages(const std::vector<StageReport>& reports)
    {
        for (std::size_t i = 0; i < reports.size(); ++i) {
            // The list changes only with what the scene calls for: a stage is mostly where it was.
            std::size_t at = i;
            if (at >= run_.stages.size() || run_.stages[at].name != reports[i].name)
                for (at = 0; at < run_.stages.size(); ++at)
                    if (run_.stages[at].name == reports[i].name) break;
            if (at == run_.stages.size()) run_.stages.push_back({std::string(reports[i].name), {}});
            run_.stages[at].ms.resize(run_.steps() - 1, 0.0);
            run_.stages[at].ms.push_back(reports[i].time_ms);
        }
        for (StageRun& stage : run_.stages) stage.ms.resize(run_.steps(), 0.0);
    }

    Run run_;
    std::int64_t steps_;  // at most
    clockid_t cpu_clock_;
    MemoryGrowth memory_;
    double spent_ms_ = 0;
    std::unique_ptr<Engine> engine_;
};

void count_bodies(const Scene& scene, Case& made)
{
    made.bodies = scene.body_count();
    for (const BodyDescription& body : scene.bodies)
        made.bodies_dynamic += body.motion == Motion::dynamic ? 1 : 0;
    for (const Instances& group : scene.instances)
        made.bodies_dynamic += group.common.motion == Motion::dynamic ? group.count() : 0;
}

/// Runs an engine once more, for as many steps, and tells how far it is from the answer.
template <class After>
double error_of(const SceneAnswer& answer,
                const Scene& scene,
                const EngineKind& kind,
                std::size_t steps,
                const After& after)
{
    const std::unique_ptr<Engine> engine = kind.make(scene);
    RunError error(answer, scene);
    engine->begin_turn();
    for (std::size_t step = 1; step <= steps && !interrupted(); ++step) {
        engine->step();
        error.add(static_cast<double>(step) * scene.settings.dt, engine->states());
        after();
    }
    engine->end_turn();
    return error.mean();
}

}  // namespace

Case run_case(const Plan& plan,
              const PlannedScene& planned,
              const Scene& scene,
              std::span<const EngineKind> kinds,
              Progress& progress,
              std::int64_t& steps_done)
{
    Case made;
    made.scene = planned.entry;
    made.size = planned.size;
    made.dt = scene.settings.dt;
    count_bodies(scene, made);
    const std::string label = std::string(planned.entry->name) + ':' + std::to_string(planned.size);
    const std::int64_t begin = steps_done;
    std::int64_t share = 0;
    std::vector<const EngineKind*> taking_part;
    for (const EngineKind& kind : kinds) taking_part.push_back(&kind);
    for (int repeat = 0; repeat < plan.repeats && !interrupted(); ++repeat) {
        trim_memory();
        std::vector<Contestant> contestants;
        contestants.reserve(kinds.size());
        std::erase_if(taking_part, [&](const EngineKind* kind) {
            try {
                contestants.emplace_back(*kind, scene, repeat, planned.steps);
            } catch (const EngineRefuses& why) {
                progress.clear();
                std::cerr << "note: " << label << " goes without " << why.what() << std::endl;
                return true;
            }
            return false;
        });
        bool going = true;
        while (going && !interrupted()) {
            going = false;
            for (Contestant& contestant : contestants) {
                contestant.take_turn(plan, [&](const Run& run) {
                    progress.show(++steps_done,
                                  label + ' ' + name_of(run.engine, run.setting, run.beside)
                                      + " on " + std::to_string(run.threads));
                });
                going = going || !contestant.is_done(plan);
            }
        }
        const bool last = repeat + 1 == plan.repeats || interrupted();
        for (Contestant& contestant : contestants)
            made.runs.push_back(contestant.finish(label, last));
        // Those that ran out of time are done all the same.
        share += static_cast<std::int64_t>(kinds.size()) * planned.steps;
        steps_done = begin + share;
    }
    for (std::size_t i = 0; plan.errors && i < taking_part.size() && !interrupted(); ++i) {
        Run& run = made.runs[i];  // of the first repeat
        const EngineKind& kind = *taking_part[i];
        run.error = error_of(*find_answer(planned.entry->name), scene, kind, run.steps(), [&] {
            progress.show(++steps_done, label + ", error of " + name_of(run.engine, run.setting));
        });
        steps_done = begin + (share += planned.steps);
    }
    made.complete = !interrupted();
    return made;
}

}  // namespace throng::bench
