// Trials: what settings are measured on, of a scene or of a hard case.
#pragma once

#include "cost/changes.hpp"
#include "cost/windows/windows.hpp"

#include <string>
#include <vector>

namespace throng {

/// What errors are of. unit: 1 where it has none.
struct Quantity {
    std::string name, unit, about;
};
/// A figure with its unit; without where that is 1.
std::string with_unit(const std::string& figure, const Quantity& quantity);
/// Its name and its unit, likewise: `drift, m`.
std::string label_of(const Quantity& quantity);

/// What came of a trial by some settings.
///
///   time_ms  of its steps, for each 1/60 s of simulated time
struct Trial {
    Errors errors;
    double time_ms = 0;
};

/// Some trials, which every setting goes through in the same way.
class Trials {
public:
    Trials() = default;
    virtual ~Trials() = default;
    Trials(const Trials&) = delete;
    Trials& operator=(const Trials&) = delete;

    /// Whose settings are changed.
    virtual const Scene& scene() const = 0;
    virtual std::size_t size() const = 0;
    /// s of simulated time that each goes through.
    virtual double length() const = 0;
    /// By place among errors.
    virtual std::vector<Quantity> quantities() const = 0;
    /// What the reference is itself off by, by place: as it is told, and no squares.
    virtual const Errors& reference_off() const = 0;
    /// Fingerprint of what is measured: 16 hex digits. Errors of another are none of these.
    virtual std::string state_hash() const = 0;
    /// Whether a step fits into them a whole number of times: others cannot be compared.
    virtual bool holds_whole_steps(double dt) const = 0;

    /// Goes through one. patience: s of the clock that it may take.
    /// Throws std::invalid_argument where the settings cannot be had, TooSlow, Interrupted.
    virtual Trial run(const Changes& changes, std::size_t trial, double patience) const = 0;
    /// The time alone, ms for each 1/60 s.
    virtual double time_ms(const Changes& changes, std::size_t trial) const = 0;
    /// That of each stage of the step; none where the steps are somebody else's.
    virtual std::vector<StageTime> stage_times(const Changes& /*changes*/) const { return {}; }
};

/// The windows of a scene, both of which it needs to stay.
class WindowTrials : public Trials {
public:
    WindowTrials(const Scene& scene, const Windows& windows);

    const Scene& scene() const override { return scene_; }
    std::size_t size() const override { return windows_.size(); }
    double length() const override { return windows_.length(); }
    std::vector<Quantity> quantities() const override { return of_windows(); }
    const Errors& reference_off() const override { return windows_.reference().remaining; }
    std::string state_hash() const override { return windows_.state_hash(); }
    bool holds_whole_steps(double dt) const override { return windows_.holds_whole_steps(dt); }
    Trial run(const Changes& changes, std::size_t trial, double patience) const override;
    double time_ms(const Changes& changes, std::size_t trial) const override;
    std::vector<StageTime> stage_times(const Changes& changes) const override;

    /// What is measured of windows, in the order of Measure.
    static std::vector<Quantity> of_windows();

private:
    const Scene& scene_;
    const Windows& windows_;
};

}  // namespace throng
