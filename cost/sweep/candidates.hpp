// Candidates: which dials may trade error for time on a scene, and the values worth a try.
#pragma once

#include "cost/changes.hpp"
#include "throng/effects.hpp"

#include <span>

namespace throng {

/// What is tried.
///
///   steps   of dt and substeps, together: the two that all else goes with
///   others  of the other dials, each by itself on what the scene has
struct Candidates {
    std::vector<Changes> steps, others;
};

/// The dials of which candidates are known.
std::vector<std::string_view> swept_dials();

/// For a scene whose effects are these: no dial that is unused there, and of those given alone;
/// where none is given: of all.
Candidates
candidates_for(const Scene& scene, const Effects& effects, std::span<const std::string> dials);

/// A move from a setting: dt or substeps, or both, by a factor of two either way, within what
/// candidates have of them; iterations that it has by such a factor; or one of the other values
/// left out. Of the dials given alone, or of all; not the scene as it is.
std::vector<Changes>
neighbors_of(const Scene& scene, const Changes& changes, std::span<const std::string> dials);

}  // namespace throng
