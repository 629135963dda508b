// Peers: other engines, from the module beside the command.
#pragma once

#include "apps/peers/peer.hpp"
#include "apps/throng/bench/engine.hpp"

namespace throng::bench {

/// Makes a peer of a scene; throws std::invalid_argument for what it is not given.
using MakePeer = std::function<std::unique_ptr<perf::Peer>(const PeerScene&)>;

/// A peer as an engine: its world is throng's, and what it comes to is judged by throng's geometry.
EngineKind peer_kind(const std::string& name, int threads, const MakePeer& make);

/// The peers of these names, in this order. Those that were asked for and cannot be had make it
/// throw BadInput; others are left out.
std::vector<EngineKind> peer_engines(const std::vector<std::string>& names, bool asked_for);

}  // namespace throng::bench
