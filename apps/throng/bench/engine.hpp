// Engine: whatever can be given a scene and be told to step, throng and its peers alike.
#pragma once

#include "apps/throng/bench/quality.hpp"
#include "apps/throng/trace_option.hpp"
#include "pipeline/records/peer_scene.hpp"

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace throng::bench {

class Engine {
public:
    virtual ~Engine() = default;
    /// Before some steps in a row, and after them: other engines step between.
    virtual void begin_turn() { }
    virtual void end_turn() { }
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

/// Why an engine takes no part in a scene, its name first.
class EngineRefuses : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// An engine that can be made, again for each repeat.
///
///   make     throws EngineRefuses where it is not given all that the scene has
///   setting  the width of throng's kernels where several are run, as `lanes=avx2`, and that of a
///            dial that is varied, as `name=value`; else empty
///   alike    kinds of one name here have to come to the same state
///   beside   others that step the same scene meanwhile, each on a thread of its own
struct EngineKind {
    std::string name;
    std::string setting;
    int threads = 1;
    std::function<std::unique_ptr<Engine>(const Scene&)> make;
    std::string alike = {};
    int beside = 0;
};

/// As tables tell an engine.
inline std::string name_of(const std::string& engine, const std::string& setting, int beside = 0)
{
    const std::string name = setting.empty() ? engine : engine + ' ' + setting;
    return beside == 0 ? name : name + " beside " + std::to_string(beside);
}

/// Throng as it is to be run.
///
///   trace  where its steps go to; null: nowhere
///   lanes  the width of its kernels; empty: that of the process
///   dial   with another value than the scene's, where it is not empty. What it comes to is judged
///          by the scene as given
///   beside see EngineKind
struct ThrongRun {
    int threads = 1, beside = 0;
    TraceOption* trace = nullptr;
    std::string lanes, dial, value;
};
EngineKind throng_engine(const ThrongRun& run);

}  // namespace throng::bench
