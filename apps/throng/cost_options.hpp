// Cost options: what `throng cost` reads and writes alike for a scene and for a hard case.
#pragma once

#include "apps/throng/commands.hpp"
#include "apps/throng/output_file.hpp"
#include "cost/report/cost_report.hpp"

#include <functional>
#include <optional>
#include <string>

namespace throng {

struct CostOptions {
    WindowPlan windows;
    SweepPlan sweep;
    Wish wish;
};

/// All but --measure, whose words go by what is measured. Throws BadInput.
CostOptions read_cost_options(const Options& options);

/// The word that names the scene or case. Throws BadInput where there are more.
std::string_view word_measured(const Options& options);

/// Dials that --set and --dt turn. Throws BadInput where one is not to be had.
Changes changes_given(const Options& options);

/// A word as a shell takes it: in quotes where it has to be.
std::string in_shell(std::string_view word);

/// What a file holds; nothing where it cannot be read.
std::optional<std::string> text_of_file(const std::string& path);

/// The folder of a report, with its files opened, and what an earlier run left there.
class CostFolder {
public:
    /// name: of what is measured, which the folder is called by where --out names none.
    CostFolder(const Options& options, const std::string& name);

    /// Of --resume; empty without.
    const std::string& before() const { return before_; }
    /// Puts the points of an earlier run into the plan, where they are of the same.
    void take_known(const CostReport& report, SweepPlan& plan) const;
    void write(const CostReport& report);
    /// Where the report is, in a line.
    std::string told() const;

private:
    std::string folder_, before_;
    OutputFile json_, csv_, page_, svg_;
};

/// Sweeps: what is wanted of the trials and for how long, and what of the report comes from it.
void sweep_into(CostReport& report,
                const Trials& trials,
                const Effects& effects,
                const SweepPlan& plan,
                const Watch& watch);

/// Has `measure` fill a report, with somebody watching, and tells and writes it. The exit code.
int report_cost(const Options& options,
                CostReport& report,
                CostFolder& folder,
                const std::function<void(const Watch&)>& measure);

}  // namespace throng
