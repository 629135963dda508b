// Inner rows: what runs within a stage, as explain prints it.
#pragma once

#include "pipeline/step/step_context.hpp"

#include <span>
#include <string_view>

namespace throng {

/// A row of a stage's inner table: what runs within a substep, and who calls for it.
struct InnerRow {
    std::string_view name;
    Set<Effect> called_for_by;
    std::string_view when;  // each substep, after the last one
    bool within = false;    // part of the row above, in the same pass over the rows
};

/// The inner table of solve_impulses as those settings have it, for explain. Of solver direct: for
/// islands within direct_limit; those beyond it go by soft_step's.
std::span<const InnerRow> solve_table(const Settings& settings);
/// The inner tables of back_up and of subdivide; empty for every other stage.
std::span<const InnerRow> event_driven_table(std::string_view stage);

}  // namespace throng
