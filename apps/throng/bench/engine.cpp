// Engine: throng as one of the engines that a benchmark runs.
#include "apps/throng/bench/engine.hpp"

namespace throng::bench {
namespace {

class ThrongEngine final : public Engine {
public:
    ThrongEngine(const Scene& scene, int threads, TraceOption* trace)
        : world_(scene, threads), trace_(trace)
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
    Quality judge() override { return quality_of(world_); }
    std::vector<StageReport> stages() const override { return world_.stages(); }
    std::string state_hash() const override { return world_.state_hash(); }
    std::size_t state_bytes() const override { return world_.memory_bytes(); }
    int threads_met() const override { return world_.threads_met(); }

private:
    World world_;
    TraceOption* trace_;
};

}  // namespace

EngineKind throng_engine(int threads, TraceOption* trace)
{
    return {"throng", threads, [=](const Scene& scene) {
                return std::make_unique<ThrongEngine>(scene, threads, trace);
            }};
}

}  // namespace throng::bench
