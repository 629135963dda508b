// Windows: short stretches of a scene's run, each begun from a state of its own, and where a
// reference has them end.
//
// Crowded scenes are chaotic: over seconds, two runs that are both right part. Over a window they
// do not, so that how far a setting drifts from the reference in it is an error, and its average
// over windows one of the scene.
#pragma once

#include "cost/windows/errors.hpp"
#include "throng/scene.hpp"

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace throng {

/// How a scene is cut.
///
///   seconds  s of the scene's time, from its beginning, over which windows are spread
///   length   s, at least, of each: rounded up to whole steps of the scene
///   count    of windows
///   threads  that run the steps; 0: all cores
struct WindowPlan {
    double seconds = 5;
    double length = 0.1;
    std::size_t count = 24;
    int threads = 0;
};

/// Who waits for work that takes long.
///
///   show   told what is at work; may be empty
///   ended  whether to stop: asked between steps; what asks then throws Interrupted
struct Watch {
    std::function<void(const std::string& note)> show;
    std::function<bool()> ended;
};
struct Interrupted { };
/// Thrown where a window takes longer than it may.
struct TooSlow { };

/// A stretch of the scene's run.
///
///   begin      s of the scene's time
///   reference  where its bodies are at the end, by the reference
struct Window {
    double begin = 0;
    BodyStates start, reference;
};

/// What came of a window by some settings.
///
///   time_ms  of its steps, by the work clock, for each 1/60 s of the scene's time; without the
///            first third of them, which find their contacts anew
struct WindowRun {
    Errors errors{};
    double time_ms = 0;
};

/// How the reference was found.
///
///   settings   its dials, as text
///   remaining  by measure (drift, turn, velocity): by how much the ends moved as its step was
///              halved for the last time; about what it is still off by
///   settles    each halving moved the ends by less than the one before
struct ReferenceInfo {
    std::string settings;
    Errors remaining{};
    bool settles = false;
};

/// What a stage of the step takes, ms for each 1/60 s of the scene's time.
struct StageTime {
    std::string name;
    double time_ms = 0;
};

class Windows {
public:
    /// Runs the scene and the reference. `wanted` is an error in metres a tenth of which is enough
    /// for the reference; 0: as near as `patience`, in seconds of the clock, allows.
    /// Throws std::invalid_argument where the scene is impossible, Interrupted.
    Windows(const Scene& scene,
            const WindowPlan& plan,
            double wanted,
            double patience,
            const Watch& watch);

    std::size_t size() const { return windows_.size(); }
    const Window& operator[](std::size_t window) const { return windows_[window]; }
    /// s
    double length() const { return length_; }
    const ReferenceInfo& reference() const { return reference_; }
    /// Fingerprint of where they begin and, by the reference, end: 16 hex digits.
    std::string state_hash() const;
    /// Whether a step fits into them a whole number of times: others cannot be compared.
    bool holds_whole_steps(double dt) const;
    /// Windows in which nothing moves by more than a micrometre.
    std::size_t at_rest() const;

    /// Goes through a window by the settings that the scene has here: the same scene but for them.
    /// patience: s of the clock that its steps may take.
    /// Throws std::invalid_argument where they cannot be had, TooSlow.
    WindowRun run(const Scene& scene,
                  std::size_t window,
                  double patience = std::numeric_limits<double>::infinity()) const;
    /// The time alone.
    double time_ms(const Scene& scene, std::size_t window) const;
    /// Of each stage, in the order of the step, on the average over some windows.
    std::vector<StageTime> stage_times(const Scene& scene) const;

private:
    void find_starts(const Scene& scene, const WindowPlan& plan);
    void find_reference(const Scene& scene, double wanted, double patience);
    std::vector<BodyStates> ends_by(const Scene& scene, double patience) const;
    Errors moved(const std::vector<BodyStates>& from, const std::vector<BodyStates>& to) const;
    World begun(const Scene& scene, std::size_t window) const;
    void check() const;
    void measure_laws(const World& world, std::size_t window, Errors& errors) const;

    std::vector<Window> windows_;
    double length_ = 0, fine_ = 0;  // s; of the step that is halved first
    int threads_ = 0;
    bool touches_ = false;  // anything may touch anything
    // Of the same bodies, put where a run has them, to look at their geometry: what it is before
    // does not matter. None where nothing touches.
    std::unique_ptr<World> geometry_;
    ReferenceInfo reference_;
    Watch watch_;
};

}  // namespace throng
