// Passes: what runs within a stage, as the tables that a solver goes through.
//
// The name of a pass is that of the member function that it runs, so that what explain prints is
// what is there.
#pragma once

#include "pipeline/step/function_name.hpp"
#include "throng/effects.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace throng {

/// When a pass runs. An iteration is a part of a substep that the pass itself repeats; a part is
/// what penalty forces cut a substep into.
enum class When : std::uint8_t {
    before_substeps,
    first_substep,
    each_substep,
    each_iteration,
    each_part,
    after_substeps
};

constexpr std::string_view text_of(When when)
{
    using enum When;
    switch (when) {
    case before_substeps:
        return "before the first substep";
    case first_substep:
        return "in the first substep";
    case each_substep:
        return "each substep";
    case each_iteration:
        return "each iteration of a substep";
    case each_part:
        return "each part of a substep";
    case after_substeps:
        return "after the last substep";
    }
    return {};
}

/// A pass as it is printed.
struct PassRow {
    std::string_view name;
    Set<Effect> called_for_by;
    std::string_view when;
};

/// A pass of a solver.
template <class Solver, class... Arguments>
struct Pass {
    std::string_view name;
    Set<Effect> called_for_by;
    When when;
    void (Solver::*run)(Arguments...);
};

namespace detail {

template <class Run>
struct PassOf;
template <class Solver, class... Arguments>
struct PassOf<void (Solver::*)(Arguments...)> {
    using Type = Pass<Solver, Arguments...>;
};

}  // namespace detail

/// A member function as a pass.
template <auto run>
constexpr typename detail::PassOf<decltype(run)>::Type pass(Set<Effect> called_for_by, When when)
{
    return {function_name<run>(), called_for_by, when, run};
}

/// As they are printed, without those of a shared table that nothing calls for.
template <class Solver, class... Arguments>
std::vector<PassRow> rows_of(std::span<const Pass<Solver, Arguments...>> passes)
{
    std::vector<PassRow> rows;
    for (const auto& pass : passes)
        if (!pass.called_for_by.empty())
            rows.push_back({pass.name, pass.called_for_by, text_of(pass.when)});
    return rows;
}

/// The passes of stages, in order.
std::vector<PassRow> soft_step_passes();
std::vector<PassRow> pgs_passes();
std::vector<PassRow> direct_passes();
std::vector<PassRow> penalty_passes();
std::vector<PassRow> kinematic_passes();
std::vector<PassRow> back_up_passes();
std::vector<PassRow> subdivide_passes();

}  // namespace throng
