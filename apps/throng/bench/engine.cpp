// Engine: throng as one of the engines that a benchmark runs.
#include "apps/throng/bench/engine.hpp"

#include "apps/throng/bench/peer_quality.hpp"
#include "apps/throng/scene_argument.hpp"

namespace throng::bench {
namespace {

class ThrongEngine final : public Engine {
public:
    /// Judged by `given`, which outlives it, where it steps another scene than that.
    ThrongEngine(const Scene& stepped, const Scene& given, int threads, TraceOption* trace)
        : world_(stepped, threads), given_(given), varied_(&stepped != &given), trace_(trace)
    {
        if (trace_ != nullptr) trace_->watch(world_);
    }

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
};

}  // namespace

EngineKind throng_engine(int threads, TraceOption* trace)
{
    return {"throng", "", threads, [=](const Scene& scene) {
                return std::make_unique<ThrongEngine>(scene, scene, threads, trace);
            }};
}

EngineKind
throng_engine(int threads, TraceOption* trace, std::string_view dial, std::string_view value)
{
    const std::string name(dial), wanted(value);
    return {"throng", name + '=' + wanted, threads, [=](const Scene& scene) {
                Scene varied = scene;
                set_from_line(varied, "--vary", name, wanted);
                return std::make_unique<ThrongEngine>(varied, scene, threads, trace);
            }};
}

}  // namespace throng::bench
