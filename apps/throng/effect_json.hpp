// Effect JSON: an effect ledger as JSON, wherever it is told.
#pragma once

#include "throng/effect_ledger.hpp"

#include <string>
#include <vector>

namespace throng {

/// [{effect, on, first, callers, stages, ms, rows, bytes}, ...], an effect a line, all of them.
std::string effect_ledger_json(const std::vector<EffectEntry>& entries);

}  // namespace throng
