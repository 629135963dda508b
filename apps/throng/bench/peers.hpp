// Peers: other engines, from the module beside the command.
#pragma once

#include "apps/throng/bench/engine.hpp"

namespace throng::bench {

/// The peers of these names, in this order. Those that were asked for and cannot be had make it
/// throw BadInput; others are left out.
std::vector<EngineKind> peer_engines(const std::vector<std::string>& names, bool asked_for);

}  // namespace throng::bench
