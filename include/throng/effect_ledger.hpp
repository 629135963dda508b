// Effect ledger: what each effect is to a scene, who calls for it, and what it costs.
#pragma once

#include "throng/world.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace throng {

/// An effect on the books.
///
///   on       whether the scene calls for it
///   first    who calls first; empty where nobody does
///   callers  how many do: bodies, or pairs of materials, springs, attractors, driven bodies
///   stages   of the step that are there for it, some for other effects as well
///   ms       of those, each shared alike among the effects that call for it
///   rows     of the last step's equations that are there for it, a point of contact once
///   bytes    of the lists that are there for it alone
///   neglected  bodies, or contacts, that the last step went without it by the dial effects=auto
///   bound    no point of theirs is off by more of the radius for it, nor is one turned by more
///            rad, in 0.1 s
struct EffectEntry {
    Effect effect = Effect::motion;
    bool on = false;
    std::string first;
    std::size_t callers = 0;
    std::vector<std::string_view> stages;
    double ms = 0;
    std::size_t rows = 0, bytes = 0;
    std::size_t neglected = 0;
    double bound = 0;
};

/// All effects in their order, those that are off included. The sum of ms is that of the stages.
///
///   stages  the times to share, ms: world.stages() for those of the last step
std::vector<EffectEntry> effect_ledger(World& world, std::span<const StageReport> stages);

}  // namespace throng
