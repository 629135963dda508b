// Engine: throng as one of the engines that a benchmark runs.
#include "apps/throng/bench/engine.hpp"

#include "apps/throng/bench/peer_quality.hpp"
#include "apps/throng/scene_argument.hpp"
#include "throng/version.hpp"

#include <thread>

namespace throng::bench {
namespace {

class ThrongEngine final : public Engine {
public:
    /// Judged by `given`, which outlives it, where it steps another scene than that.
    ThrongEngine(const Scene& stepped, const Scene& given, const ThrongRun& run)
        : world_(stepped, run.threads), given_(given), varied_(&stepped != &given),
          trace_(run.trace), lanes_(run.lanes.empty() ? lane_width() : run.lanes)
    {
        if (trace_ != nullptr) trace_->watch(world_);
        for (int i = 0; i < run.beside; ++i)
            others_.push_back(std::make_unique<World>(stepped, run.threads));
    }

    void begin_turn() override
    {
        take_lanes(lanes_.c_str());
        for (const auto& other : others_)
            busy_.emplace_back([&world = *other](const std::stop_token& turn_ends) {
                while (!turn_ends.stop_requested()) world.step();
            });
    }
    void end_turn() override { busy_.clear(); }

    void step() override
    {
        if (trace_ != nullptr) trace_->begin_step(world_.report().step + 1);
        world_.step();
        if (trace_ != nullptr) trace_->end_step();
    }
    void finish(std::string_view label) override
    {
        if (trace_ != nullptr) trace_->write(world_, label);
    }
    std::size_t contacts() const override { return world_.report().contacts; }
    Quality judge() override
    {
        return varied_ ? quality_of(given_, peer_states(world_)) : quality_of(given_, world_);
    }
    std::vector<PeerState> states() const override { return peer_states(world_); }
    std::vector<StageReport> stages() const override { return world_.stages(); }
    std::string state_hash() const override { return world_.state_hash(); }
    std::size_t state_bytes() const override { return world_.memory_bytes(); }
    int threads_met() const override { return world_.threads_met(); }

private:
    World world_;
    const Scene& given_;
    bool varied_;
    TraceOption* trace_;
    std::string lanes_;
    std::vector<std::unique_ptr<World>> others_;
    std::vector<std::jthread> busy_;  // during a turn, with those
};

}  // namespace

EngineKind throng_engine(const ThrongRun& run)
{
    const std::string varied = run.dial.empty() ? "" : run.dial + '=' + run.value;
    std::string setting = run.lanes.empty() ? "" : "lanes=" + run.lanes;
    if (!setting.empty() && !varied.empty()) setting += ' ';
    const auto make = [run](const Scene& scene) -> std::unique_ptr<Engine> {
        if (run.dial.empty()) return std::make_unique<ThrongEngine>(scene, scene, run);
        Scene other = scene;
        set_from_line(other, "--vary", run.dial, run.value);
        return std::make_unique<ThrongEngine>(other, scene, run);
    };
    return {"throng", setting + varied, run.threads, make, varied, run.beside};
}

}  // namespace throng::bench
