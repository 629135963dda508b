// Case trials: a hard case as what settings are measured on. The error is the figure of one of its
// lines, which the case takes against its exact answer.
//
// A case is deterministic, so that there is one trial, and what it tells is told again by every
// run.
#pragma once

#include "cost/hard_cases/cases.hpp"
#include "cost/sweep/trials.hpp"

#include <optional>

namespace throng {

/// Which line, and how the case is run for it.
///
///   quantity  of the line, the first of which is measured; empty: that of the first from runs
///   given     dials that all of it is run by, whatever the case sets itself
///   threads   that run the steps; 0: all cores
///   patience  s of the clock that looking for the line may take
struct CasePlan {
    std::string quantity;
    Changes given;
    int threads = 0;
    double patience = 60;
};

class CaseTrials : public Trials {
public:
    /// Runs the case by its own settings, as far as the line. It is run in brief where that tells
    /// the same. Throws std::invalid_argument, with what there is, where there is no such line,
    /// TooSlow where it does not come in time, Interrupted.
    CaseTrials(const HardCase& which, const CasePlan& plan, const Watch& watch);

    /// As it is by the case's own settings.
    const CaseResult& line() const { return own_.line; }
    /// That lead to the line, and s of simulated time that they go through together.
    std::size_t runs() const { return own_.durations.size(); }
    double seconds() const { return own_.seconds; }

    const Scene& scene() const override { return *own_.scene; }
    std::size_t size() const override { return 1; }
    double length() const override { return own_.all_seconds; }
    std::vector<Quantity> quantities() const override;
    const Errors& reference_off() const override { return exact_; }
    std::string state_hash() const override;
    bool holds_whole_steps(double dt) const override;
    Trial run(const Changes& changes, std::size_t trial, double patience) const override;
    double time_ms(const Changes& changes, std::size_t trial) const override;

private:
    // What came of a case as far as the line.
    struct Found {
        bool has_line = false, is_late = false;
        CaseResult line;
        std::optional<Scene> scene;     // of the first run that led to the line
        std::vector<double> durations;  // s, of those runs
        double steps_ms = 0;            // of the clock, of the steps of those runs
        double seconds = 0;             // simulated, of those runs
        double all_seconds = 0;         // simulated, of all runs
        bool lost = false;              // a body, in those runs
        std::vector<std::string> quantities, skipped;
    };
    Found go(const Changes& changes, Extent extent, double patience) const;
    bool is_wanted(const CaseResult& line) const;
    Trial trial_of(const Found& found) const;

    const HardCase& which_;
    CasePlan plan_;
    Watch watch_;
    Extent extent_ = Extent::whole;
    Found own_;
    Errors exact_;
};

}  // namespace throng
