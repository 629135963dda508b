// Engine: whatever can be given a scene and be told to step, throng and its peers alike.
#pragma once

#include "apps/throng/bench/quality.hpp"
#include "apps/throng/trace_option.hpp"
#include "pipeline/records/peer_scene.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace throng::bench {

class Engine {
public:
    virtual ~Engine() = default;
    virtual void step() = 0;
    /// Points of contact in the last step.
    virtual std::size_t contacts() const = 0;
    virtual Quality judge() = 0;
    /// Of every body, in the scene's order.
    virtual std::vector<PeerState> states() const = 0;
    /// Those of throng alone; empty for others.
    virtual std::vector<StageReport> stages() const { return {}; }
    virtual std::string state_hash() const { return {}; }
    virtual std::size_t state_bytes() const { return 0; }
    /// Whatever is to be written of it while it is still there.
    virtual void finish(std::string_view /*label*/) { }
    virtual int threads_met() const { return 1; }
    /// Beyond the scene and the number of threads, in words.
    virtual std::string settings() const { return {}; }
};

/// An engine that can be made, again for each repeat.
///
///   setting  of a dial that is varied, as `name=value`; else empty
struct EngineKind {
    std::string name;
    std::string setting;
    int threads = 1;
    std::function<std::unique_ptr<Engine>(const Scene&)> make;
};

/// As tables tell an engine.
inline std::string name_of(const std::string& engine, const std::string& setting)
{
    return setting.empty() ? engine : engine + ' ' + setting;
}

/// Throng on so many threads; its steps go to the trace where one is asked for.
EngineKind throng_engine(int threads, TraceOption* trace);

/// The same with another value of a dial. What it comes to is judged by the scene as given.
EngineKind
throng_engine(int threads, TraceOption* trace, std::string_view dial, std::string_view value);

}  // namespace throng::bench
